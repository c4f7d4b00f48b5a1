"""Indirect shooting where the flight is long: which guesses lead to the optimum, by intervals.

The document expects single shooting to fail on long flights, and multiple shooting not to. Less
thrust makes the flight longer, and nothing else is changed.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.methods.continuation import ContinuationError, minimum_time
from smallsat.studies.transfer.methods.extremals import SAME_TIME, enough_steps
from smallsat.studies.transfer.methods.indirect import (
    ConvergenceError,
    equal_steps,
    published_start,
    solve_extremal,
)
from smallsat.studies.transfer.model.problem import TransferProblem
from smallsat.studies.transfer.model.units import canonical, units_of

COLUMNS = ["share", "intervals", "optimum", "guess", "final_time", "status"]
# The guessed flight time grows as the thrust falls, with these powers: not at all, as at one
# acceleration over one distance, and as at one change of velocity.
POWERS = (0.0, 0.5, 1.0)
# Guesses longer than so many optimal flights get no more steps than one as long.
LONGEST_GUESS = 2.0


def long_flights(section: Configuration, intervals: int) -> pd.DataFrame:
    """Shoot from the document's guess at shares of its thrust, with guesses of the flight time.

    Returns
    -------
    DataFrame
        One row a share of the thrust and a guess: share, intervals, optimum (final time of the
        continuation's extremal), guess and final_time in the configuration's unit of time, the
        latter not a number where shooting did not end at the optimum, and status.
    """
    configured = TransferProblem.of(section.problem)
    units = units_of(configured)
    rows = []
    for share in section.numerics.thrust_shares:
        problem = canonical(replace(configured, thrust=share * configured.thrust))
        try:
            optimum = minimum_time(problem).final_time
        except ContinuationError:
            # Without a flight to compare with nothing can be said.
            continue
        for power in POWERS:
            start = published_start(intervals, section.guess, units)
            start[-1] *= share**-power
            guess = float(start[-1])
            length = np.clip(guess, optimum, LONGEST_GUESS * optimum)
            steps = enough_steps(section.numerics.steps.indirect, problem, float(length))
            try:
                found = solve_extremal(problem, intervals, start, equal_steps(intervals, steps))
                slower = found.final_time > optimum * (1 + SAME_TIME)
                final_time = np.nan if slower else found.final_time
                status = f"ends at t_f = {found.final_time * units.time:.6f}"
            except ConvergenceError as failure:
                final_time, status = np.nan, str(failure)
            times = [time * units.time for time in (optimum, guess, final_time)]
            rows.append((share, intervals, *times, status))
    return pd.DataFrame(rows, columns=COLUMNS)


def joined_flights(parts: Sequence[pd.DataFrame]) -> pd.DataFrame:
    """Tables of `long_flights` in one, the optimum the shortest flight that any of them knows.

    Two extremals may be so near to each other that the continuation follows the slower one.
    """
    table = pd.concat(parts, ignore_index=True)
    shortest = table[["optimum", "final_time"]].min(axis=1)
    table["optimum"] = shortest.groupby(table["share"]).transform("min")
    return table
