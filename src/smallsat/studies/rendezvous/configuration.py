"""The configuration's ``rendezvous`` section."""

from typing import Annotated, Literal

from annotated_types import Ge, Gt, Interval, Le, Len, Lt
from pydantic import StrictBool

from smallsat.quantities import (
    Count,
    Fraction,
    Growing,
    Inclination,
    Integer,
    NonNegative,
    Number,
    Part,
    Positive,
    Range,
    Seed,
    Several,
    Vector,
)

Horizon = Annotated[Integer, Interval(ge=1, le=120)]
Generations = Annotated[Integer, Interval(ge=0, le=1000)]
Degree = Annotated[Integer, Interval(ge=0, le=8)]
Runs = Annotated[Integer, Interval(ge=2, le=100000)]
Angle = Literal["half", "full"]


class Spacecraft(Part):
    mass_kg: Positive
    size_units: Count
    thruster_N: Positive
    thrusters: Count


class Start(Part):
    """The chaser's state relative to the target (Table 3.2)."""

    position_m: Vector
    velocity_m_s: Vector


class Phase(Part):
    """A phase of the guidance (Table 3.1); the bound is a change of velocity per step."""

    sample_time_s: Annotated[Number, Ge(0.1)]
    horizon: Horizon
    state_weights: Annotated[tuple[NonNegative, ...], Len(6, 6)]
    control_weight: Positive
    penalty: NonNegative
    cone_angle_deg: Annotated[Number, Gt(0), Lt(90)]
    control_bound_m_s: Positive


class Phases(Part):
    far: Phase
    mid: Phase
    final: Phase


class LinearProgram(Part):
    """Whether it has the set point too, factor of Q, R, factor of Q at the end."""

    set_point: StrictBool
    state_weight: Positive
    control_weight: Positive
    terminal_weight: NonNegative


class Readings(Part):
    """How the document is read where it can be read in several ways."""

    r_bar: Literal["above", "below"]
    approach_cone: Angle
    docking_cone: Angle
    planes: Literal["great circle", "upright"]
    switches: Literal["distance", "along axis"]
    actuation: Literal["impulses", "burns"]
    set_point_time: Literal["start", "horizon", "stage"]
    reference_moves: StrictBool
    delta_v: Literal["2-norm", "1-norm", "resultant", "plane and normal"]


class Inferred(Part):
    """What the document never prints; distances with a name of their own are r1, r2 and r3.

    The set points and the switches are in shares of r1 and r2, and the terminal weight is Qf as a
    multiple of Q; 0 is the Riccati solution.
    """

    mean_motion_rad_s: Positive
    keep_out_m: Positive
    set_point_1: Positive
    switch_1: Positive
    overshoot_m: Positive
    set_point_2: Positive
    switch_2: Positive
    end_distance_m: Positive
    speed_bound_m_s: Positive
    rotation_rate_rad_s: Number
    terminal_weight: NonNegative
    lp: LinearProgram
    readings: Readings


class Bounds(Part):
    """Of the fitted values, in the order in which the search draws them."""

    end_distance_m: Range[Number]
    keep_out_m: Range[Number]
    mean_motion_rad_s: Range[Number]
    overshoot_m: Range[Number]
    rotation_rate_rad_s: Range[Number]
    set_point_1: Range[Number]
    set_point_2: Range[Number]
    speed_bound_m_s: Range[Number]
    switch_1: Range[Number]
    switch_2: Range[Number]


class Ensemble(Part):
    """Acceptable sets that claims are judged over, and how much is flown with each."""

    sets: Annotated[Integer, Interval(ge=1, le=100)]
    samples: Annotated[Integer, Interval(ge=10, le=100000)]
    states: Annotated[Integer, Interval(ge=2, le=100000)]
    runs: Runs
    agree: Annotated[Number, Gt(0.5), Le(1)]


