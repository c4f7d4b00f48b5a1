"""The guidance law's settings as plain data: one record a parameter set, for the compiled loop."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.studies.rendezvous.model.geometry import GREAT_CIRCLE, rotated
from smallsat.studies.rendezvous.model.prediction import terminal_weight, transition

PHASES = ("far", "mid", "final")
RENDEZVOUS, APPROACH, DOCKING = 0, 1, 2
# How far a phase's states reach, in the largest horizon's control, sets the unit of length.
HARD_WEIGHT = 100.0

# Readings of what the document leaves open.
DISTANCE, ALONG_AXIS = 0, 1  # how the end of a phase measures how far the chaser is
AT_START, AT_HORIZON, AT_STAGE = 0, 1, 2  # when a rotating reference or cone is taken

SETTINGS = np.dtype(
    [
        ("horizons", np.int64, (3,)),
        ("sample_times", float, (3,)),
        ("transitions", float, (3, 6, 6)),  # scaled
        ("scales", float, (3, 6)),
        ("state_hessians", float, (3, 6)),
        ("terminal_hessians", float, (3, 6, 6)),
        ("control_hessians", float, (3, 3)),
        ("norm_weights", float, (6,)),  # of the far range's 1-norm, scaled; zero: quadratic
        ("norm_terminal_weights", float, (6,)),
        ("norm_control_weights", float, (3,)),
        ("penalties", float, (3,)),
        ("hard_weights", float, (3,)),
        ("control_bounds", float, (3,)),
        ("speed_bound", float),
        ("tangents", float, (3,)),
        ("axis", float, (3,)),
        ("rotation_rate", float),
        ("port", float),
        ("set_points", float, (2,)),
        ("keep_out", float),
        ("overshoot", float),
        ("plane_rate", float),
        ("plane_turn", np.int64),
        ("switches", np.int64, (3,)),
        ("switch_distances", float, (3,)),
        ("set_point_time", np.int64),
        ("terminal_cone_time", np.int64),
        ("reference_moves", np.int64),
        ("time_limit", float),
        ("burn_time", float),  # truth, as the drifts
        ("mean_motion", float),
        ("elliptic", np.int64),  # prediction varies with the true anomaly, given for time zero
        ("eccentricity", float),
        ("true_anomaly", float),
        ("drifts_before", float, (3, 6, 6)),  # truth in metres: until a delayed control acts
        ("drifts_after", float, (3, 6, 6)),
        ("predictions_before", float, (3, 6, 6)),  # the law's own, to make up for the delay
        ("delays", float, (3,)),
        ("has_tube", np.int64),
        ("feedback", float, (3, 6)),
        ("feedback_bound", float),
        ("cone_margin", float),
        ("speed_margin", float),
    ],
    align=True,
)
# Fields of a record that are those of the law.
AS_THEY_ARE = (
    "horizons", "sample_times", "control_bounds", "speed_bound", "axis", "rotation_rate", "port",
    "set_points", "keep_out", "overshoot", "plane_turn", "switches", "switch_distances",
    "set_point_time", "terminal_cone_time", "reference_moves", "time_limit",
    "burn_time", "mean_motion", "true_anomaly", "feedback_bound", "cone_margin", "speed_margin",
)  # fmt: skip


@dataclass(frozen=True)
class Law:
    """A guidance law, in SI units; triples are far range, mid range, final phase.

    Attributes
    ----------
    mean_motion
        Mean motion of the target, rad/s.
    sample_times, horizons
        s; steps.
    state_weights, control_weights
        Diagonals of Q, (6,) each, and of R, (3,) each.
    terminal_weights
        Qf as a multiple of Q; zero stands for the Riccati solution.
    penalties
        Weight of the cone penalty, per metre.
    cone_angles
        Half angles, rad.
    control_bounds
        Largest velocity change of a step and axis, m/s.
    keep_out, overshoot, end_distance
        r1, r2, r3, m.
    set_points
        On the axis, m from the target; zero: the target itself.
    switches
        How each phase's end is measured: ``DISTANCE`` from the target (in the last phase the port)
        or ``ALONG_AXIS``. The far range asks for the cone too.
    switch_distances
        m.
    speed_bound
        Largest velocity along each axis in the final phase, m/s.
    axis
        Approach axis at the start, unit vector.
    rotation_rate
        Turn of the target, and with it of the approach axis, about z, rad/s.
    port
        Distance of the docking port from the target on the axis, m.
    plane_rate
        Largest rotation rate of the keep-out plane in mean motions.
    plane_turn
        `geometry.GREAT_CIRCLE` or `UPRIGHT`.
    norm_weights, norm_terminal_weights, norm_control_weights
        Diagonals of the far range's 1-norm cost (2.10), (6,), (6,), (3,); ``None``: quadratic.
    set_point_time, terminal_cone_time
        When a rotating set point and the far range's cone and planes are taken.
    reference_moves
        Whether a rotating reference has the velocity of its rotation.
    prediction
        Continuous matrix of the prediction model; ``None``: Clohessy-Wiltshire.
    eccentricity, true_anomaly
        Of the target's orbit, and where it is at time zero, rad, for a prediction by Yamanaka and
        Ankersen; ``None``: by one matrix. The Riccati solution stays that of the one matrix.
    delay
        s from a step's start until its control acts.
    delay_known
        Whether the law predicts its state over the delay.
    time_limit
        s.
    burn_time
        In linear motion, how long a thruster burns for a change of velocity, s per m/s; zero: no
        time, by impulses. The law itself always plans impulses.
    feedback
        Of the docking phase's tube, (3, 6), see `tube`; ``None``: no tube.
    feedback_bound, cone_margin, speed_margin
        What the feedback has of the control, m/s, beside the bound of the nominal one; and what
        the docking phase's cone and speed are tightened by, m and m/s.
    """

    mean_motion: float
    sample_times: tuple[float, float, float]
    horizons: tuple[int, int, int]
    state_weights: np.ndarray
    control_weights: np.ndarray
    penalties: tuple[float, float, float]
    cone_angles: tuple[float, float, float]
    control_bounds: tuple[float, float, float]
    keep_out: float
    overshoot: float
    set_points: tuple[float, float]
    switch_distances: tuple[float, float, float]
    speed_bound: float
    axis: tuple[float, float, float]
    rotation_rate: float = 0.0
    port: float = 0.5
    plane_rate: float = 1.0
    plane_turn: int = GREAT_CIRCLE
    switches: tuple[int, int, int] = (ALONG_AXIS, DISTANCE, DISTANCE)
    terminal_weights: tuple[float, float, float] = (0.0, 0.0, 0.0)
    norm_weights: np.ndarray | None = None
    norm_terminal_weights: np.ndarray | None = None
    norm_control_weights: np.ndarray | None = None
    set_point_time: int = AT_START
    terminal_cone_time: int = AT_HORIZON
    reference_moves: bool = True
    prediction: np.ndarray | None = None
    eccentricity: float | None = None
    true_anomaly: float = 0.0
    delay: float = 0.0
    delay_known: bool = False
    time_limit: float = 12000.0
    burn_time: float = 0.0
    feedback: np.ndarray | None = None
    feedback_bound: float = 0.0
    cone_margin: float = 0.0
    speed_margin: float = 0.0

    def with_(self, **changes: Any) -> "Law":
        """The same law with some attributes changed."""
        return replace(self, **changes)

    def axis_at(self, time: float) -> np.ndarray:
        """The approach axis at a time, s: unit vector (3,) in the Hill frame."""
        axis = np.empty(3)
        rotated(np.array(self.axis), self.rotation_rate * time, axis)
        return axis


def in_phase(values: tuple[Any, ...], phase: int, value: Any) -> tuple[Any, ...]:
    """A triple of a law with one phase's entry replaced."""
    return (*values[:phase], value, *values[phase + 1 :])


