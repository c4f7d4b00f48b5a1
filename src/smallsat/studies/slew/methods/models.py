"""The larger turn in the document's time by two models of the body, to tell which one it flew."""

from math import nan

import numpy as np
import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.evidence.not_converged import NotConverged
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.beyond import half_mesh
from smallsat.studies.slew.methods.flights import replay
from smallsat.studies.slew.methods.plan_names import MODELS
from smallsat.studies.slew.methods.plans import (
    AXES,
    SWEEP_STARTS,
    asked_once,
    best_plan,
    guidance_model,
    joined,
    least_infeasible,
    node_table,
    resampled,
    slew_of,
    unsolved,
)
from smallsat.studies.slew.model.simulation import COLUMNS, angles_deg, usage_pct
from smallsat.studies.slew.parameters import Parameters

PRINTED = "printed"
# Weights of the rate in the miss of the end: how the document's solver weighs it is not known, and
# its run ends with rates that count more in our own measure, the first, than its angles do. Chosen
# after an exploration.
RATE_WEIGHTS = (1.0, 0.1, 0.01)
# What "momentum usage" may mean. Where the total momentum stays nil the two are the same.
READINGS = ("J w", "integral of u")
PEAKS = [f"peak_{axis}_pct" for axis in AXES]
LEFT = [f"left_{axis}_pct" for axis in AXES]
ANGLES = ["roll_deg", "pitch_deg", "yaw_deg"]


def fly_models(
    section: Configuration, parameters: Parameters
) -> tuple[pd.DataFrame, list[NotConverged]]:
    """Plans by each model, flown in open loop in the fuller model with the same gyroscopic torque.

    Of least torque where the solver reaches the end, or else those that miss it least by
    several measures.
    """
    numerics = section.numerics
    flights: list[pd.DataFrame] = []
    missing: list[NotConverged] = []
    for name, carried in MODELS.items():
        slew = slew_of(
            guidance_model(parameters, carried=carried), parameters, "half", half_mesh(section)
        )
        if asked_once(slew).converged:
            results = [best_plan(slew, numerics, SWEEP_STARTS)[0]] * len(RATE_WEIGHTS)
        else:
            results = least_infeasible(slew, numerics, RATE_WEIGHTS)
        for result, weight in zip(results, RATE_WEIGHTS, strict=True):
            turn = f"{parameters.names['half']}, {name}, rate weight {weight:g}"
            missing += unsolved(turn, result, "several starts")
            if result.solution.converged:
                torques = resampled(node_table(slew.model, result, turn), section.resampling_hz)
                flown = replay(parameters, section, torques, parameters.duration, carried=carried)
                flights.append(flown.assign(flight=name, rate_weight=weight))
    return joined(flights, (*COLUMNS, "flight", "rate_weight")), missing


def carried_pct(flown: pd.DataFrame, parameters: Parameters) -> dict[str, np.ndarray]:
    """Momentum used over a flight by each of `READINGS`, shape (n, 3), percent of the limit."""
    rates = flown[[f"omega_{axis}" for axis in AXES]].to_numpy()
    of_body = 100.0 * rates @ parameters.inertia / parameters.momentum
    return dict(zip(READINGS, (of_body, usage_pct(flown, parameters)[1]), strict=True))


def compared(flights: pd.DataFrame, parameters: Parameters, ledger: Ledger) -> pd.DataFrame:
    """Peaks, what is left, and angles at the end: the printed ones, and by model and reading.

    The last column is the root of the mean squared difference of peaks and momenta left from the
    printed ones.
    """
    where, turn = "section-vi-b", "180-deg-torque-optimal"
    peaks, left = (
        np.array(ledger.values(f"{where}/{name}-angular-momentum-usage/{turn}"), dtype=float)
        for name in ("maximum", "final")
    )
    angles = [
        ledger.value(f"{where}/final-{name}-angle/{turn}").value
        for name in ("roll", "pitch", "yaw")
    ]
    rows = [_row(PRINTED, nan, "", peaks, left, angles) | {"off_printed_pct": 0.0}]
    for (name, weight), flown in flights.groupby(["flight", "rate_weight"], sort=False):
        angles = angles_deg(flown.tail(1))[0].tolist()
        for reading, used in carried_pct(flown, parameters).items():
            found = np.abs(used).max(axis=0)
            row = _row(str(name), float(str(weight)), reading, found, np.abs(used[-1]), angles)
            off = np.array([row[key] - rows[0][key] for key in (*PEAKS, *LEFT)])
            rows.append(row | {"off_printed_pct": float(np.sqrt(np.mean(off**2)))})
    return pd.DataFrame(rows)


def _row(model: str, weight: float, reading: str, peaks, left, angles) -> dict:
    values = np.concatenate([peaks, left, angles])
    return {"model": model, "rate_weight": weight, "reading": reading} | dict(
        zip([*PEAKS, *LEFT, *ANGLES], values.tolist(), strict=True)
    )
