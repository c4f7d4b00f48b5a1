"""All QP solvers on programs sampled from closed loops."""

from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.methods import solver_comparison
from smallsat.studies.rendezvous.monte_carlo.initial_states import distribution, initial_states
from smallsat.studies.rendezvous.parameters import law


def run(step: Step[Configuration]) -> Tables:
    """Compare them; seconds go to a file of their own."""
    section, size = step.section, step.section.solvers
    laws = {"QP": law(section), "1-norm": law(section, "lp")}
    seed, spread = section.studies.seed, distribution(section.studies)
    starts = initial_states(size.manoeuvres, seed, spread, laws["QP"].mean_motion)
    programs = solver_comparison.samples(laws, starts, size.programs)
    answers, seconds = solver_comparison.compare(programs)
    return {
        "solvers.csv": solver_comparison.summary(answers),
        "solver-seconds.csv": solver_comparison.seconds_summary(seconds),
    }
