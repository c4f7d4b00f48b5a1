"""The three-phase guidance law (Algorithm 1): a velocity change for a state, and a phase's end.

Errata of Algorithm 1: the far range ends where Hx <= 0 (not x <= Hx) and, since the keep-out
forbids |x| <= r1, within a margin of r1; the other phases end by a distance, not by x <= r.
States are relative positions, m, and velocities, m/s, in the target's Hill frame.
"""

from typing import NamedTuple

import numpy as np

from smallsat.dynamics.compiled import compiled
from smallsat.dynamics.lanes import LANES
from smallsat.optimal_control.riccati_interior_point import (
    CONTROLS,
    EXCESS,
    SOLVED,
    STATES,
    WEIGHT,
    Program,
    Solution,
    Workspace,
    solve_together,
    workspace,
)
from smallsat.studies.rendezvous.guidance.law import DISTANCE, DOCKING, RENDEZVOUS
from smallsat.studies.rendezvous.guidance.phase_programs import (
    BOUNDS,
    PLANES,
    empty_program,
    in_use,
    lane_of,
    write_program,
)
from smallsat.studies.rendezvous.model.geometry import in_cone, rotated

TOLERANCE = 1e-10  # of the solver, relative
ITERATION_LIMIT = 100
SOFTENED = 1e-5  # scaled excess of a hard row that counts as having given way


class Together(NamedTuple):
    """What is written on to solve the programs of several states at once, in lanes.

    Attributes
    ----------
    programs, work
        The programs of a step, and the solver's workspace, with a last axis more, of the lanes.
    scaled
        The states in units of the law's scales, (6, LANES).
    ends
        Status and iterations of each, (2, LANES).
    """

    programs: Program
    work: Workspace
    scaled: np.ndarray
    ends: np.ndarray


class Memory(NamedTuple):
    """What the controller of one manoeuvre writes on, for horizons of up to N stages.

    Attributes
    ----------
    together
        Its program, in every lane.
    plan
        Controls of the phase's last solved program, (N, 3), m/s.
    remaining
        How many of them, at the end of the plan, are still to come, (1,). A phase begins with none.
    """

    together: Together
    plan: np.ndarray
    remaining: np.ndarray


class Control(NamedTuple):
    """How a velocity change was found.

    Attributes
    ----------
    status, iterations
        How the solver ended and its steps, see `riccati_interior_point.Solution`.
    softened
        Number of hard rows that gave way.
    outside
        Whether the start of the horizon violated a constraint.
    """

    status: int
    iterations: int
    softened: int
    outside: bool


def memory_for(stages: int) -> Memory:
    """Return a `Memory` for horizons of up to that many stages."""
    return Memory(together_for(stages), np.zeros((stages, CONTROLS)), np.zeros(1, np.int64))


def together_for(stages: int) -> Together:
    """Return a `Together` for horizons of up to that many stages."""

    def widened(arrays):
        return type(arrays)(
            *(np.zeros((*a.shape, LANES)) if a.dtype == float else a for a in arrays)
        )

    one = empty_program(stages)
    return Together(
        widened(one)._replace(signs=one.signs),
        widened(workspace(stages, PLANES, BOUNDS)),
        np.zeros((STATES, LANES)),
        np.zeros((2, LANES)),
    )


@compiled
def next_control(law, phase, state, time, memory, command):
    """Fill `command` with the guidance law's velocity change (3,), m/s, for a state.

    Where the program is not solved, the control that the last solved plan of the phase has for now
    is taken; where that plan is used up, none.

    Parameters
    ----------
    law, phase, state, time
        `SETTINGS` record; 0, 1 or 2; relative state (6,), m and m/s; s.
    memory
        What `memory_for` returned, the same for all steps of a manoeuvre.
    command
        Filled.

    Returns
    -------
    Control
    """
    for lane in range(1, LANES):
        write_lane(law, phase, state, time, memory.together, lane)
    outside = write_lane(law, phase, state, time, memory.together, 0)
    rows = solve_lanes(law, phase, memory.together)
    return control_of_lane(
        law, phase, memory.together, 0, rows, outside, memory.plan, memory.remaining, command
    )


@compiled
def write_lane(law, phase, state, time, together, lane):
    """Write the program of a state into a lane; arguments as of `next_control`.

    Returns
    -------
    bool
        Whether a constraint is violated at the start.
    """
    _, outside = write_program(law, phase, state, time, lane_of(together.programs, lane))
    _scale(law, phase, state, together.scaled[:, lane])
    return outside


@compiled
def _scale(law, phase, state, scaled):
    """Fill in a state (6,) in units of the law's scales."""
    for k in range(STATES):
        scaled[k] = state[k] / law.scales[phase, k]


@compiled
def solve_lanes(law, phase, together):
    """Solve all lanes, of the shape that a law's phase has; return their rows on states."""
    return solve_together(
        in_use(together.programs, law, phase), law.horizons[phase],
        together.scaled, together.work, TOLERANCE, ITERATION_LIMIT, together.ends,
    )  # fmt: skip


@compiled
def control_of_lane(law, phase, together, lane, rows, outside, plan, remaining, command):
    """Fill `command` from what was found in a lane; arguments and result as of `next_control`."""
    solution = Solution(
        int(together.ends[0, lane]),
        int(together.ends[1, lane]),
        together.work.controls[: law.horizons[phase], :, lane],
        together.work.rows[WEIGHT, :rows, lane],
        together.work.rows[EXCESS, :rows, lane],
    )
    softened = _take(law, phase, solution, plan, remaining, command)
    return Control(solution.status, solution.iterations, softened, outside)


@compiled
def _take(law, phase, solution, plan, remaining, command):
    """Keep a solution as the plan, take the plan's control for now; return the rows that gave way.

    Where the program was not solved, the plan is the one before.
    """
    stages, softened = law.horizons[phase], 0
    if solution.status == SOLVED:
        for r in range(len(solution.weights)):
            hard = solution.weights[r] == law.hard_weights[phase]
            if hard and solution.excesses[r] > SOFTENED:
                softened += 1
        for i in range(stages):
            for k in range(CONTROLS):
                plan[i, k] = law.control_bounds[phase] * solution.controls[i, k]
        remaining[0] = stages
    left = remaining[0]
    for k in range(CONTROLS):
        command[k] = plan[stages - left, k] if left > 0 else 0.0
    remaining[0] = max(left - 1, 0)
    return softened


@compiled
def _offset(law, phase, state, time, axis):
    """Return how far a state is from where its phase leads, m: along the axis, and in all.

    The docking phase leads to the port, the others to the target. `axis` (3,) is filled.
    """
    rotated(law.axis, law.rotation_rate * time, axis)
    tip = law.port if phase == DOCKING else 0.0
    along, square = 0.0, 0.0
    for k in range(3):
        offset = state[k] - tip * axis[k]
        along += offset * axis[k]
        square += offset * offset
    return along, np.sqrt(square)


@compiled
def phase_ended(law, phase, state, time):
    """Whether a phase's end condition holds for a state (6,), m and m/s, at a time, s."""
    axis = np.empty(3)
    along, distance = _offset(law, phase, state, time, axis)
    if phase == RENDEZVOUS and not in_cone(state, axis, law.tangents[phase]):
        return False
    if law.switches[phase] == DISTANCE:
        return distance <= law.switch_distances[phase]
    return along <= law.switch_distances[phase]


@compiled
def port_distance(law, state, time):
    """Distance of a state (6,) from the docking port, m."""
    return _offset(law, DOCKING, state, time, np.empty(3))[1]
