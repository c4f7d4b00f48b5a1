"""What the misfit determines, by a second method: a posterior of the numbers.

The affine-invariant ensemble sampler of Goodman and Weare (emcee) walks over all fitted numbers at
once, with the readings as configured and a prior that is uniform within the bounds. It knows
nothing of the searches but where it begins. No set is acceptable against the assumed errors as they
stand, so they are inflated (Birge's ratio) until the configured set is: the likelihood is
exp(-misfit / 2 s), where s is that set's misfit over the number of misses less that of the numbers.
"""

from typing import Any

import emcee
import numpy as np
import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.studies.rendezvous.configuration import Cases
from smallsat.studies.rendezvous.inference.parameter_set import FITTED, ParameterSet
from smallsat.studies.rendezvous.inference.search import evaluate
from smallsat.studies.rendezvous.inference.summary import configured_residuals

# Spread of the first walkers about the configured numbers, in shares of their bounds.
SPREAD = 0.02
# Quantiles that stand for a posterior.
QUANTILES = {"low": 0.05, "median": 0.5, "high": 0.95}


def walk(section: Cases, kept: pd.DataFrame, starts: np.ndarray, ledger: Ledger) -> pd.DataFrame:
    """Walk on for the configured number of steps: a row a walker and step.

    Parameters
    ----------
    section
        With the walk's settings.
    kept
        A table as is returned here, of an earlier walk, whose last step is walked on from. Where it
        has another number of walkers, or none, they begin about the configured numbers.
    starts
        Initial states for the axes, (n, 6), m and m/s.
    ledger
        What the document prints.

    Returns
    -------
    pandas.DataFrame
        ``step``, ``walker``, `FITTED`, ``misfit``; steps count on from the earlier walk's.
    """
    settings = section.inference.posterior
    low, high = np.array([section.inference.bounds[name] for name in FITTED], dtype=float).T
    readings = ParameterSet.configured(section).readings
    missed = configured_residuals(section, starts, ledger)["residual"].to_numpy()
    inflation = float((missed**2).sum()) / (len(missed) - len(FITTED))

    def log_probability(places: np.ndarray) -> np.ndarray:
        inside = ((places >= low) & (places <= high)).all(axis=1)
        found = np.full(len(places), -np.inf)
        sets = [
            ParameterSet(dict(zip(FITTED, place.tolist(), strict=True)), readings)
            for place in places[inside]
        ]
        if sets:
            misfit = evaluate(section, sets, starts, ledger)["misfit"].to_numpy()
            found[inside] = -0.5 * misfit / inflation
        return found

    random = np.random.default_rng([section.inference.seed, 1])
    last = kept[kept["step"] == kept["step"].max()]
    if len(last) == settings.walkers:
        begun, done = last[FITTED].to_numpy(dtype=float), int(last["step"].iloc[0])
    else:
        centre = np.array([section.inferred[name] for name in FITTED])
        spread = SPREAD * (high - low) * random.standard_normal((settings.walkers, len(FITTED)))
        begun, done = np.clip(centre + spread, low, high), 0
    sampler = emcee.EnsembleSampler(settings.walkers, len(FITTED), log_probability, vectorize=True)
    # The sampler draws with a generator of its own, of NumPy's older kind.
    state = np.random.RandomState(np.random.MT19937(random.integers(2**32))).get_state()
    sampler.run_mcmc(emcee.State(begun, random_state=state), settings.steps)
    chain: Any = sampler.get_chain()
    values: Any = sampler.get_log_prob()
    steps, walkers = values.shape
    table = pd.DataFrame(chain.reshape(-1, len(FITTED)), columns=FITTED)
    table.insert(0, "step", done + 1 + np.repeat(np.arange(steps), walkers))
    table.insert(1, "walker", np.tile(np.arange(walkers), steps))
    return table.assign(misfit=-2.0 * inflation * values.ravel())


def marginals(walked: pd.DataFrame) -> pd.DataFrame:
    """Quantiles of each number over a walk, by parameter."""
    rows = [
        {
            "parameter": name,
            **{f"posterior_{q}": float(walked[name].quantile(p)) for q, p in QUANTILES.items()},
        }
        for name in FITTED
    ]
    return pd.DataFrame(rows)
