"""Where nothing converges: rows that say so, and claims, proofs and figures that bear it."""

from dataclasses import replace
from itertools import product

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

from smallsat.evidence.claims import judge_claims
from smallsat.evidence.errata import prove_errata
from smallsat.step import Step
from smallsat.strict_yaml import read_yaml
from smallsat.studies.transfer.figures.basin import basin_figure
from smallsat.studies.transfer.figures.cases import control_figure, states_figure
from smallsat.studies.transfer.figures.coasting import coasting_figure
from smallsat.studies.transfer.figures.convergence import convergence_figure
from smallsat.studies.transfer.methods import experiments, extremals, long_flights
from smallsat.studies.transfer.methods.basin import shares
from smallsat.studies.transfer.methods.continuation import ContinuationError
from smallsat.studies.transfer.methods.indirect import ConvergenceError
from smallsat.studies.transfer.model.problem import TransferProblem
from smallsat.studies.transfer.model.trajectory import ControlHistory, boundary_error, propagate
from smallsat.studies.transfer.steps import observations
from smallsat.workflow.run_step import run_step

# Claims that rest on the equations and on flights of the document's own set-up, which stay.
WITHOUT_OURS = {"transfer/claim/newton-lagrange", "transfer/claim/objectives-agree"}

# Steps that have nothing to say of a transfer without an extremal.
BEYOND = ("convergence", "basin", "coasting")


@pytest.fixture(scope="module")
def section(config):
    numerics = config.transfer.numerics.with_(multistart=1, tighter_bounds=[5.0])
    return config.transfer.with_(degrees=[2], intervals=[2], numerics=numerics)


@pytest.fixture(scope="module")
def results(section, root, tmp_path_factory, grounds):
    """Results of a run in which no extremal is found."""
    folder = tmp_path_factory.mktemp("missing")

    def no_continuation(problem):
        raise ContinuationError("continuation ends at once")

    def no_shooting(*_):
        raise ConvergenceError("residual 1.0e+00 at t_f = -1.0000", 1.0)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(extremals, "minimum_time", no_continuation)
        patch.setattr(extremals, "solve_extremal", no_shooting)
        published = root / "data/published/transfer"
        step = Step(section, folder, published)
        for part in ("indirect", "converged", "unbounded", "continuous", "tighter_bounds"):
            run_step("transfer", "experiment", replace(step, part=part))
        patch.setattr(long_flights, "minimum_time", no_continuation)
        for part, name in product(("1", "2"), ("as_published", "long_flights")):
            run_step("transfer", name, replace(step, part=part))
        for name in ("multistart", "collocation", *BEYOND, "gather", "observations"):
            run_step("transfer", name, step)
        given = grounds("transfer", section, folder)
        claims = judge_claims(read_yaml(published / "claims.yaml"), given, "claims.yaml")
        errata = prove_errata(read_yaml(published / "errata.yaml"), given, "errata.yaml")
    claims.to_csv(folder / "claims.csv", index=False)
    errata.to_csv(folder / "errata.csv", index=False)
    return folder


def test_every_missing_case_is_a_row_that_says_what_was_tried(results):
    """Two extremals, one case of each direct run, one polynomial, and the collocation."""
    table = pd.read_csv(results / "not-converged.csv")
    assert len(table) == 7
    assert table["tried"].str.contains("document's guess: residual 1.0e").all()
    assert table["tried"].str.contains("continuation ends at once").all()


def test_observations_of_missing_cases_are_no_numbers_and_say_why(results):
    """No value beside a printed one where there is no solution; the document's runs stay."""
    table = pd.read_csv(results / "observations.csv")
    missing = table[table["computed"].isna()]
    assert len(missing) > 10
    assert missing["note"].str.startswith("not converged").all()
    assert table["computed"].notna().any()


def test_claims_on_missing_cases_are_undecided(results):
    """No claim holds or fails for want of a solution."""
    table = pd.read_csv(results / "claims.csv").set_index("id")
    decided = table[table["outcome"] != "undecided"]
    ours = decided[~decided["evidence"].str.startswith("by printed numbers alone")]
    assert set(ours.index) <= WITHOUT_OURS


@pytest.mark.parametrize("key", ["exhaust-speed", "final-radius", "one-argument-atan2", "nesting"])
def test_proofs_on_missing_cases_are_not_computed(results, key):
    """A proof that needs a solution says that there is none."""
    table = pd.read_csv(results / "errata.csv").set_index("key")
    assert table.loc[key, "statement"].startswith("not computed")
    assert not table.loc[key, "holds"]


def test_what_goes_beyond_is_drawn_as_missing(results):
    """Tables without rows, and figures that say so."""
    tables = {name: pd.read_csv(results / f"{name}.csv") for name in BEYOND}
    assert all(table.empty for table in tables.values())
    for figure in (
        convergence_figure(tables["convergence"]),
        basin_figure(shares(tables["basin"])),
        coasting_figure(tables["coasting"], pd.read_parquet(results / "coasting.parquet")),
    ):
        assert "not converged" in [text.get_text() for text in figure.axes[0].texts]
        plt.close(figure)


def test_a_missing_case_is_drawn_as_missing(results):
    """Both figures of a case without any flight say so."""
    flown = pd.read_parquet(results / "converged.parquet")
    assert flown.empty
    for draw in (states_figure, control_figure):
        figure = draw(flown, ["converged"])
        texts = [text.get_text() for text in figure.axes[0].texts]
        labels = [text.get_text() for legend in figure.legends for text in legend.texts]
        assert "not converged" in texts
        assert "converged: not converged" in labels
        plt.close(figure)


@pytest.mark.parametrize("final_time", [0.0, -1.0, np.nan, 13.3, 1e9])
def test_what_cannot_be_flown_is_no_number_and_meets_nothing(config, final_time):
    """No time, no end, or no mass left: no state, and an infinite error."""
    problem = TransferProblem.of(config.transfer.problem)
    times = np.array([0.0, final_time])
    state, table = propagate(problem, ControlHistory(times, [lambda t: 0.0 * t]), 5)
    assert np.isnan(state).all()
    assert table.empty
    assert boundary_error(problem, state) == np.inf


def test_a_slower_extremal_is_not_taken(config, monkeypatch):
    """Where the document's guess ends at another extremal, the continuation's is the start."""
    problem = TransferProblem.of(config.transfer.problem)
    calls = []
    original = extremals.solve_extremal

    def slower_first(problem, intervals, start, steps):
        found = original(problem, intervals, start, steps)
        calls.append(intervals)
        if len(calls) == 1:
            return extremals.Extremal(found.nodes, found.final_time + 1.0, 1, 0.0, 0.0)
        return found

    monkeypatch.setattr(extremals, "solve_extremal", slower_first)
    monkeypatch.setattr(extremals, "REFINEMENTS", 0)
    guess = config.transfer.guess
    units = extremals.Units(1.0, 1.0, 1.0)
    found = extremals.find_extremals(problem, units, (1,), guess, 192)[1]
    assert found.start == extremals.CONTINUATION
    assert found.extremal.final_time == pytest.approx(3.246944208, abs=1e-8)


def test_experiments_know_their_own_names():
    """Every experiment that the observations ask for is one."""
    for name in observations.OURS:
        assert name == "collocation" or hasattr(experiments, name)
