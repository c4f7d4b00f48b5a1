"""The configuration's ``transfer`` section, in canonical units."""

from typing import Annotated

from annotated_types import Interval

from smallsat.quantities import (
    Integer,
    NonNegative,
    Number,
    Part,
    Positive,
    Range,
    Seed,
    Several,
)

StepCount = Annotated[Integer, Interval(ge=16, le=4096)]


class Problem(Part):
    mu: Positive
    thrust: Positive
    exhaust_speed: Positive
    initial_radius: Positive
    final_radius: Positive
    initial_mass: Positive


class Costate(Part):
    lambda_r: Number
    lambda_theta: Number
    lambda_vr: Number
    lambda_vtheta: Number
    lambda_m: Number


class Guess(Part):
    """Where the methods start; the interior state is every one at every interval's end."""

    initial_costate: Costate
    indirect_final_time: Positive
    interior_state: Number
    direct_final_time: Positive
    coefficient: Number


class Bounds(Part):
    coefficient: Range[Number]
    interior_state: Range[Number]
    final_time_single: Range[NonNegative]
    final_time_multiple: Range[NonNegative]


class Steps(Part):
    """Fixed steps of order 8 over the whole flight."""

    indirect: StepCount
    as_published: StepCount
    converged: StepCount


class Stop(Part):
    """Where ``fmincon`` stops: its first-order optimality and its constraint error."""

    optimality_single: Positive
    optimality_multiple: Positive
    feasibility: Positive


class Numerics(Part):
    """The tolerance of the as-published runs is SLSQP's ftol, ``multistart`` is starts a degree.

    ``basin`` is starts a method and distance from the optimum.
    """

    steps: Steps
    stop: Stop
    as_published_tolerance: Positive
    tighter_bounds: Several[Positive]
    thrust_shares: Several[Positive]
    multistart: Annotated[Integer, Interval(ge=1, le=10000)]
    basin: Annotated[Integer, Interval(ge=1, le=10000)]
    seed: Seed


class Configuration(Part):
    """The whole section: degrees of the control's polynomial, intervals of multiple shooting."""

    problem: Problem
    degrees: Several[Annotated[Integer, Interval(ge=1, le=12)]]
    intervals: Several[Annotated[Integer, Interval(ge=2, le=64)]]
    guess: Guess
    bounds: Bounds
    numerics: Numerics
