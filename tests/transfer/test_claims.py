"""Claims on computed results: each has results with which it would not come out as it does."""

import shutil

import numpy as np
import pytest

from smallsat.results import read_table, write_table
from smallsat.studies.transfer.evidence import claims, errata
from smallsat.studies.transfer.model.problem import TransferProblem


def of(table, **columns):
    """Which rows of a table have these values."""
    return np.logical_and.reduce([table[name] == value for name, value in columns.items()])


def put(column, value, **columns):
    """A change of a table: a value, or a function of the old ones, in some of its rows."""

    def change(table):
        rows = of(table, **columns) if columns else np.ones(len(table), bool)
        old = table.loc[rows, column]
        if not callable(value):
            kind = float if type(value) in (float, int) else object
            table[column] = table[column].astype(kind)
        table.loc[rows, column] = value(old) if callable(value) else value

    return change


# Claim, table, and a change of the table after which the claim comes out otherwise.
OTHERWISE = [
    ("same_extremal", "indirect.csv", put("final_time", 3.2470, intervals=4)),
    ("shortest", "converged.csv", put("final_time", 3.2469, degree=6, intervals=16)),
    ("solves_easily", "indirect.csv", put("status", "by continuation", intervals=1)),
    ("small_node_errors", "indirect.csv", put("residual", 1e-6, intervals=8)),
    ("continuous_control", "indirect.parquet", put("beta", lambda b: b + 0.1, segment=1)),
    ("gain_from_intervals", "converged.csv", put("final_time", 3.2489, degree=2)),
    ("degree_negligible", "converged.csv", put("final_time", 3.2540, degree=2, intervals=4)),
    ("closer_with_intervals", "converged.csv", put("final_time", 3.2480, degree=4, intervals=4)),
    ("single_polynomial_cost", "as-published.csv", put("final_time", 3.3500, intervals=1)),
    ("single_polynomial_short_of_optimum", "multistart.csv", put("final_time", 3.2475, degree=6)),
    ("direct_worse_than_indirect", "converged.csv", put("final_time", 3.2469, intervals=16)),
    ("gap_from_parameterisation", "converged.csv", put("final_time", 3.2478)),
    ("continuity_helps", "continuous.csv", put("final_time", lambda t: t + 1e-4)),
    ("bounds_help", "tighter_bounds.csv", put("final_time", 3.2469, degree=3)),
    ("bounds_cut_cost", "tighter_bounds.csv", put("iterations", 5, degree=4)),
    ("early_stopping", "printed-stop.csv", put("equal_to_printed", False)),
    ("objectives_agree", "as-published.csv", put("final_mass", 0.75, degree=3, intervals=2)),
    (
        "two_intervals_nearer",
        "as-published.parquet",
        put("beta", lambda b: b + 2.0, degree=2, intervals=2),
    ),
    ("controls_alike", "converged.parquet", put("beta", lambda b: b + 2.0, degree=5)),
    ("single_fails_on_long_flights", "long-flights.csv", put("final_time", 5.0, intervals=1)),
    (
        "multiple_solves_long_flights",
        "long-flights.csv",
        put("final_time", np.nan, intervals=16),
    ),
]


@pytest.fixture
def changed_results(tested_run, tmp_path):
    """The results with one table changed."""
    folder = tmp_path / "transfer"

    def of(name, change):
        shutil.copytree(tested_run / "data/results/transfer", folder, dirs_exist_ok=True)
        table = read_table(folder / name)
        change(table)
        write_table(table, folder / name)
        return folder

    return of


@pytest.mark.parametrize(("name", "table", "change"), OTHERWISE, ids=[one[0] for one in OTHERWISE])
def test_the_verdict_hangs_on_the_results(
    config, grounds, tested_run, changed_results, name, table, change
):
    """As computed it has its accepted outcome; after the change it has another."""
    predicate = getattr(claims, name)
    before = predicate(grounds("transfer", config.transfer, tested_run / "data/results/transfer"))
    after = predicate(grounds("transfer", config.transfer, changed_results(table, change)))
    assert {before.outcome, after.outcome} in ({"holds", "fails"}, {"holds", "undecided"})


def test_another_law_of_motion_would_not_agree_with_lagrange(
    config, grounds, monkeypatch, tmp_path
):
    """Without the Coriolis term the two derivations differ."""
    given = grounds("transfer", config.transfer, tmp_path)
    assert claims.newton_and_lagrange_agree(given).outcome == "holds"
    right = TransferProblem.state_rate

    def without(self, state, sine, cosine):
        rates = right(self, state, sine, cosine)
        return [*rates[:3], rates[3] + state[3] * state[2] / state[0], rates[4]]

    monkeypatch.setattr(TransferProblem, "state_rate", without)
    assert claims.newton_and_lagrange_agree(given).outcome == "fails"


