"""A leg solved by whatever it takes, and what was tried where nothing helps.

The program's smooth arcs are enough for the document's courses. Where they are not, other arcs are
tried, and then a continuation: the tide of the orbit is what makes a slow race hard, so the same
leg is solved in a slower orbit first, and from its plan in ever faster ones.
"""

from dataclasses import replace

from smallsat.evidence.not_converged import NotConverged
from smallsat.studies.racing.methods.course_program import Arcs, CourseProgram, Leg, Plan
from smallsat.studies.racing.methods.flight import propagate_plan, residual
from smallsat.studies.racing.model.cubesat import CubeSat

SMOOTH = "smooth arcs"
OTHER_ARCS = {"slow arcs": Arcs(0.3, 3.5), "fast arcs": Arcs(0.9, 1.8)}
# Shares of the mean motion: where the continuation begins, and its largest and least step.
FIRST_SHARE, LARGEST_STEP, LEAST_STEP = 1.0 / 16.0, 0.5, 1.0 / 64.0


def solve(
    program: CourseProgram,
    leg: Leg,
    cubesat: CubeSat,
    mean_motion: float,
    neighbour: Plan | None = None,
) -> Plan:
    """The first plan that converges; if none does, the last one, with all that was tried.

    ``neighbour`` is the plan of a similar case, tried before the continuation.
    """
    plan, tried = program.solve(leg, cubesat, mean_motion), [SMOOTH]
    for name, arcs in OTHER_ARCS.items():
        if plan.converged:
            break
        plan = program.solve(leg, cubesat, mean_motion, arcs=arcs)
        tried.append(name)
    if neighbour and not plan.converged:
        plan = program.solve(leg, cubesat, mean_motion, guess=neighbour)
        tried.append("a similar case")
    if not plan.converged:
        plan, share = _continued(program, leg, cubesat, mean_motion)
        tried.append(f"continuation in the mean motion, which reached {100.0 * share:.0f} % of it")
    return replace(plan, tried=tuple(tried))


def _continued(
    program: CourseProgram, leg: Leg, cubesat: CubeSat, mean_motion: float
) -> tuple[Plan, float]:
    """The plan at the largest share of the mean motion that was tried, and the share solved."""
    share, step = FIRST_SHARE, LARGEST_STEP
    plan = trial = program.solve(leg, cubesat, share * mean_motion)
    if not plan.converged:
        return plan, 0.0
    while share < 1.0 and step >= LEAST_STEP:
        following = min(share + step, 1.0)
        trial = program.solve(leg, cubesat, following * mean_motion, guess=plan)
        if trial.converged:
            plan, share = trial, following
        else:
            step /= 2.0
    return trial, share


def not_converged(case: str, plan: Plan, cubesat: CubeSat, mean_motion: float) -> NotConverged:
    """The row of a leg without a solution; the residual is that of its last plan when flown."""
    flown = propagate_plan(plan, mean_motion)
    return NotConverged(
        case,
        plan.solution.status,
        residual(plan, flown, cubesat, None),
        "; ".join(plan.tried),
    )
