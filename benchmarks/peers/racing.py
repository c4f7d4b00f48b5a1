"""The race's first rings: our exact segments, multiple shooting by CasADi, single by SciPy.

All three hold the thrust over the same pieces and begin with the same arcs through the rings. What
is judged is the thrust that they found, flown anew through all segments without a stop.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
from contender import Contender, Problem
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline

from smallsat.config import default_config
from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.studies.racing.methods.course_program import Arcs, CourseProgram
from smallsat.studies.racing.methods.races import whole_leg
from smallsat.studies.racing.parameters import Parameters

SECTION = default_config(Path(__file__).parents[2]).racing
PARAMETERS = Parameters.from_section(SECTION)
RACE = PARAMETERS.races["scenario-1"]
CUBESAT = next(one for one in RACE.cubesats if one.name == "Meeny")
# Through these many rings, to rest in the centre of the next. Of all 22 the dense programs of SciPy
# would have 1400 variables.
RINGS = 5
COURSE = replace(
    RACE.course,
    centres=RACE.course.centres[:RINGS],
    normals=RACE.course.normals[:RINGS],
    semi_axes=RACE.course.semi_axes[:RINGS],
    end=RACE.course.centres[RINGS],
)
SEGMENTS, INTERVALS = RINGS + 1, SECTION.optimum.intervals
# Of the reference: with twice as many the race is shorter by 1.3e-5.
FINER = max(SECTION.optimum.finer_intervals)
# A thousandth of the time, and of the way from ring to ring: less than the rings' smallest axes.
REQUIRED = 1e-3
PLACES = np.vstack([CUBESAT.position, COURSE.centres, COURSE.end])
GAPS = np.linalg.norm(np.diff(PLACES, axis=0), axis=1)
# Peers are scaled by the way and the thrust, so that their numbers are of order one.
LENGTH = float(GAPS.max())
TIME = float(np.sqrt(LENGTH / CUBESAT.thrust))
MATRIX = rate_matrix(PARAMETERS.mean_motion * TIME)
PUSH = np.vstack([np.zeros((3, 3)), np.eye(3)])
# A held thrust is flown to this by SciPy.
TOLERANCE = 1e-9
# Bounds of ring speeds and of segments' durations, scaled.
LEAST, LONGEST = 1e-3, 20.0

# Durations (m,), s, and held accelerations (m, N, 3), m/s^2.
Thrust = tuple[np.ndarray, np.ndarray]


def problem() -> Problem:
    """A race through the first rings of Scenario 1."""
    reference = _plan(FINER).time

    def error(found: Thrust) -> float:
        """The largest of what is missed, over the way, and of the relative difference of times."""
        durations, controls = found
        ends = _flown(durations, controls)
        missed = np.linalg.norm(ends[:, :3] - PLACES[1:], axis=1) / GAPS
        # Across the normal at the rings, and of what is to be rest at the end.
        speeds = np.linalg.norm(ends[:-1, 3:], axis=1)
        across = np.linalg.norm(np.cross(ends[:-1, 3:], COURSE.normals), axis=1) / speeds
        rest = np.linalg.norm(ends[-1, 3:]) / speeds.max()
        excess = np.linalg.norm(controls, axis=2).max() / CUBESAT.thrust - 1.0
        longer = abs(durations.sum() / reference - 1.0)
        return float(max(*missed, *across, rest, excess, longer))

    return Problem(
        f"racing: {RINGS} rings, {INTERVALS} held thrusts a segment",
        f"relative error of the time against {FINER} held thrusts; of the thrust flown by DOP853, "
        "misses over the way, angles off the normals, speed at rest and thrust over its limit, "
        "whichever is largest",
        REQUIRED,
        error,
        (
            Contender("exact segments, IPOPT", "smallsat", _ours),
            Contender("CasADi multiple shooting, IPOPT", "casadi", _casadi),
            Contender("SciPy single shooting, SLSQP", "scipy", _scipy),
        ),
        3,
    )


def _plan(intervals: int):
    program = CourseProgram(RINGS, "state", intervals)
    plan = program.solve(whole_leg(COURSE, CUBESAT), CUBESAT, PARAMETERS.mean_motion)
    assert plan.converged
    return plan


def _flown(durations: np.ndarray, controls: np.ndarray) -> np.ndarray:
    """States (m, 6) at the ends of the segments, in SI units."""
    matrix = rate_matrix(PARAMETERS.mean_motion)
    state, ends = np.r_[CUBESAT.position, np.zeros(3)], []
    for duration, row in zip(durations, controls, strict=True):
        for thrust in row:
            state = solve_ivp(
                lambda _, x, push=PUSH @ thrust: matrix @ x + push,
                (0.0, duration / len(row)),
                state,
                method="DOP853",
                rtol=1e-12,
                atol=1e-12,
            ).y[:, -1]
        ends.append(state)
    return np.array(ends)


def _ours():
    program, leg = CourseProgram(RINGS, "state", INTERVALS), whole_leg(COURSE, CUBESAT)
    # The program is built with the first solve.
    program.solve(leg, CUBESAT, PARAMETERS.mean_motion)

    def solve() -> Thrust:
        plan = program.solve(leg, CUBESAT, PARAMETERS.mean_motion)
        return plan.durations, plan.controls

    return solve


def _guess() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Durations (m,), ring speeds (l,), controls (m, N, 3), states (m, N, 6), scaled: our arcs."""
    arcs, gaps = Arcs(), GAPS / LENGTH
    durations, speeds = arcs.time * np.sqrt(gaps), arcs.speed * np.sqrt(gaps[:RINGS])
    velocities = np.vstack([np.zeros(3), speeds[:, None] * COURSE.normals, np.zeros(3)])
    ends = np.r_[0.0, np.cumsum(durations)]
    arc = CubicHermiteSpline(ends, PLACES / LENGTH, velocities)
    step = durations[:, None] / INTERVALS
    times = ends[:-1, None] + step * np.arange(INTERVALS)
    controls = arc(times + step / 2, 2)
    size = np.linalg.norm(controls, axis=2, keepdims=True)
    states = np.concatenate([arc(times), arc(times, 1)], axis=2)
    return durations, speeds, 0.9 * controls / np.maximum(size, 0.9), states