class Posterior(Part):
    """The walk over the fitted numbers: how many walkers, and how many steps each."""

    walkers: Annotated[Integer, Interval(ge=20, le=1000)]
    steps: Annotated[Integer, Interval(ge=1, le=100000)]


class AxesSearch(Part):
    """The search for sets within the printed axes: rounds, each of so many sets and generations.

    It begins with so many initial states; each round may take on more.
    """

    seed: Seed
    rounds: Count
    population: Annotated[Integer, Interval(ge=8, le=1000)]
    generations: Generations
    starts: Count


class Inference(Part):
    """The search for what is not printed: its size, the errors it assumes, what it accepts."""

    seed: Seed
    population: Annotated[Integer, Interval(ge=8, le=1000)]
    generations: Generations
    starts: Count
    axes_below: Positive
    step_error: Positive
    delta_v_share: Positive
    delta_v_error_m_s: Positive
    time_share: Positive
    infeasible_share: Positive
    on_boundary: Positive
    just_behind: Positive
    axis_error: Positive
    acceptable: Annotated[Number, Interval(ge=1)]
    posterior: Posterior
    axes_search: AxesSearch
    ensemble: Ensemble
    bounds: Bounds


class DragCoefficient(Part):
    target: NonNegative
    chaser: NonNegative


class BodySize(Part):
    """By the axes of the Hill frame."""

    radial: Positive
    along: Positive
    normal: Positive


class Truth(Part):
    """The nonlinear motion; a density factor of 0 is no drag."""

    gravity_degree: Degree
    gravity_order: Degree
    density_factor: NonNegative
    drag_coefficient: DragCoefficient
    body_size_m: BodySize
    inclination_deg: Inclination
    raan_deg: Number
    argument_of_latitude_deg: Number
    earth_angle_deg: Number
    step_s: Annotated[Number, Ge(0.1)]


class Solvers(Part):
    """The comparison of solvers, on so many programs of each kind."""

    manoeuvres: Annotated[Integer, Interval(ge=1, le=500)]
    programs: Annotated[Integer, Interval(ge=1, le=10000)]


class Elliptic(Part):
    """Predictions near elliptic orbits, from initial states at so many places of each."""

    eccentricities: Growing[Fraction]
    states: Annotated[Integer, Interval(ge=1, le=1000)]
    anomalies: Annotated[Integer, Interval(ge=1, le=360)]
    look_ahead_s: Growing[Positive]


class Sweep(Part):
    horizons: Growing[Horizon]
    sample_times_s: Annotated[Growing[Positive], Len(2)]


class Weights(Part):
    """Factors of R, beyond the document."""

    factors: Several[Positive]


class Delay(Part):
    """From the state to its control."""

    delays_s: Several[Positive]


class Prediction(Part):
    inclinations_deg: Several[Inclination]


class Ablations(Part):
    """Parts of the algorithm left out or changed, beyond the document."""

    plane_rates: Growing[Positive]
    corridor_deg: Annotated[Number, Gt(0), Lt(90)]


class ImpulseBits(Part):
    """Minimum impulse bits of the thrusters, and how many initial states are flown with each."""

    bits_mN_s: Growing[NonNegative]
    states: Count


class Rotation(Part):
    """Rates of the target's rotation, and how many initial states are flown with each."""

    rates_rad_s: Growing[NonNegative]
    states: Count


class Orbits(Part):
    """Elliptic orbits of the target, where on them manoeuvres begin, and from how many states."""

    eccentricities: Growing[Fraction]
    anomalies_deg: Several[Number]
    states: Count


class ThrustError(Part):
    """Table 5.1; of the reading see `smallsat.studies.rendezvous.model.actuation_noise`."""

    tau_s: Positive
    omega_n_rad_s: Positive
    xi: Positive
    eta_w: Positive
    eta_v: Positive
    reading: Literal[
        "deviation-deviation", "deviation-density", "density-deviation", "density-density"
    ]


