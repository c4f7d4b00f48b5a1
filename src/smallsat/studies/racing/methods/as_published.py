"""The document's segment problem as its listings state it, through an SQP method.

Seven unknowns, the initial costates and the duration; the miss of the ring plus the duration is to
be least (Listing C.D) under the constraints of Listing C.E. What is kept: the guess, the bounds,
every redundant equality, the sign slip of the costates, the deadzone of 1 in the flight and of 0
in the constraints, ``min(S)`` over all entries of the matrix S (so that a ring has no size), the
number of function evaluations, forward differences, and going on from wherever a solve ended.

What differs from fmincon: the SQP method is our own elastic one, which like fmincon's bears
dependent equalities (the steps of a plain SQP method, such as SLSQP, need independent ones: whether
it stops at them is up to the rounding). Where it ends
infeasible, the weight of the constraints is raised tenfold and it goes on. A primer vector of
exactly zero gives no thrust instead of no number, and so does the guess where a CubeSat starts at
the last ring's centre.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.optimal_control.elastic_sqp import ElasticSqp
from smallsat.studies.racing.model.cubesat import CubeSat
from smallsat.studies.racing.model.shooting import (
    DIRECTED,
    NORM_OF_AXES,
    costate_matrix,
    end_of_segment,
    thrust_of,
)

EQUALITIES, INEQUALITIES = 12, 2
# fmincon's default tolerance of constraints.
TOLERANCE = 1e-6
DIFFERENCE = float(np.sqrt(np.finfo(float).eps))
COSTATES, UNKNOWNS = 6, 7


@dataclass(frozen=True)
class Settings:
    """Numbers of Listings C.C and C.E, and how faithfully they are followed.

    Attributes
    ----------
    duration_multiple
        Multiple of the least possible time, for the guess of the duration.
    costate_bound
        Bound of each initial costate, either way.
    evaluations
        Largest number of function evaluations, differences included.
    deadzone, constraint_deadzone
        Size below which a component of the primer counts as none, in the flight and in the
        constraints.
    final_hamiltonian
        Its target.
    plane
        Largest distance from the ring's plane, m.
    panels
        Panels of the quadrature of a segment.
    first_penalty
        Weight that the method first gives the constraints; not the document's.
    transposed
        Whether the costates' matrix is the right one; the listing's is not.
    ring_sizes
        Whether a ring has its smaller axis as its size; by the listing it has none.
    """

    duration_multiple: float
    costate_bound: float
    evaluations: int
    deadzone: float
    constraint_deadzone: float
    final_hamiltonian: float
    plane: float
    panels: int
    first_penalty: float = 1.0
    transposed: bool = False
    ring_sizes: bool = False


@dataclass(frozen=True)
class Target:
    """The ring a segment aims at, and the centre of the last one.

    ``final`` marks the last segment, which comes to rest and aims at nothing.
    """

    centre: np.ndarray
    normal: np.ndarray
    size: float
    previous_centre: np.ndarray
    final: bool


@dataclass(frozen=True)
class Segment:
    """What a solve ended with, whatever its status.

    Attributes
    ----------
    costate, duration
        The seven unknowns.
    cost, least_time
        Its cost, and the listing's "minimum possible cost".
    converged, status
        What the solver says; the document never asks.
    violation
        Largest violation of a constraint at the end.
    evaluations
        Evaluations of the functions, differences included.
    """

    costate: np.ndarray
    duration: float
    cost: float
    least_time: float
    converged: bool
    status: str
    violation: float
    evaluations: int


def least_time(distance: float, speed: float, thrust: float) -> float:
    """Time for a distance on a straight line at full thrust from a speed (Section IV.A)."""
    return (-speed + float(np.sqrt(speed**2 + 2.0 * thrust * distance))) / thrust


def law_of(cubesat: CubeSat) -> tuple[int, np.ndarray]:
    """The listing's law of thrust and its limits (3,)."""
    if cubesat.axis_thrust:
        return NORM_OF_AXES, np.array(cubesat.axis_thrust)
    return DIRECTED, np.full(3, cubesat.thrust)


