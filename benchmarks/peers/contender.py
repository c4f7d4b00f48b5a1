"""What a benchmark compares: one problem, and those who solve it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

# Prepares everything that is done once, and returns what solves the problem.
Prepare = Callable[[], Callable[[], Any]]


@dataclass(frozen=True)
class Contender:
    """One who solves a problem.

    Attributes
    ----------
    name
        What solves it, by which method.
    package
        The distribution whose version the table shows.
    prepare
        Does what is done once (import, transcription, compilation) and returns the solution, which
        may be called again and again and begins anew each time.
    """

    name: str
    package: str
    prepare: Prepare


@dataclass(frozen=True)
class Problem:
    """A problem and its contenders, ours first.

    Attributes
    ----------
    name
        The study and what is solved.
    measure
        What the error is, in words.
    required
        Largest error of what counts as solved to the same accuracy.
    error
        The error of what a contender returned, as ``measure`` says.
    contenders
        Ours, then the peers.
    repetitions
        How often each solves it.
    """

    name: str
    measure: str
    required: float
    error: Callable[[Any], float]
    contenders: Sequence[Contender]
    repetitions: int
