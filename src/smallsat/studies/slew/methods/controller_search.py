"""Search for controllers that give the printed values of the eigenaxis turns.

About one axis the turn is a double integrator with a torque limit. The search covers stiffness
and damping on a grid, three ways to feed the error back, and torques held for a while.
"""

from itertools import product
from math import sin, tan

import numpy as np
import pandas as pd

from smallsat.dynamics.compiled import compiled
from smallsat.evidence.ledger import Ledger
from smallsat.studies.slew.configuration import ControllerSearch
from smallsat.studies.slew.parameters import Parameters

LAWS = ("sin(e/2)", "e/2", "2 tan(e/4)")
HOLDS_S = (0.0, 0.5, 1.0, 2.0)
STEP = 0.02
# Ranges of sqrt(stiffness), rad/s, and of damping over twice that; wide around 0.13 and 1.
FREQUENCIES = (0.04, 0.5)
DAMPINGS = (0.3, 3.0)

# The document's own gains are among those tried.
DOCUMENT = (0.13, 1.0)

# What Section VI.A prints of both turns; the peak of the first is the one in doubt.
TURNS = {"quarter": "90-deg-eigenaxis", "half": "180-deg-eigenaxis"}
PRINTED = (
    "section-vi-a/final-yaw-angle/{}",
    "section-vi-a/residual-omega-z/{}/z",
    "section-vi-a/maximum-angular-momentum-usage/{}/z",
    "section-vi-a/final-angular-momentum-usage/{}/z",
)
PEAK = 2


@compiled
def axis_turn(
    target, stiffness, damping, law, hold, acceleration, gradient, orbit_rate, duration, step
):
    """A turn about one axis from rest, the position vector in the plane of the turn.

    ``gradient`` is the largest angular acceleration by the gravity gradient, rad/s^2. Returns the
    final angle and rate, rad and rad/s, and the largest and final momentum given by the wheel, over
    the moment of inertia, rad/s.
    """
    angle = rate = parameters = peak = held = 0.0
    steps = round(duration / step)
    every = max(1, round(hold / step))
    for k in range(steps):
        if hold == 0.0 or k % every == 0:
            held = _law(target - angle, rate, stiffness, damping, law, acceleration)
        outer = -gradient * sin(2.0 * (angle - orbit_rate * k * step))
        mean = held
        if hold == 0.0:
            # Heun's method; the law is continuous.
            ahead_angle = angle + step * rate
            ahead_rate = rate + step * (held + outer)
            ahead = _law(target - ahead_angle, ahead_rate, stiffness, damping, law, acceleration)
            mean = 0.5 * (held + ahead)
        angle += step * rate + 0.5 * step * step * (mean + outer)
        rate += step * (mean + outer)
        parameters += step * mean
        peak = max(peak, abs(parameters))
    return angle, rate, peak, parameters


@compiled
def _law(error, rate, stiffness, damping, law, acceleration):
    if law == 0:
        fed = sin(0.5 * error)
    elif law == 1:
        fed = 0.5 * error
    else:
        fed = 2.0 * tan(0.25 * error)
    return min(acceleration, max(-acceleration, stiffness * fed - damping * rate))


def values(
    parameters: Parameters, case: str, wn: float, zeta: float, law: int, hold: float
) -> np.ndarray:
    """Yaw (deg), rate (deg/s), peak and final momentum (%) of a controller, shape (4,)."""
    first, second, moment = np.diag(parameters.inertia)
    target = np.pi / 2.0 if case == "quarter" else np.pi
    r, v = parameters.state
    radius = float(np.linalg.norm(r))
    angle, rate, peak, final = axis_turn(
        target,
        wn * wn,
        2.0 * zeta * wn,
        law,
        hold,
        parameters.torque / moment,
        1.5 * parameters.gravity.mu / radius**3 * (second - first) / moment,
        float(np.linalg.norm(v)) / radius,
        parameters.duration,
        STEP,
    )
    share = 100.0 * moment / parameters.momentum
    return np.array([np.degrees(angle), np.degrees(rate), share * peak, share * final])