def _casadi():
    import casadi as ca

    opti = ca.Opti()
    durations, speeds = opti.variable(SEGMENTS), opti.variable(RINGS)
    states = [opti.variable(6, INTERVALS + 1) for _ in range(SEGMENTS)]
    controls = [opti.variable(3, INTERVALS) for _ in range(SEGMENTS)]
    x, u, h = ca.SX.sym("x", 6), ca.SX.sym("u", 3), ca.SX.sym("h")

    def rate(state):
        return ca.DM(MATRIX) @ state + ca.DM(PUSH) @ u

    k1 = rate(x)
    k2 = rate(x + h / 2 * k1)
    k3 = rate(x + h / 2 * k2)
    k4 = rate(x + h * k3)
    step = ca.Function("step", [x, u, h], [x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)])
    opti.minimize(ca.sum(durations))
    opti.subject_to(opti.bounded(LEAST, durations, LONGEST))
    opti.subject_to(speeds >= LEAST)
    start = np.r_[CUBESAT.position / LENGTH, np.zeros(3)]
    piece = step.map(INTERVALS)
    for k in range(SEGMENTS):
        opti.subject_to(states[k][:, 0] == start)
        flown = piece(
            states[k][:, :-1], controls[k], ca.repmat(durations[k] / INTERVALS, 1, INTERVALS)
        )
        opti.subject_to(flown == states[k][:, 1:])
        opti.subject_to(ca.sum1(controls[k] ** 2) <= 1.0)
        start = states[k][:, -1]
        velocity = speeds[k] * COURSE.normals[k] if k < RINGS else np.zeros(3)
        opti.subject_to(start == ca.vertcat(PLACES[k + 1] / LENGTH, velocity))
    opti.solver(
        "ipopt", {"expand": True, "print_time": False}, {"print_level": 0, "sb": "yes", "tol": 1e-9}
    )
    first = _guess()

    def solve() -> Thrust:
        for variable, value in ((durations, first[0]), (speeds, first[1])):
            opti.set_initial(variable, value)
        for k in range(SEGMENTS):
            opti.set_initial(controls[k], first[2][k].T)
            opti.set_initial(states[k][:, :-1], first[3][k].T)
            after = first[3][k + 1, 0] if k < RINGS else np.r_[COURSE.end / LENGTH, np.zeros(3)]
            opti.set_initial(states[k][:, -1], after)
        found = opti.solve()
        thrust = np.array([found.value(one).T for one in controls])
        return found.value(durations) * TIME, thrust * CUBESAT.thrust

    solve()
    return solve


