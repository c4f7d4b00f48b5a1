"""The terms beside the misfit: zero for the numbers of the document itself, and their scale."""

import numpy as np
import pandas as pd
import pytest

from smallsat.studies.rendezvous.evidence.case_tables import CASE_TABLES, phase_cells
from smallsat.studies.rendezvous.guidance.law import PHASES
from smallsat.studies.rendezvous.inference.misfit import WORST, WORST_SHARE, printed_steps
from smallsat.studies.rendezvous.inference.not_fitted import cells, failures
from smallsat.studies.rendezvous.monte_carlo.cases import sweep_case


@pytest.fixture
def swept(section):
    """A sweep of 500 manoeuvres a case, in which some fail, by case."""

    def of(failed):
        sweep = section.studies.rendezvous
        names = [sweep_case(n, t) for n in sweep.horizons for t in sweep.sample_times_s]
        return pd.concat(
            pd.DataFrame({"case": name, "completed": np.arange(500) >= failed.get(name, 0)})
            for name in names
        )

    return of


def test_printed_failures_are_no_miss(section, ledger, swept):
    given = {"N 30, Ts 60 s": 2, "N 45, Ts 50 s": 1, "N 45, Ts 60 s": 6}
    table = failures(section, swept(given), ledger("rendezvous"))
    assert table["printed"].sum() == table["failed"].sum() == 9
    assert (table["residual"] == 0.0).all()


def test_a_miss_is_in_standard_errors(section, ledger, swept):
    """Near even shares as the normal approximation has it; without failures too few, capped."""
    table = failures(section, swept({"N 15, Ts 20 s": 3}), ledger("rendezvous")).set_index("case")
    # 6 of 500 against none: the root of 2 times 6, where p is small.
    assert table.loc["N 45, Ts 60 s", "residual"] == pytest.approx(-np.sqrt(12.0), rel=0.01)
    assert table.loc["N 15, Ts 20 s", "residual"] == pytest.approx(np.sqrt(6.0), rel=0.01)
    all_fail = failures(section, swept({"N 15, Ts 20 s": 500}), ledger("rendezvous"))
    assert all_fail["residual"].max() == WORST_SHARE


def test_cells_of_the_tables_themselves(section, ledger):
    """No miss with the printed numbers; a step too many is one assumed error, a stall the worst."""
    steps = printed_steps(section, ledger("rendezvous"))
    delta_v = phase_cells(ledger("rendezvous")).set_index(["case", "phase"])["delta_v_m_s"]
    truth = pd.DataFrame(
        {
            "model": "impulses", "flight": case, "phase": phase,
            "steps_linear": steps[case, phase], "delta_v_linear_m_s": delta_v[case, phase],
            "steps": steps[case, phase], "delta_v_m_s": delta_v[case, phase],
        }
        for case in CASE_TABLES for phase in PHASES
    )  # fmt: skip
    assert (cells(section, truth, ledger("rendezvous")) == 0.0).all()
    truth.loc[0, "steps"] += 1
    found = cells(section, truth, ledger("rendezvous"))
    assert found.to_dict() == {"linear": 0.0, "impulses": section.inference.step_error**-2}
    truth.loc[0, "steps"] += 1000
    assert cells(section, truth, ledger("rendezvous"))["impulses"] == WORST**2
