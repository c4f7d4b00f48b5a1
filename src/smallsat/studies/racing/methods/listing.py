"""The document's segment problem as its listings state it, solved as ``fmincon`` is documented to.

Seven unknowns, the initial costates and the time of arrival; the miss of the ring plus the duration
is to be least (Listing C.D) under the constraints of Listing C.E. What is kept: the guess, the
bounds, every redundant equality, the slip of the costates, the deadzone of 1 in the flight and of 0
in the constraints, ``min(S)`` over all entries of the matrix S (so that a ring has no size), the
flight on the steps of ``ode45``, and going on from wherever a solve ended. The options
``EnableFeasibilityMode`` and ``SubproblemAlgorithm`` belong to another algorithm and do nothing.

What is not MATLAB's is said in `fmincon_sqp` and `ode45`. A primer vector of exactly zero gives no
thrust instead of no number, and so does the guess where a CubeSat starts at the last ring's centre.
"""

from dataclasses import dataclass

import numpy as np

from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.lanes import LANES
from smallsat.optimal_control.fmincon_sqp import Problem, minimise
from smallsat.studies.racing.methods.flight import least_time
from smallsat.studies.racing.methods.ode45 import end_of_flight, ends_of_flights
from smallsat.studies.racing.model.cubesat import CubeSat
from smallsat.studies.racing.model.shooting import hamiltonian, law_of
from smallsat.studies.racing.parameters import Listing

EQUALITIES, INEQUALITIES = 12, 2
COSTATES, UNKNOWNS = 6, 7
# In words, the exit flags of the solver.
STATUS = {1: "converged", 2: "step too small", 0: "evaluations used up", -2: "no feasible point"}


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
    costate, arrival
        The seven unknowns; the time is that since the start of the race, s.
    converged, status
        What the solver says; the document never asks.
    violation
        Largest violation of a constraint at the end.
    evaluations
        Evaluations of cost and constraints, differences included.
    end
        State (6,) at the end.
    """

    costate: np.ndarray
    arrival: float
    converged: bool
    status: str
    violation: float
    evaluations: int
    end: np.ndarray


def guess(
    state: np.ndarray, began: float, target: Target, thrust: float, listing: Listing
) -> tuple[np.ndarray, float]:
    """The listing's guess (7,), and the least possible duration, s."""
    gap = target.centre - state[:3]
    speed = float(np.linalg.norm(state[3:]))
    distance = float(np.linalg.norm(gap))
    shortest = least_time(distance, speed, thrust)
    behind = state[:3] - target.previous_centre
    size = float(np.linalg.norm(behind))
    position_part = behind / size if size > 0.0 else np.zeros(3)
    velocity_part = -gap / (distance if speed == 0.0 else speed)
    arrival = began + listing.duration_multiple * shortest
    return np.r_[position_part, velocity_part, arrival], shortest


def solve_segment(
    state: np.ndarray,
    began: float,
    target: Target,
    cubesat: CubeSat,
    mean_motion: float,
    listing: Listing,
    unknowns: np.ndarray | None = None,
) -> Segment:
    """Solve one segment from a state (6,) at a time since the start of the race, s.

    ``unknowns`` (7,) is another guess than the listing's.
    """
    law, limits = law_of(cubesat)
    start, shortest = guess(state, began, target, cubesat.thrust, listing)
    size = target.size if listing.ring_sizes else 0.0
    dynamics = (mean_motion, listing.transposed, law, limits)
    wanted = (target.centre, target.normal, size, listing.plane, target.final)
    numbers = (
        listing.deadzone, listing.constraint_deadzone, listing.final_hamiltonian, listing.tolerance,
    )  # fmt: skip
    bound = listing.costate_bound
    solution = minimise(
        Problem(
            lambda points: functions(points, state, began, dynamics, wanted, numbers),
            np.r_[np.full(COSTATES, -bound), began + shortest],
            np.r_[np.full(COSTATES, bound), np.inf],
            EQUALITIES,
            ahead=LANES,
        ),
        start if unknowns is None else unknowns,
        listing.evaluations,
    )
    costate, arrival = solution.variables[:COSTATES], float(solution.variables[COSTATES])
    flown, _ = end_of_flight(
        np.r_[state, costate], began, arrival, *dynamics, listing.deadzone, listing.tolerance
    )
    return Segment(
        costate=costate,
        arrival=arrival,
        converged=solution.exit_flag == 1,
        status=STATUS[solution.exit_flag],
        violation=solution.violation,
        evaluations=solution.evaluations,
        end=flown[:6],
    )


@compiled
def functions(points, state, began, dynamics, wanted, numbers):
    """Cost, equalities and inequalities, as `_values`, of unknowns (m, 7): (m, 13) or (m, 15)."""
    (mean_motion, transposed, law, limits), final = dynamics, wanted[4]
    deadzone, tolerance = numbers[0], numbers[3]
    found = np.empty((len(points), 1 + EQUALITIES + (0 if final else INEQUALITIES)))
    for first in range(0, len(points), LANES):
        group = points[first : first + LANES]
        before, arrivals = np.empty((LANES, 12)), np.empty(LANES)
        for lane in range(LANES):
            # lanes that are left over fly the last one once more
            z = group[min(lane, len(group) - 1)]
            before[lane, :6], before[lane, 6:], arrivals[lane] = state, z[:COSTATES], z[COSTATES]
        after = ends_of_flights(
            before, began, arrivals, mean_motion, transposed, law, limits, deadzone, tolerance
        )
        for lane in range(len(group)):
            duration = arrivals[lane] - began
            found[first + lane] = _values(
                before[lane], after[lane], duration, dynamics, wanted, numbers
            )
    return found


@compiled
def _values(before, after, duration, dynamics, wanted, numbers):
    """Cost, twelve equalities in the listing's order, and the two inequalities of a ring.

    Of states with costates (12,) at the ends of a flight, s.
    """
    mean_motion, _, law, limits = dynamics
    centre, normal, size, plane, final = wanted
    _, constraint_deadzone, target, _ = numbers
    first = hamiltonian(before, mean_motion, law, limits, constraint_deadzone)
    last = hamiltonian(after, mean_motion, law, limits, constraint_deadzone)
    # The initial state and time are met whatever the unknowns are: seven rows that never move.
    values = np.zeros(1 + EQUALITIES + (0 if final else INEQUALITIES))
    if final:
        values[0] = duration
        values[1:4] = after[3:6]
        values[4], values[5] = last - first, last - target
    else:
        miss, velocity = after[:3] - centre, after[3:6]
        distance = np.sqrt(miss @ miss)
        values[0] = distance + duration
        values[1], values[2] = last - first, last - target
        values[10:13] = velocity / np.sqrt(velocity @ velocity) - normal
        values[13], values[14] = distance - size, abs(miss @ normal) - plane
    return values