def _scipy():
    from scipy.optimize import Bounds, minimize

    count = 3 * SEGMENTS * INTERVALS
    total = SEGMENTS + RINGS + count

    def split(z: np.ndarray):
        shape = (SEGMENTS, INTERVALS, 3)
        return z[:SEGMENTS], z[SEGMENTS : SEGMENTS + RINGS], z[SEGMENTS + RINGS :].reshape(shape)

    def piece(state: np.ndarray, thrust: np.ndarray, duration: float) -> np.ndarray:
        """State after a held thrust, and its derivatives by the state and the thrust, (6, 10)."""
        push = np.column_stack([PUSH @ thrust, np.zeros((6, 6)), PUSH])
        begin = np.column_stack([state, np.eye(6), np.zeros((6, 3))])
        flown = solve_ivp(
            lambda _, y: (MATRIX @ y.reshape(6, 10) + push).ravel(),
            (0.0, duration),
            begin.ravel(),
            method="DOP853",
            rtol=TOLERANCE,
            atol=TOLERANCE,
        )
        return flown.y[:, -1].reshape(6, 10)

    known: dict[bytes, tuple[np.ndarray, np.ndarray]] = {}

    def crossings(z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What the ends of the segments miss, (6 m,), and its derivatives (6 m, n)."""
        key = z.tobytes()
        if key in known:
            return known[key]
        durations, speeds, controls = split(z)
        state, moved = np.r_[CUBESAT.position / LENGTH, np.zeros(3)], np.zeros((6, total))
        missed, derivatives = np.empty((SEGMENTS, 6)), np.empty((SEGMENTS, 6, total))
        for k in range(SEGMENTS):
            for i in range(INTERVALS):
                found = piece(state, controls[k, i], durations[k] / INTERVALS)
                state, moved = found[:, 0], found[:, 1:7] @ moved
                place = SEGMENTS + RINGS + 3 * (INTERVALS * k + i)
                moved[:, place : place + 3] += found[:, 7:]
                moved[:, k] += (MATRIX @ state + PUSH @ controls[k, i]) / INTERVALS
            missed[k], derivatives[k] = state, moved
            missed[k, :3] -= PLACES[k + 1] / LENGTH
            if k < RINGS:
                missed[k, 3:] -= speeds[k] * COURSE.normals[k]
                derivatives[k, 3:, SEGMENTS + k] -= COURSE.normals[k]
        known.clear()
        known[key] = missed.ravel(), derivatives.reshape(-1, total)
        return known[key]

    def room(z: np.ndarray) -> np.ndarray:
        return 1.0 - np.sum(split(z)[2] ** 2, axis=2).ravel()

    def room_by(z: np.ndarray) -> np.ndarray:
        rows = np.zeros((SEGMENTS * INTERVALS, total))
        pieces = np.arange(SEGMENTS * INTERVALS)
        controls = split(z)[2].reshape(-1, 3)
        for axis in range(3):
            rows[pieces, SEGMENTS + RINGS + 3 * pieces + axis] = -2.0 * controls[:, axis]
        return rows

    low = np.r_[np.full(SEGMENTS + RINGS, LEAST), np.full(count, -1.0)]
    high = np.r_[np.full(SEGMENTS, LONGEST), np.full(RINGS, np.inf), np.ones(count)]
    gradient = np.r_[np.ones(SEGMENTS), np.zeros(total - SEGMENTS)]
    durations, speeds, controls, _ = _guess()
    first = np.concatenate([durations, speeds, controls.ravel()])

    def solve() -> Thrust:
        known.clear()
        found = minimize(
            lambda z: float(z[:SEGMENTS].sum()),
            first,
            jac=lambda z: gradient,
            bounds=Bounds(low, high),
            constraints=(
                {"type": "eq", "fun": lambda z: crossings(z)[0], "jac": lambda z: crossings(z)[1]},
                {"type": "ineq", "fun": room, "jac": room_by},
            ),
            method="SLSQP",
            options={"ftol": 1e-8, "maxiter": 300},
        )
        assert found.success
        durations, _, controls = split(found.x)
        return durations * TIME, controls * CUBESAT.thrust

    return solve
