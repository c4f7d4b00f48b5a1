"""Results of the orbit-transfer study that no single printed value shows."""

from decimal import Decimal
from itertools import product

import pandas as pd
import pytest

from smallsat.studies.transfer.evidence.printed_cases import printed_cases

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
    return {
        name: pd.read_csv(folder / f"{name}.csv")
        for name in ("indirect", "as-published", "converged", "continuous", "multistart")
    }


def test_converged_runs_match_or_beat_the_best_known(results):
    """All 20 cases, to half a unit of the sixth decimal; every one converged."""
    cases = results["converged"].set_index(["degree", "intervals"])
    assert cases["converged"].all()
    for case, best in BEST_KNOWN.items():
        assert cases.loc[case, "final_time"] <= best + ROUNDING, case


@pytest.mark.parametrize("run", ["indirect", "converged", "continuous", "multistart"])
def test_solutions_are_feasible_with_another_integrator(results, run):
    """Flown anew by LSODA from the initial orbit, every end condition is met to 1e-9."""
    assert (results[run]["residual"] < 1e-9).all()


def test_no_bound_of_ours_is_active(results):
    """The bounds that steady the solver do not shape a converged or continuous solution."""
    assert (results["converged"]["bound_slack"] > 0.1).all()
    assert (results["continuous"]["bound_slack"] > 0.1).all()


def test_nothing_beats_the_extremal(results):
    """The indirect final time is a lower bound of every feasible shooting solution (1e-9)."""
    bound = results["indirect"]["final_time"].min() - 1e-9
    for run in ("converged", "continuous", "multistart"):
        assert (results[run]["final_time"] > bound).all()


def test_single_polynomials_beat_the_printed_local_minima(results, ledger):
    """From degree 3 on, the best of many starts is shorter than what Table 3 prints."""
    best = results["multistart"].set_index("degree")["final_time"]
    printed = printed_cases(ledger("transfer"), "Table 3")["terminal time"]
    for degree in (3, 4, 5, 6):
        assert best[degree] < printed["direct", degree, 1] - 1e-3


def test_early_stopping_is_counted_right(tested_run, config, ledger):
    """The experiment behind the inference: every case and tolerance, and both columns of hits.

    How many iterates hit a printed value hangs on the last bits of a solver, so that no number is
    asked for here; what the claim makes of them is pinned in ``data/accepted``.
    """
    path = tested_run / "data/results/transfer/early-stopping.csv"
    table = pd.read_csv(path, dtype={"final_time": str})
    section = config.transfer
    numerics = section.numerics
    tolerances = [numerics.as_published_tolerance, *numerics.early_stopping_tolerances]
    cases = product(section.degrees, section.intervals, tolerances)
    found = table[["degree", "intervals", "tolerance"]].itertuples(index=False, name=None)
    assert sorted(found) == sorted(cases)
    printed = printed_cases(ledger("transfer"), "Table 4")["terminal time"]
    band = printed.min() - 5e-6, printed.max() + 5e-6
    for row in table.itertuples():
        time = Decimal(row.final_time)
        text = f"{printed['direct', row.degree, row.intervals]:.5f}"
        assert row.equal_to_printed == (abs(time - Decimal(text)) <= Decimal("5e-6")), row
        assert row.in_printed_band == (band[0] <= float(time) <= band[1]), row