def settings(laws: Sequence[Law]) -> np.ndarray:
    """One record a law, shape (L,) of `SETTINGS`, with scaled matrices.

    Positions are scaled by the way that a full control makes over the horizon, velocities by the
    control's bound, costs by the terminal weight.
    """
    records = np.zeros(len(laws), SETTINGS)
    for record, law in zip(records, laws, strict=True):
        _fill(record, law)
    return records


def _fill(record: Any, law: Law) -> None:
    true_matrix = rate_matrix(law.mean_motion)
    matrix = true_matrix if law.prediction is None else law.prediction
    reaches = (2.0 * law.keep_out + 1000.0, law.keep_out, law.overshoot)
    for phase in range(3):
        duration, horizon = law.sample_times[phase], law.horizons[phase]
        bound = law.control_bounds[phase]
        length = bound * duration * horizon
        scale = np.array([length] * 3 + [bound] * 3)
        step = transition(matrix, duration)
        weights, control = np.asarray(law.state_weights)[phase], law.control_weights[phase]
        if law.terminal_weights[phase] > 0.0:
            terminal = law.terminal_weights[phase] * np.diag(weights)
        else:
            terminal = terminal_weight(step, weights, control)
        terminal = 2.0 * terminal * np.outer(scale, scale)
        cost = 1.0 / np.abs(terminal).max()
        record["transitions"][phase] = step * scale[None, :] / scale[:, None]
        record["scales"][phase] = scale
        record["state_hessians"][phase] = 2.0 * cost * weights * scale**2
        record["terminal_hessians"][phase] = cost * terminal
        record["control_hessians"][phase] = 2.0 * cost * np.asarray(control) * bound**2
        record["penalties"][phase] = law.penalties[phase] * length * cost
        record["hard_weights"][phase] = HARD_WEIGHT * max(reaches[phase] / length, 1.0)
        record["tangents"][phase] = np.tan(law.cone_angles[phase])
        record["drifts_before"][phase] = transition(true_matrix, law.delay)
        record["drifts_after"][phase] = transition(true_matrix, duration - law.delay)
        known = law.delay if law.delay_known else 0.0
        record["predictions_before"][phase] = transition(matrix, known)
        record["delays"][phase] = law.delay
    if law.norm_weights is not None:
        assert law.norm_terminal_weights is not None and law.norm_control_weights is not None
        scale = record["scales"][0]
        norms = law.norm_weights * scale
        terminal = law.norm_terminal_weights * scale
        control = law.norm_control_weights * law.control_bounds[0]
        cost = 1.0 / max(terminal.max(), norms.max())
        record["norm_weights"] = cost * norms
        record["norm_terminal_weights"] = cost * terminal
        record["norm_control_weights"] = cost * control
        record["penalties"][0] = law.penalties[0] * scale[0] * cost
        record["hard_weights"][0] = HARD_WEIGHT * law.horizons[0]
    if law.feedback is not None:
        record["has_tube"], record["feedback"] = 1, law.feedback
    if law.eccentricity is not None:
        record["elliptic"], record["eccentricity"] = 1, law.eccentricity
    record["plane_rate"] = law.plane_rate * law.mean_motion
    for name in AS_THEY_ARE:
        record[name] = getattr(law, name)