def guess(
    state: np.ndarray, target: Target, thrust: float, settings: Settings
) -> tuple[np.ndarray, float]:
    """The listing's guess (7,), and the least possible time."""
    gap = target.centre - state[:3]
    speed = float(np.linalg.norm(state[3:]))
    distance = float(np.linalg.norm(gap))
    shortest = least_time(distance, speed, thrust)
    behind = state[:3] - target.previous_centre
    size = float(np.linalg.norm(behind))
    position_part = behind / size if size > 0.0 else np.zeros(3)
    velocity_part = -gap / (distance if speed == 0.0 else speed)
    return np.r_[position_part, velocity_part, settings.duration_multiple * shortest], shortest


def solve_segment(
    state: np.ndarray, target: Target, cubesat: CubeSat, mean_motion: float, settings: Settings
) -> Segment:
    """Solve one segment from a state (6,)."""
    law, limits = law_of(cubesat)
    start, shortest = guess(state, target, cubesat.thrust, settings)
    size = target.size if settings.ring_sizes else 0.0
    fixed = (
        state,
        rate_matrix(mean_motion),
        costate_matrix(mean_motion, settings.transposed),
        law,
        limits,
        (settings.deadzone, settings.constraint_deadzone),
        settings.final_hamiltonian,
        target.centre,
        target.normal,
        (size, settings.plane),
        target.final,
        settings.panels,
    )
    inequalities = 0 if target.final else INEQUALITIES
    bound = settings.costate_bound
    solution = _solver(inequalities).solve(
        lambda z: _with_differences(z, inequalities, *fixed),
        start,
        np.r_[np.full(6, -bound), shortest],
        np.r_[np.full(6, bound), np.inf],
        TOLERANCE,
        settings.evaluations // (UNKNOWNS + 1),
        settings.first_penalty,
    )
    return Segment(
        costate=solution.variables[:6],
        duration=float(solution.variables[6]),
        cost=solution.objective,
        least_time=shortest,
        converged=solution.converged,
        status=solution.status,
        violation=solution.violation,
        evaluations=solution.iterations * (UNKNOWNS + 1),
    )


@cache
def _solver(inequalities: int) -> ElasticSqp:
    return ElasticSqp(UNKNOWNS, EQUALITIES, inequalities)


@compiled
def _with_differences(z, inequalities, *fixed):
    size = 1 + EQUALITIES + inequalities
    values = _functions(z, *fixed)[:size]
    jacobian = np.empty((len(values), len(z)))
    for i in range(len(z)):
        step = DIFFERENCE * max(abs(z[i]), 1.0)
        moved = z.copy()
        moved[i] += step
        jacobian[:, i] = (_functions(moved, *fixed)[:size] - values) / step
    return values, jacobian


@compiled
def _functions(
    z, state, a, m, law, limits, deadzones, target, centre, normal, sizes, final, panels
):
    """Cost, twelve equalities in the listing's order, and the two inequalities of a ring."""
    values = np.zeros(1 + EQUALITIES + INEQUALITIES)
    costate, duration = z[:6].copy(), z[6]
    x, p = end_of_segment(state, costate, duration, a, m, law, limits, deadzones[0], panels)
    # p . (A x) is p_r . v + p_v . g.
    first = costate @ (a @ state) + costate[3:] @ thrust_of(
        costate[3:].copy(), law, limits, deadzones[1]
    )
    last = p @ (a @ x) + p[3:] @ thrust_of(p[3:].copy(), law, limits, deadzones[1])
    miss = x[:3] - centre
    # The initial state and time are met whatever the unknowns are: seven rows that never move.
    if final:
        values[0] = duration
        values[1:4] = x[3:]
        values[4], values[5] = last - first, last - target
    else:
        distance = np.sqrt(miss @ miss)
        values[0] = distance + duration
        values[1], values[2] = last - first, last - target
        values[10:13] = x[3:] / np.sqrt(x[3:] @ x[3:]) - normal
        values[13] = distance - sizes[0]
        values[14] = abs(miss @ normal) - sizes[1]
    return values