def test_every_predicate_is_tried(root):
    """No claim on computed results is without such a change here."""
    text = (root / "data/published/transfer/claims.yaml").read_text()
    used = {line.rpartition(":")[2] for line in text.splitlines() if ".claims:" in line}
    assert used == {one[0] for one in OTHERWISE} | {"newton_and_lagrange_agree"}


def table_4(quantity, n, k):
    return f"table-4/{quantity}/direct-multiple-shooting-n-{n}-k-{k}"


# Proof, and what would have to be printed for it not to hold.
UNPROVEN = {
    "exhaust_speed": {"section-2-3/v-e-exhaust-speed": "1.8658344"},
    "final_radius": {"section-2-3/boundary-transversality-condition/r-f": "1.5"},
    "mass_of_n4_k16": {table_4("terminal-mass", 4, 16): "0.75546"},
    "mass_of_n4_prose": {"section-3-3/terminal-mass/direct-shooting-n-4": "0.73853"},
    "mass_of_n6_prose": {"section-3-3/terminal-mass/direct-shooting-n-6": "0.74690"},
    "effect_of_degree": {
        "section-3-4-1/effect-of-degree-on-terminal-time/direct-multiple-shooting": "0.026"
    },
    "mass_increase": {"section-3-5/terminal-mass/direct-shooting-n-6": "0.7630"},
    "time_of_n4_prose": {"section-3-3/elapsed-time/direct-shooting-n-4": "0.3590"},
    "increase_in_time": {"section-3-4-1/increase-in-computation-time-n-2-to-n-6/k-2": "39.7"},
    "optimal_choice": {table_4("terminal-time", 6, 16): "3.24740"},
    "cheapest_choice": {table_4("sim-time", 4, 2): "0.8"},
}


@pytest.mark.parametrize("name", UNPROVEN)
def test_a_proof_hangs_on_what_is_printed(config, grounds, tested_run, name):
    """It holds as printed, and not where the right number is printed."""
    results, prove = tested_run / "data/results/transfer", getattr(errata, name)
    assert prove(grounds("transfer", config.transfer, results)).holds
    assert not prove(grounds("transfer", config.transfer, results, UNPROVEN[name])).holds


def test_one_argument_suffices_where_no_sign_is_lost(config, grounds, changed_results):
    """With the thrust ahead all the way the quotient has the same angle."""
    folder = changed_results("indirect.parquet", put("lambda_vtheta", lambda v: abs(v)))
    given = grounds("transfer", config.transfer, folder)
    assert not errata.one_argument_atan2(given).holds


def test_the_mass_term_is_told_by_the_hamiltonian(config, grounds, changed_results):
    """A Hamiltonian that does not vanish proves no exhaust speed."""
    folder = changed_results("indirect.parquet", put("hamiltonian", 0.1))
    given = grounds("transfer", config.transfer, folder)
    assert not errata.hamiltonian_exhaust(given).holds


# Proof of an equation by its value at the final radius, and where the printed form has it too.
COINCIDENT = {"lagrange_gravity": 1.0, "generalised_force": float(np.tan(0.4))}


@pytest.mark.parametrize("name", COINCIDENT)
def test_a_radius_at_which_both_forms_agree_proves_nothing(config, grounds, tmp_path, name):
    """The value that tells the equations apart is computed, and there it does not."""
    prove, problem = getattr(errata, name), config.transfer.problem
    assert prove(grounds("transfer", config.transfer, tmp_path)).holds
    section = config.transfer.with_(problem=problem.with_(final_radius=COINCIDENT[name]))
    assert not prove(grounds("transfer", section, tmp_path)).holds


def test_a_converged_grid_that_rises_proves_no_nesting(config, grounds, changed_results):
    """If ours rose with the degree too, the printed rises would show nothing."""
    change = put("final_time", 3.2480, degree=4, intervals=4)
    given = grounds("transfer", config.transfer, changed_results("converged.csv", change))
    assert not errata.nesting(given).holds


def test_prose_that_says_what_table_4_says_contradicts_nothing(config, grounds, ledger, tmp_path):
    """With the table's literals in the prose no cell differs."""
    table = {
        (row["case"], row["quantity"]): row["printed"]
        for row in ledger("transfer").rows
        if row["locator"] == "Table 4"
    }
    names = {"elapsed time": "sim time"}
    printed = {
        row["id"].removeprefix("transfer/"): table[key]
        for row in ledger("transfer").rows
        if row["locator"] == "Section 3.4"
        and (key := (row["case"], names.get(row["quantity"], row["quantity"]))) in table
    }
    given = grounds("transfer", config.transfer, tmp_path, printed)
    assert not errata.prose_against_table_4(given).holds