def printed_values(ledger: Ledger) -> np.ndarray:
    """The printed values of both turns, each with half a unit of its last digit, shape (8, 2)."""
    printed = [ledger.value(name.format(turn)) for turn in TURNS.values() for name in PRINTED]
    return np.array([[one.value, one.half_unit] for one in printed])


def misses(
    parameters: Parameters, printed: np.ndarray, wn: float, zeta: float, law: int, hold: float
) -> np.ndarray:
    """Differences from `printed_values` in half units of their last digits, shape (8,)."""
    found = np.concatenate([values(parameters, case, wn, zeta, law, hold) for case in TURNS])
    return (found - printed[:, 0]) / printed[:, 1]


def search(parameters: Parameters, printed: np.ndarray, numerics: ControllerSearch) -> pd.DataFrame:
    """For each law and hold: the controller that comes nearest to the printed values.

    Three questions a row: all values but the 38.9 %; all values of 90 deg with it; all of both
    turns with it. The nearest is the one whose worst value misses by the fewest half units.
    ``printed`` are the `printed_values`.
    """
    chosen = {
        "all but the peak of 90 deg": [i for i in range(8) if i != PEAK],
        "90 deg, its peak included": [0, 1, 2, 3],
        "all, the peak of 90 deg included": list(range(8)),
    }
    frequencies = np.geomspace(*FREQUENCIES, numerics.grid)
    dampings = np.geomspace(*DAMPINGS, numerics.grid)
    width = float(np.log(FREQUENCIES[1] / FREQUENCIES[0])) / numerics.grid
    rows = []
    for (law, name), hold in product(enumerate(LAWS), HOLDS_S):
        grid = {
            (wn, zeta): np.abs(misses(parameters, printed, wn, zeta, law, hold))
            for wn, zeta in [*product(frequencies, dampings), DOCUMENT]
        }
        for question, index in chosen.items():
            starts = sorted(grid, key=lambda key: float(grid[key][index].max()))[: numerics.starts]
            wn, zeta = min(
                (
                    _refined(parameters, printed, *start, law, hold, index, width)
                    for start in starts
                ),
                key=lambda gains: float(
                    np.abs(misses(parameters, printed, gains[0], gains[1], law, hold))[index].max()
                ),
            )
            quarter, half = (values(parameters, case, wn, zeta, law, hold) for case in TURNS)
            worst = np.abs(misses(parameters, printed, wn, zeta, law, hold))[index].max()
            rows.append(
                {
                    "feedback": name,
                    "hold_s": hold,
                    "fitted": question,
                    "frequency_rad_s": float(f"{wn:.4g}"),
                    "damping_ratio": float(f"{zeta:.4g}"),
                    "worst_miss_half_units": float(f"{worst:.2g}"),
                    "yaw_90_deg": float(f"{quarter[0]:.5g}"),
                    "peak_90_pct": float(f"{quarter[2]:.4g}"),
                    "yaw_180_deg": float(f"{half[0]:.5g}"),
                    "peak_180_pct": float(f"{half[2]:.4g}"),
                }
            )
    return pd.DataFrame(rows)


def _refined(parameters, printed, wn, zeta, law, hold, index, width) -> tuple[float, float]:
    """Shrinking pattern search around a grid point, on the logarithms of both gains."""
    best = np.log([wn, zeta])

    def worst(place: np.ndarray) -> float:
        wn, zeta = (float(np.exp(log)) for log in place)
        return float(np.abs(misses(parameters, printed, wn, zeta, law, hold))[index].max())

    value = worst(best)
    while width > 1e-5:
        places = [best + width * np.array(way) for way in product((-1, 0, 1), repeat=2)]
        scores = [worst(place) for place in places]
        if min(scores) < value:
            value, best = min(scores), places[int(np.argmin(scores))]
        else:
            width /= 2.0
    return float(np.exp(best[0])), float(np.exp(best[1]))
