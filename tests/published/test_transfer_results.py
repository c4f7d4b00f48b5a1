"""Results of the orbit-transfer study that no single printed value shows."""

from decimal import Decimal
from itertools import product

import pandas as pd
import pytest

from smallsat.studies.transfer.evidence.printed_cases import printed_cases
from smallsat.studies.transfer.evidence.printed_stop import chance_of_hits
from smallsat.studies.transfer.results import CASE_TABLES

# Best known final times of direct multiple shooting with free polynomials, to six decimals: the
# figures an independent computation found for the same problem. Ours must match or beat them.
BEST_KNOWN = {
    (2, 2): 3.248879, (2, 4): 3.247745, (2, 8): 3.247112, (2, 16): 3.246952,
    (3, 2): 3.248026, (3, 4): 3.247239, (3, 8): 3.246967, (3, 16): 3.246946,
    (4, 2): 3.247521, (4, 4): 3.247030, (4, 8): 3.246947, (4, 16): 3.246945,
    (5, 2): 3.247220, (5, 4): 3.246964, (5, 8): 3.246946, (5, 16): 3.246944,
    (6, 2): 3.247061, (6, 4): 3.246949, (6, 8): 3.246945, (6, 16): 3.246944,
}  # fmt: skip
ROUNDING = 5e-7


@pytest.fixture(scope="module")
def results(tested_run):
    folder = tested_run / "data/results/transfer"
    return {name: pd.read_csv(folder / f"{name}.csv") for name in CASE_TABLES}


def test_unbounded_runs_match_or_beat_the_best_known(results):
    """All 20 cases, to half a unit of the sixth decimal; every one converged."""
    cases = results["unbounded"].set_index(["degree", "intervals"])
    assert cases["converged"].all()
    for case, best in BEST_KNOWN.items():
        assert cases.loc[case, "final_time"] <= best + ROUNDING, case


@pytest.mark.parametrize(
    "run", ["indirect", "converged", "unbounded", "continuous", "multistart", "tighter_bounds"]
)
def test_solutions_are_feasible_with_another_integrator(results, run):
    """Flown anew by LSODA from the initial orbit, every end condition is met to 1e-9."""
    assert (results[run]["residual"] < 1e-9).all()


def test_no_bound_of_ours_is_active(results):
    """The bounds that steady the solver do not shape a solution."""
    for run in ("converged", "unbounded", "continuous", "tighter_bounds"):
        assert (results[run]["bound_slack"] > 0.1).all()


def test_converged_runs_keep_the_printed_bounds_and_most_unbounded_ones_do_not(results, config):
    """In the document's basis, to IPOPT's relaxation of a bound; so that bounds cost time."""
    most = max(config.transfer.bounds.coefficient)
    assert (results["converged"]["largest_coefficient"] < most + 1e-6).all()
    outside = results["unbounded"]["largest_coefficient"] > most
    assert outside.sum() > len(outside) / 2
    keys = ["degree", "intervals"]
    pair = results["converged"].merge(results["unbounded"], on=keys, suffixes=("", "_free"))
    assert (pair["final_time"] > pair["final_time_free"] - 1e-9).all()


def test_sets_that_contain_one_another_have_optima_in_order(results):
    """Within bounds: more degrees, more intervals and wider bounds never fly longer (1e-9)."""
    times = results["converged"].pivot(index="degree", columns="intervals", values="final_time")
    assert (times.diff().iloc[1:] < 1e-9).all(axis=None)
    assert (times.diff(axis=1).iloc[:, 1:] < 1e-9).all(axis=None)
    tight = results["tighter_bounds"].assign(bound=results["tighter_bounds"]["run"].str[7:])
    tight["bound"] = tight["bound"].astype(float)
    wider = tight.pivot(index="degree", columns="bound", values="final_time").diff(axis=1)
    assert (wider.iloc[:, 1:] < 1e-9).all(axis=None)


def test_every_case_of_table_4_is_beaten_within_the_printed_bounds(results, ledger):
    """Each of the twenty, by more than half a unit of the last printed digit; or equal to it."""
    best = results["converged"].set_index(["degree", "intervals"])["final_time"]
    printed = printed_cases(ledger("transfer"), "Table 4")["terminal time"].droplevel("method")
    assert (best <= printed + 5e-6).all()


def test_nothing_beats_the_extremal(results):
    """The indirect final time is a lower bound of every feasible shooting solution (1e-9)."""
    bound = results["indirect"]["final_time"].min() - 1e-9
    for run in ("converged", "unbounded", "continuous", "multistart", "tighter_bounds"):
        assert (results[run]["final_time"] > bound).all()


def test_single_polynomials_beat_the_printed_local_minima(results, ledger):
    """From degree 3 on, the best of many starts is shorter than what Table 3 prints."""
    best = results["multistart"].set_index("degree")["final_time"]
    printed = printed_cases(ledger("transfer"), "Table 3")["terminal time"]
    for degree in (3, 4, 5, 6):
        assert best[degree] < printed["direct", degree, 1] - 1e-3


def test_stopped_runs_are_counted_right(tested_run, config, ledger):
    """The experiment behind the inference: every case, its last iterate, and the hits.

    How many iterates hit a printed value hangs on the last bits of a solver, so that no number is
    asked for here; what the claim makes of them is pinned in ``data/accepted``.
    """
    folder = tested_run / "data/results/transfer"
    table = pd.read_csv(folder / "printed-stop.csv", dtype={"final_time": str})
    section = config.transfer
    found = table[["degree", "intervals"]].itertuples(index=False, name=None)
    assert sorted(found) == sorted(product(section.degrees, section.intervals))
    stop = section.numerics.stop
    assert (table["optimality"] <= stop.optimality_multiple).all()
    printed = printed_cases(ledger("transfer"), "Table 4")["terminal time"]
    for row in table.itertuples():
        text = f"{printed['direct', row.degree, row.intervals]:.5f}"
        distance = abs(Decimal(row.final_time) - Decimal(text))
        assert row.equal_to_printed == (distance <= Decimal("5e-6")), row
    path = pd.read_csv(folder / "as-published-path.csv")
    path = path[path["intervals"] > 1]
    met = (path["optimality"] <= stop.optimality_multiple) & (path["violation"] <= stop.feasibility)
    assert (path[met].groupby(["degree", "intervals"])["iteration"].count() == 1).all()


def test_chance_of_hits_is_that_of_a_deal(ledger):
    """Two degrees with exchanged values: half of the deals hit both, the others none."""
    table = pd.DataFrame({"intervals": 2, "final_time": [1.0, 2.0], "printed": [1.0, 2.0]})
    table = table.assign(half_unit=0.1, equal_to_printed=True)
    chance = chance_of_hits(table, 1)
    assert (chance.hits, chance.most) == (2, 2)
    assert chance.share == pytest.approx(0.5, abs=0.02)
    assert chance.mean == pytest.approx(1.0, abs=0.04)
