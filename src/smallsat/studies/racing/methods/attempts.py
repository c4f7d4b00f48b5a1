"""A leg solved by whatever it takes, and what was tried where nothing helps.

The program's smooth arcs are enough for the document's courses. Where they are not, other arcs are
tried, and then a continuation: the tide of the orbit is what makes a slow race hard, so the same
leg is solved in the fastest of some slower orbits in which the arcs lead to a plan, and from that
plan in ever faster ones. Nothing of an earlier solve is used, so that the outcome is the same in
any order of the legs.
"""

from dataclasses import replace

from smallsat.evidence.not_converged import NotConverged
from smallsat.studies.racing.methods.course_program import Arcs, CourseProgram, Leg, Plan
from smallsat.studies.racing.methods.flight import propagate_plan, residual
from smallsat.studies.racing.model.cubesat import CubeSat

SMOOTH = "smooth arcs"
OTHER_ARCS = {"slow arcs": Arcs(0.3, 3.5), "fast arcs": Arcs(0.9, 1.8)}
# Shares of the mean motion: each that the arcs are tried with, of the one before, the least of
# them, and the least step of the continuation.
SLOWER, LEAST_SHARE, LEAST_STEP = 7.0 / 8.0, 1.0 / 16.0, 1.0 / 256.0


def solve(program: CourseProgram, leg: Leg, cubesat: CubeSat, mean_motion: float) -> Plan:
    """The first plan that converges; if none does, the last one, with all that was tried."""
    plan, tried = program.solve(leg, cubesat, mean_motion), [SMOOTH]
    for name, arcs in OTHER_ARCS.items():
        if plan.converged:
            break
        plan = program.solve(leg, cubesat, mean_motion, arcs=arcs)
        tried.append(name)
    if not plan.converged:
        plan, share = _continued(program, leg, cubesat, mean_motion)
        tried.append(f"continuation in the mean motion, which reached {100.0 * share:.0f} % of it")
    return replace(plan, tried=tuple(tried))


def _continued(
    program: CourseProgram, leg: Leg, cubesat: CubeSat, mean_motion: float
) -> tuple[Plan, float]:
    """The plan at the largest share of the mean motion that was tried, and the share solved."""
    share = 1.0
    while True:
        share *= SLOWER
        plan = trial = program.solve(leg, cubesat, share * mean_motion)
        if plan.converged:
            break
        if share < LEAST_SHARE:
            return plan, 0.0
    step = 1.0 - share
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
