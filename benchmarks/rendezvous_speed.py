"""The rendezvous study's closed loop against a plain Python loop around OSQP, in one run.

The plain loop, which is that of the tests, simulates the V-bar manoeuvre of the configured law; the
compiled loop simulates many from random starts, in linear motion, in the full field with impulses
and drag, with the document's disturbances, and with burns and a filter besides, against a goal.
Processor seconds, since the machine may do other things too.

The loop's time is the solver's: of the microseconds a program, nine tenths are its iterations and
one tenth is the field. Manoeuvres a second therefore go with the programs that one takes, and
unfiltered noise, with which the chaser bounces before the port, takes two to three times as many.
"""

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from smallsat.config import default_config
from smallsat.statistics.random_streams import stream
from smallsat.studies.rendezvous.methods import qp_solvers
from smallsat.studies.rendezvous.monte_carlo.initial_states import (
    IN_PLANE,
    Distribution,
    initial_states,
)
from smallsat.studies.rendezvous.parameters import law, start_state
from smallsat.studies.rendezvous.simulation.closed_loop import Manoeuvres, simulate
from smallsat.studies.rendezvous.simulation.disturbances import disturbed_motion

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests/rendezvous"))

import reference_loop  # noqa: E402

MANOEUVRES = 200
NOISY = 40
# Manoeuvres a second on one core with the field of degree and order 8, burns, noise and filter.
GOAL = 60.0
DOUBLINGS = (125, 250, 500)
SEED = 1
REPETITIONS = 20
OSQP_TOLERANCE = 1e-4


def measure() -> dict[str, float]:
    """Manoeuvres a second of both loops, microseconds a program, and their ratios."""
    section = default_config(ROOT).rendezvous
    given = law(section)
    states = initial_states(
        max(DOUBLINGS), SEED, Distribution(150.0, 2500.0, 0.5, IN_PLANE), given.mean_motion
    )

    def linear(count: int) -> Manoeuvres:
        return simulate([given], states[:count])

    def disturbed(noise: bool, filtered_burns: bool = False) -> Callable[[int], Manoeuvres]:
        motion = disturbed_motion(
            section,
            given,
            thrust_error=noise,
            measurement_error=noise,
            filtered=filtered_burns,
            burns=filtered_burns,
        )
        streams = [stream(SEED, sample) for sample in range(MANOEUVRES)]
        return lambda count: simulate(
            [given], states[:count], motion=motion, generators=streams[:count]
        )

    found = {}
    for name, run in (
        ("linear", linear),
        ("field_8x8", disturbed(False)),
        ("disturbed_8x8", disturbed(True)),
        ("burns_noise_filter_8x8", disturbed(True, filtered_burns=True)),
    ):
        run(1)  # compiles
        count = NOISY if name == "disturbed_8x8" else MANOEUVRES
        seconds, flown = _timed(run, count)
        found[f"{name}_manoeuvres_per_s"] = count / seconds
        found[f"{name}_programs_per_manoeuvre"] = flown.steps.sum() / count
        found[f"{name}_us_per_program"] = 1e6 * seconds / flown.steps.sum()
    found["share_of_goal"] = found["burns_noise_filter_8x8_manoeuvres_per_s"] / GOAL
    for count in DOUBLINGS:
        seconds, flown = _timed(linear, count)
        found[f"linear_{count}_us_per_program"] = 1e6 * seconds / flown.steps.sum()

    solving = 0.0

    def solve(program: qp_solvers.SparseProgram) -> qp_solvers.Answer:
        nonlocal solving
        answer = qp_solvers.osqp(program, OSQP_TOLERANCE)
        solving += answer.seconds
        return answer

    begin = time.process_time()
    reference_loop.simulate(given, start_state(section), solve)
    plain = time.process_time() - begin
    own, _ = _timed(
        lambda count: simulate([given], np.tile(start_state(section), (count, 1))), REPETITIONS
    )
    return found | {
        "plain_osqp_manoeuvres_per_s": 1.0 / plain,
        "plain_osqp_solving_share": solving / plain,
        "ratio": REPETITIONS * plain / own,
        "ratio_to_osqp_solving_alone": REPETITIONS * solving / own,
    }


def _timed(run: Callable[[int], Manoeuvres], count: int) -> tuple[float, Manoeuvres]:
    begin = time.process_time()
    flown = run(count)
    return time.process_time() - begin, flown


if __name__ == "__main__":
    for key, value in measure().items():
        print(f"{key}: {value:.4g}")
