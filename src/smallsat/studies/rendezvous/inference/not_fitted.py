"""What the searches did not look at: where flights fail, and the printed cells in nonlinear motion.

Both are taken from what is flown with the sets of the ensemble anyway, and none of them was fitted
to it. The scale of a failure's miss was set when our counts were known.
"""

import numpy as np
import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.studies.rendezvous.configuration import Cases, Configuration
from smallsat.studies.rendezvous.evidence.case_tables import phase_cells
from smallsat.studies.rendezvous.inference.misfit import WORST, WORST_SHARE, printed_steps
from smallsat.studies.rendezvous.monte_carlo.cases import sweep_case

FAILING = "section-4-2/cases-failing-to-rendezvous-within-limit"
STATES = "chapter-4-introduction/number-of-random-chaser-initial-states/sensitivity-study"
# Horizon and sample time, s, of the cases whose failures Section 4.2 counts; no other case has any.
PRINTED_FAILURES = ((30, 60), (45, 50), (45, 60))


def failures(section: Configuration, sweep: pd.DataFrame, ledger: Ledger) -> pd.DataFrame:
    """Failures of the rendezvous phase against those of Section 4.2: a row a case.

    Parameters
    ----------
    section
        For the cases.
    sweep
        Manoeuvres, ``case`` and ``completed``.
    ledger
        What the document prints.

    Returns
    -------
    pandas.DataFrame
        ``case``, ``printed``, how many fail in the document, ``failed`` and ``flown`` here, and
        ``residual``: the difference of the shares' arcsines of roots, in standard errors of both
        samples, at most `misfit.WORST_SHARE`.
    """
    states = ledger.value(STATES).value
    counted = {
        sweep_case(n, t): ledger.value(f"{FAILING}/n1-{n}-ts-1-{t}-s").value
        for n, t in PRINTED_FAILURES
    }
    swept = section.studies.rendezvous
    names = [sweep_case(n, t) for n in swept.horizons for t in swept.sample_times_s]
    ended = sweep.groupby("case")["completed"].agg(["sum", "size"]).loc[names]
    table = pd.DataFrame({"case": names, "printed": [counted.get(name, 0.0) for name in names]})
    table["failed"] = (ended["size"] - ended["sum"]).to_numpy()
    table["flown"] = ended["size"].to_numpy()
    ours, theirs = (
        2.0 * np.arcsin(np.sqrt(share))
        for share in (table["failed"] / table["flown"], table["printed"] / states)
    )
    errors = np.sqrt(1.0 / table["flown"] + 1.0 / states)
    table["residual"] = ((ours - theirs) / errors).clip(-WORST_SHARE, WORST_SHARE)
    return table


def cells(section: Cases, truth: pd.DataFrame, ledger: Ledger) -> pd.Series:
    """Sum of squared misses of the cells of Tables 3.3 to 3.5, in assumed errors, by motion.

    ``truth`` is the table of `nonlinear_flights.simulate_nonlinear`. Whole steps are compared, in
    all motions, where the misfit has the time at which a phase's end is crossed.
    """
    assumed, steps = section.inference, printed_steps(section, ledger)
    delta_v = phase_cells(ledger).set_index(["case", "phase"])["delta_v_m_s"]
    keys = list(zip(truth["flight"], truth["phase"], strict=True))
    printed_delta_v = np.array([delta_v[key] for key in keys])
    errors = np.maximum(assumed.delta_v_share * printed_delta_v, assumed.delta_v_error_m_s)

    def squares(suffix: str) -> pd.Series:
        late = (truth[f"steps{suffix}"] - [steps[key] for key in keys]) / assumed.step_error
        more = (truth[f"delta_v{suffix}_m_s"] - printed_delta_v) / errors
        return late.clip(-WORST, WORST) ** 2 + more.clip(-WORST, WORST) ** 2

    by_model = squares("").groupby(truth["model"]).sum()
    linear = squares("_linear").groupby(truth["model"]).sum().iloc[0]
    return pd.concat([pd.Series({"linear": linear}), by_model])