class Filter(Part):
    """Of Kalman: what it takes its own model to miss."""

    gradient_error: NonNegative
    other_acceleration_m_s2: NonNegative


class Tube(Part):
    """Of robust MPC: its width in standard deviations, and the most that it may take.

    The share is that of the docking distance, and of the bounds on speed and control.
    """

    deviations: Positive
    share: Annotated[Number, Gt(0), Lt(1)]


class Robustness(Part):
    """Chapter 5; ``variant_runs`` are of what goes beyond the document.

    That is the filter, the tube, and ``near_error_shares``, deviations near the port as shares of
    the others.
    """

    seed: Seed
    states: Annotated[Integer, Interval(ge=1, le=100000)]
    runs: Runs
    variant_runs: Runs
    position_deviation_m: NonNegative
    velocity_deviation_m_s: NonNegative
    minimum_on_time_s: NonNegative
    thrust_error: ThrustError
    filter: Filter
    near_error_shares: Several[Fraction]
    tube: Tube


class Passages(Part):
    """Docking distances r3 and time limits."""

    runs: Runs
    distances_m: Growing[Positive]
    limits_min: Growing[Positive]


class Bootstrap(Part):
    """How the intervals of the studies' effects are drawn."""

    resamples: Annotated[Integer, Interval(ge=100, le=100000)]
    confidence: Annotated[Number, Gt(0), Lt(1)]
    seed: Seed


class Flown(Part):
    """What the manoeuvres of chapters 4 and 5 depend on; the share is of the initial states."""

    seed: Seed
    samples: Annotated[Integer, Interval(ge=1, le=1000000)]
    share: Annotated[Number, Gt(0), Le(1)]
    distance_km: Range[Positive]
    velocity_deviation_m_s: NonNegative
    time_limit_min: Annotated[Number, Gt(0), Le(10000)]
    rendezvous: Sweep
    approach: Sweep
    docking: Sweep
    weights: Weights
    delay: Delay
    prediction: Prediction
    ablations: Ablations
    impulse_bits: ImpulseBits
    rotation: Rotation
    orbits: Orbits
    robustness: Robustness
    passages: Passages


class Studies(Flown):
    """Chapters 4 and 5, appendix A; results are the same for any number of shards."""

    shards: Annotated[Integer, Interval(ge=1, le=100)]
    bootstrap: Bootstrap


class Benchmark(Part):
    """Horizons of a phase, at its own sample time, and sample times, at its own horizon."""

    horizons: Growing[Horizon]
    sample_times_s: Growing[Positive]


class FlightComputer(Part):
    """Chapter 6: runs of each case, and how many steps of each are replayed.

    ``clock_MHz`` and ``miss_cycles``, of a first-level cache, turn counts into time; ``bin_ms`` is
    the width of Figure 6.3's bins.
    """

    clock_MHz: Positive
    miss_cycles: Range[Positive]
    bin_ms: Positive
    runs: Annotated[Integer, Interval(ge=1, le=100000)]
    steps: Annotated[Integer, Interval(ge=1, le=10000)]
    far: Benchmark
    mid: Benchmark
    final: Benchmark


class Flight(Part):
    """What every manoeuvre depends on."""

    spacecraft: Spacecraft
    start: Start
    port_m: Vector
    phases: Phases
    plane_rate: Positive
    inferred: Inferred
    truth: Truth


class Cases(Flight):
    """What the cases of chapter 3 and the inference depend on."""

    cone_faces: Annotated[Integer, Interval(ge=4, le=4)]
    target_eccentricity: Annotated[Number, Interval(ge=0, le=0)]
    inference: Inference


class MonteCarlo(Flight):
    """What the manoeuvres of chapters 4 and 5 depend on."""

    studies: Flown


class Configuration(Cases, MonteCarlo):
    solvers: Solvers
    elliptic: Elliptic
    studies: Studies
    flight_computer: FlightComputer
