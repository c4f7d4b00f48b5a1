"""The checks of the configuration that no type can make."""

import numpy as np

from smallsat.errors import InputError
from smallsat.studies.transfer.configuration import Bounds, Configuration, Guess
from smallsat.studies.transfer.model.problem import TransferProblem
from smallsat.studies.transfer.model.units import canonical

# Widths of the tube in which `_may_arrive` looks for a bound, as shares of the largest one.
TUBES = np.linspace(0.001, 0.999, 999)


def check(section: Configuration) -> None:
    """Refuse a transfer that no solution can have, and guesses out of their bounds.

    Raises
    ------
    InputError
        Naming the key, its value, what is allowed and what to do.
    """
    _check_guess(section.guess, section.bounds)
    problem = TransferProblem.of(section.problem)
    if problem.final_radius == problem.initial_radius:
        raise InputError(
            f"config key 'transfer.problem.final_radius': {problem.final_radius} is the initial "
            "radius, so there is nothing to transfer; give another radius"
        )
    if not _may_arrive(problem):
        raise InputError(
            f"config key 'transfer.problem.thrust': {problem.thrust} uses up the initial mass "
            f"{problem.initial_mass} in {problem.longest_time:.4g} time units, too soon to reach "
            f"the final radius {problem.final_radius}; give less thrust, a higher exhaust_speed or "
            "a nearer final_radius"
        )


def _may_arrive(problem: TransferProblem) -> bool:
    """Whether the time until all mass is spent may suffice to leave the initial orbit far enough.

    Let d be the distance from where the spacecraft would be had it only coasted. As long as d stays
    below some D, gravity differs from that of the coasting body by L d at most, with
    L = 2 mu / (r_0 - D)^3, the largest gravity gradient in the tube of radius D about the initial
    orbit. By Groenwall's inequality d then stays below cosh(sqrt(L) t_max) times the integral of
    the velocity gained, which the rocket equation gives as v_e t_max when all mass is spent at
    t_max. Where this is below D, the tube is never left, and the final orbit lies outside it.
    """
    one = canonical(problem)
    distance = abs(one.final_radius - 1.0)
    tubes = TUBES * min(distance, 1.0)
    gradient = 2.0 / (1.0 - tubes) ** 3
    with np.errstate(over="ignore"):
        strayed = np.cosh(np.sqrt(gradient) * one.longest_time) * one.exhaust_speed
        return bool(np.all(strayed * one.longest_time >= tubes))


def _check_guess(guess: Guess, bounds: Bounds) -> None:
    for name, interval in (
        ("interior_state", "interior_state"),
        ("coefficient", "coefficient"),
        ("direct_final_time", "final_time_single"),
        ("direct_final_time", "final_time_multiple"),
    ):
        low, high = bounds[interval]
        if not low <= guess[name] <= high:
            raise InputError(
                f"config key 'transfer.guess.{name}': {guess[name]} lies outside "
                f"transfer.bounds.{interval}, {[low, high]}; change one of them"
            )
