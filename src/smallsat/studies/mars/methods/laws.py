"""Control laws compared: in the mission, and from random attitudes with a body they do not know."""

from collections.abc import Iterator

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from smallsat.errors import InputError
from smallsat.evidence.not_converged import NotConverged
from smallsat.statistics.random_streams import stream
from smallsat.studies.mars.configuration import Configuration
from smallsat.studies.mars.methods.closed_loop import COLUMNS, Actuators, Setting, simulate
from smallsat.studies.mars.methods.simulation import AUTOMATIC, POINTING_RUNS
from smallsat.studies.mars.model.control_laws import LAWS, Law, lqr_gains
from smallsat.studies.mars.parameters import Parameters

# As the document has them, and as reaction wheels.
IDEAL, WHEELS = "ideal", "wheels"
_TORQUE, _MOMENTUM = slice(7, 10), slice(10, 13)
_ERROR, _MODE = COLUMNS.index("error_rad"), COLUMNS.index("mode")


def laws(section: Configuration, parameters: Parameters) -> dict[str, Law]:
    """The laws by their names, with the document's gains where they have some.

    Raises
    ------
    InputError
        If there is no regulator with the weights that are asked for.
    """
    settings = section.beyond.laws
    asked, sliding = settings.lqr, settings.sliding_mode
    try:
        regulator = lqr_gains(
            parameters.inertia,
            section.step_s,
            float(np.tan(np.radians(asked.angle_deg) / 4.0)),
            float(np.radians(asked.rate_deg_s)),
            asked.torque_N_m,
        )
    except np.linalg.LinAlgError:
        raise InputError(
            f"config key 'mars.beyond.laws.lqr': {dict(asked)} has no regulator; its values must "
            f"be of sizes that a body turns with"
        ) from None
    return {
        name: Law(
            kind=kind,
            k=parameters.gains.k,
            p=parameters.gains.p,
            inertia=parameters.inertia,
            integral_time=settings.integral_time_s,
            integral_limit=settings.integral_limit_N_m_s,
            lqr=regulator,
            slope=float(np.radians(sliding.slope_deg_s)),
            reaching=float(np.radians(sliding.reaching_deg_s2)),
            layer=float(np.radians(sliding.layer_deg_s)),
        )
        for kind, name in enumerate(LAWS)
    }


def actuators(section: Configuration) -> dict[str, Actuators]:
    """Ideal actuators without limits, and wheels with theirs."""
    wheels = section.beyond.wheels
    return {
        IDEAL: Actuators(carried=0.0, torque=np.inf, momentum=np.inf),
        WHEELS: Actuators(carried=1.0, torque=wheels.torque_N_m, momentum=wheels.momentum_N_m_s),
    }


def setting(section: Configuration, parameters: Parameters) -> Setting:
    """Orbits, steps and the gravity gradient of a planet whose gravity makes the orbit's rate."""
    lmo = parameters.lmo
    return Setting(
        lmo=lmo,
        gmo=parameters.gmo,
        mu=lmo.rate**2 * lmo.radius**3,
        visibility=parameters.visibility,
        step=section.step_s,
        difference=section.frame_difference_s.control,
    )


def missions(
    section: Configuration, parameters: Parameters
) -> tuple[pd.DataFrame, pd.DataFrame, list[NotConverged]]:
    """The document's mission by every law with both kinds of actuators, under gravity gradient.

    Returns
    -------
    summary
        A row a law and kind of actuators: share of the time within ``settled_deg``, largest and
        root-mean-square error later than ``late_s`` after a switch, torque and momentum.
    errors
        ``law``, ``actuators``, ``time_s``, ``error_deg``, ``torque_N_m``, ``mode``, every
        `THINNED` seconds or steps.
    not_converged
        Runs that are no number.
    """
    steps = round(section.durations_s.mission / section.step_s)
    rows, errors, missing = [], [], []
    for name, law in laws(section, parameters).items():
        for kind, ones in actuators(section).items():
            record = simulate(
                law,
                ones,
                setting(section, parameters),
                parameters.initial_state,
                parameters.inertia,
                AUTOMATIC,
                steps,
            )
            if not np.isfinite(record).all():
                missing.append(_overflow(f"the mission by {name} with {kind} actuators", section))
                record[:, 1:_MODE] = np.nan
            rows.append({"law": name, "actuators": kind} | _summary(record, section))
            errors.append(_errors(record).assign(law=name, actuators=kind))
    return pd.DataFrame(rows), pd.concat(errors, ignore_index=True), missing


# Every so many steps of a mission are kept.
THINNED = 10


def random_starts(section: Configuration, parameters: Parameters) -> Iterator[tuple]:
    """Initial states, (6,), with attitudes from all rotations alike, and true moments, (3,).

    The body rate is the document's; each moment is off by a share that is uniform within the
    configuration's, drawn anew where the three are of no body.
    """
    chances = section.beyond.monte_carlo
    error = chances.inertia_error_pct / 100.0
    for run in range(chances.runs):
        generator = stream(chances.seed, run)
        attitude = Rotation.from_quat(generator.standard_normal(4)).as_mrp()
        moments = parameters.inertia * (1.0 + error * generator.uniform(-1.0, 1.0, 3))
        while 2.0 * moments.max() > moments.sum():
            moments = parameters.inertia * (1.0 + error * generator.uniform(-1.0, 1.0, 3))
        yield np.r_[attitude, parameters.initial_state[3:]], moments


