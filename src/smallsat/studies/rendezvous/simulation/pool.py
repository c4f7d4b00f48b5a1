"""Manoeuvres in flight side by side, so that programs of one shape fill the solver's lanes."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from smallsat.dynamics.lanes import LANES

# What a slot waits for, if not for the program of a shape, which has a number from 0 on: for
# nothing, for a manoeuvre to begin, for the next one, for more normal numbers.
IDLE, BEGINS, ENDED, DRY = -1, -2, -3, -4
# Normal numbers that a slot holds; most manoeuvres need no second helping.
NUMBERS = 1024


class Pool(NamedTuple):
    """State of S manoeuvres, each in a slot; what a program is to be solved for comes next.

    Attributes
    ----------
    waits, turn
        What each slot waits for, (S,): the number of a shape, or `IDLE` to `DRY`; the slot that is
        looked at first, (1,).
    manoeuvre, law, phase, step
        Numbers, (S,).
    time, spent
        s, and delta-v so far, m/s, (S,).
    pairs
        See `smallsat.studies.rendezvous.simulation.motion`, (S, 2, 6).
    estimates, covariances, expected, nominals
        Relative states that the law is told, with covariance; the same when the control acts; and
        that of a tube's centre, (S, 6), m and m/s. Covariances are (S, 6, 6).
    within, outside
        Whether a tube is around the manoeuvre; whether the program's start violates a row, (S,).
    errors
        The thrust's amplitude error (w, v), (S, 2).
    plans, remaining
        See `smallsat.studies.rendezvous.guidance.controller.Memory`, (S, N, 3) and (S, 1).
    numbers, drawn
        Normal numbers of each slot's stream, (S, K), and how many are used, (S, 1).
    """

    waits: np.ndarray
    turn: np.ndarray
    manoeuvre: np.ndarray
    law: np.ndarray
    phase: np.ndarray
    step: np.ndarray
    time: np.ndarray
    spent: np.ndarray
    pairs: np.ndarray
    estimates: np.ndarray
    covariances: np.ndarray
    expected: np.ndarray
    nominals: np.ndarray
    within: np.ndarray
    outside: np.ndarray
    errors: np.ndarray
    plans: np.ndarray
    remaining: np.ndarray
    numbers: np.ndarray
    drawn: np.ndarray


def pool_for(count: int, shapes: int, stages: int, random: bool) -> Pool:
    """Return an idle pool for so many manoeuvres, shapes of programs and stages of a horizon.

    With one slot more than can wait in lanes that are not full, some lanes are always full until
    the last manoeuvres.
    """
    slots = min(count, (LANES - 1) * shapes + 1)

    def number(*shape: int) -> np.ndarray:
        return np.zeros((slots, *shape), np.int64)

    def value(*shape: int) -> np.ndarray:
        return np.zeros((slots, *shape))

    return Pool(
        waits=np.full(slots, IDLE),
        turn=np.zeros(1, np.int64),
        manoeuvre=number(),
        law=number(),
        phase=number(),
        step=number(),
        time=value(),
        spent=value(),
        pairs=value(2, 6),
        estimates=value(6),
        covariances=value(6, 6),
        expected=value(6),
        nominals=value(6),
        within=np.zeros(slots, bool),
        outside=np.zeros(slots, bool),
        errors=value(2),
        plans=value(stages, 3),
        remaining=number(1),
        numbers=value(NUMBERS if random else 0),
        drawn=np.full((slots, 1), NUMBERS if random else 0),
    )


def serve(pool: Pool, begun: int, count: int, laws: int, generators: Sequence | None) -> int:
    """Give idle slots the next manoeuvres and dry ones numbers; return how many have begun.

    Parameters
    ----------
    begun, count
        How many manoeuvres have begun, and are to be flown.
    laws
        Number of laws, which are taken in turn.
    generators
        Random stream of each manoeuvre, if any.
    """
    for slot in range(len(pool.waits)):
        if pool.waits[slot] in (IDLE, ENDED):
            if begun == count:
                pool.waits[slot] = IDLE
                continue
            pool.manoeuvre[slot], pool.law[slot] = begun, begun % laws
            pool.waits[slot], pool.drawn[slot] = BEGINS, pool.numbers.shape[1]
            begun += 1
        if generators is not None and pool.waits[slot] in (BEGINS, DRY):
            used = pool.drawn[slot, 0]
            rest = pool.numbers[slot, used:].copy()
            pool.numbers[slot, : len(rest)] = rest
            stream = generators[pool.manoeuvre[slot]]
            pool.numbers[slot, len(rest) :] = stream.standard_normal(used)
            pool.drawn[slot] = 0
    return begun