def monte_carlo(
    section: Configuration, parameters: Parameters
) -> tuple[pd.DataFrame, list[NotConverged]]:
    """Every law with wheels in every pointing mode, from the same random starts.

    Returns
    -------
    runs
        ``law``, ``mode``, ``run``, ``settled_s`` (not a number where it never settles),
        ``late_error_deg``, ``torque_used_N_m_s``, ``peak_momentum_N_m_s``.
    not_converged
        Laws and modes with runs that are no number.
    """
    steps = round(section.durations_s.response / section.step_s)
    wheels, place = actuators(section)[WHEELS], setting(section, parameters)
    rows, missing = [], []
    for name, law in laws(section, parameters).items():
        for mode, command in POINTING_RUNS.items():
            lost = 0
            for run, (state, moments) in enumerate(random_starts(section, parameters)):
                record = simulate(law, wheels, place, state, moments, command, steps)
                if not np.isfinite(record).all():
                    lost += 1
                    record[:, 1:_MODE] = np.nan
                summary = _summary(record, section)
                rows.append(
                    {"law": name, "mode": mode, "run": run, "settled_s": _settled(record, section)}
                    | {key: summary[key] for key in MONTE_CARLO_COLUMNS}
                )
            if lost:
                missing.append(
                    _overflow(f"{lost} random starts of {mode} pointing by {name}", section)
                )
    return pd.DataFrame(rows), missing


MONTE_CARLO_COLUMNS = ("late_error_deg", "torque_used_N_m_s", "peak_momentum_N_m_s")


def robustness(runs: pd.DataFrame) -> pd.DataFrame:
    """Medians and 95th percentiles of `monte_carlo`'s runs, a row a law and mode.

    Runs that never settle count as longer than all others.
    """
    rows = []
    for (law, mode), group in runs.groupby(["law", "mode"], sort=False):
        settled = group["settled_s"].fillna(np.inf)
        late = group["late_error_deg"]
        rows.append(
            {
                "law": law,
                "mode": mode,
                "runs": len(group),
                "unsettled": int(np.isinf(settled).sum()),
                "settled_median_s": _order(settled, 0.5),
                "settled_95_s": _order(settled, 0.95),
                "late_error_median_deg": _order(late, 0.5),
                "late_error_95_deg": _order(late, 0.95),
                "torque_used_median_N_m_s": _order(group["torque_used_N_m_s"], 0.5),
                "peak_momentum_95_N_m_s": _order(group["peak_momentum_N_m_s"], 0.95),
            }
        )
    return pd.DataFrame(rows)


def _order(values: pd.Series, share: float) -> float:
    """The value that at least so large a share of all does not exceed; none if that is infinite."""
    value = float(np.quantile(values, share, method="inverted_cdf"))
    return value if np.isfinite(value) else np.nan


def _summary(record: np.ndarray, section: Configuration) -> dict[str, float]:
    """Errors, deg, and torques of a run whose mode may switch."""
    error = np.degrees(record[:, _ERROR])
    torque = record[:-1, _TORQUE]
    late = error[_since_switch(record) >= section.beyond.late_s]
    return {
        "settled_share_pct": 100.0 * float(np.mean(error <= section.beyond.settled_deg)),
        "late_error_deg": float(late.max()) if len(late) else np.nan,
        "late_rms_deg": float(np.sqrt(np.mean(late**2))) if len(late) else np.nan,
        "peak_torque_N_m": float(np.abs(torque).max()),
        "torque_used_N_m_s": float(np.linalg.norm(torque, axis=1).sum() * section.step_s),
        "peak_momentum_N_m_s": float(np.abs(record[:, _MOMENTUM]).max()),
    }


def _since_switch(record: np.ndarray) -> np.ndarray:
    """Time since the mode last changed, or since the start, s, (n,)."""
    time, mode = record[:, 0], record[:, _MODE]
    first = np.r_[True, np.diff(mode) != 0.0]
    return time - time[np.maximum.accumulate(np.where(first, np.arange(len(time)), 0))]


def _settled(record: np.ndarray, section: Configuration) -> float:
    """When the error came below ``settled_deg`` for good, s; not a number where it never did."""
    outside = np.flatnonzero(~(np.degrees(record[:, _ERROR]) <= section.beyond.settled_deg))
    if len(outside) == 0:
        return 0.0
    return float(record[outside[-1] + 1, 0]) if outside[-1] + 1 < len(record) else np.nan


def _errors(record: np.ndarray) -> pd.DataFrame:
    kept = record[::THINNED]
    return pd.DataFrame(
        {
            "time_s": kept[:, 0],
            "error_deg": np.degrees(kept[:, _ERROR]),
            "torque_N_m": np.linalg.norm(kept[:, _TORQUE], axis=1),
            "mode": kept[:, _MODE].astype(int),
        }
    )


def _overflow(case: str, section: Configuration) -> NotConverged:
    return NotConverged(
        case=case,
        status="no number: the motion is too fast for the step",
        tried=f"classical Runge-Kutta steps of {section.step_s:g} s, the torque held over a step",
    )
