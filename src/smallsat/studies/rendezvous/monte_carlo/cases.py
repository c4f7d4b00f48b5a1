"""The cases of chapters 4 and 5 and appendix A, and of what goes beyond them, by group.

A case is the baseline guidance law with some attributes changed, over some of the phases. A case
that does not begin with the first phase begins where the baseline ended the phase before.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from smallsat.dynamics.units import MINUTE
from smallsat.studies.rendezvous.configuration import MonteCarlo
from smallsat.studies.rendezvous.guidance.law import Law, in_phase
from smallsat.studies.rendezvous.model.environment import (
    central,
    elliptic_mean_motion,
    elliptic_target,
    orbit_radius,
)
from smallsat.studies.rendezvous.model.prediction_j2 import schweighart_sedwick
from smallsat.studies.rendezvous.monte_carlo.tubes import flown_tube, path_law
from smallsat.studies.rendezvous.parameters import STUDY_PHASES as PHASES
from smallsat.studies.rendezvous.parameters import law
from smallsat.studies.rendezvous.simulation.disturbances import disturbed_motion, nonlinear_motion
from smallsat.studies.rendezvous.simulation.motion import COMMANDED, NonlinearMotion

# Names that others look for.
BASELINE, NO_SET_POINT, LP = "baseline", "no set point", "LP"
AS_DOCUMENTED, UNDISTURBED = "as documented", "undisturbed"
PATH, TUBE = "nominal path and feedback", "tube"
NO_PENALTY, NO_ZONE, NO_REFERENCE = "no terminal penalty", "no zone", "no reference in approach"
NO_SET_POINT_NO_ZONE = "no set point, no zone"
LP_DISTURBED, LP_UNDISTURBED = "LP, disturbed", "LP, undisturbed"
CLOHESSY_WILTSHIRE, SCHWEIGHART_SEDWICK = "Clohessy-Wiltshire", "Schweighart-Sedwick"
YAMANAKA_ANKERSEN = "Yamanaka-Ankersen"


@dataclass(frozen=True)
class Case:
    """One case of a Monte Carlo study.

    Attributes
    ----------
    name
        Its name, unique within its group.
    law
        The guidance law.
    phases
        First and last phase, 0 to 2.
    motion
        What the law guides; ``None``: the linear motion that it predicts.
    runs
        How many manoeuvres begin at each initial state.
    states
        How many of the initial states, the first ones; ``None``: all.
    """

    name: str
    law: Law
    phases: tuple[int, int] = (0, 2)
    motion: NonlinearMotion | None = None
    runs: int = 1
    states: int | None = None


def sweep_case(horizon: int, sample_time: float) -> str:
    """Name of a sweep's case."""
    return f"N {horizon}, Ts {sample_time:g} s"


def weight_case(factor: float, phase: str) -> str:
    """Name of a case with another weight of the control in one phase."""
    return f"R times {factor:g}, {phase}"


def weighted_sweep_case(factor: float, sample_time: float) -> str:
    """Name of a case with another weight of the control and another sample time."""
    return f"R times {factor:g}, Ts {sample_time:g} s"


def delay_case(delay: float, known: bool) -> str:
    """Name of a case in which the control acts late."""
    return f"delay {delay:g} s, {'predicted' if known else 'not predicted'}"


def near_errors_case(share: float) -> str:
    """Name of a case whose measurement errors fall with the range, to a share near the port."""
    return f"errors {share:g} times as large near the port"


def near_errors_tube_case(share: float) -> str:
    """Name of that case with the tube that fits its errors."""
    return f"{TUBE}, {near_errors_case(share)}"


def prediction_case(model: str, inclination: float) -> str:
    """Name of a case with a prediction model, over an orbit's inclination in degrees."""
    return f"{model}, {inclination:g} deg"


def planes_case(rate: float) -> str:
    """Name of a case whose planes may turn at another rate, in mean motions."""
    return f"planes at {rate:g} n"


def corridor_case(sample_time: float) -> str:
    """Name of a docking without its corridor at a sample time."""
    return f"no corridor, Ts {sample_time:g} s"


def bit_case(thrust: str, treatment: str, bit: float) -> str:
    """Name of a case with a minimum impulse bit, mN s, by one of `THRUSTS` and `TREATMENTS`."""
    return f"{thrust}, bit {bit:g} mN s" + f", {treatment}" * (bit > 0.0)


def rotation_case(extent: str, rate: float) -> str:
    """Name of a case with a rotating target, rad/s, over one of `EXTENTS`."""
    return f"{extent}, {rate:g} rad/s"


def orbit_case(model: str, eccentricity: float, anomaly: float) -> str:
    """Name of a case with a prediction model, by the orbit and where it begins, deg."""
    return f"{model}, e {eccentricity:g}, from {anomaly:g} deg"


def base(section: MonteCarlo, case: str = "v-bar") -> Law:
    """The law of a case of chapter 3 with the time limit of the studies."""
    limit = MINUTE * section.studies.time_limit_min
    return law(section, case).with_(time_limit=limit)


def _sampled(law: Law, phase: int, sample_time: float) -> Law:
    return law.with_(sample_times=in_phase(law.sample_times, phase, float(sample_time)))


def _weighted(law: Law, phase: int, factor: float) -> Law:
    weights = np.array(law.control_weights, dtype=float)
    weights[phase] *= factor
    return law.with_(control_weights=weights)


def _domain(section: MonteCarlo) -> list[Case]:
    """Section 4.1 and the appendix: the whole manoeuvre, and two other far-range costs."""
    return [
        Case(BASELINE, base(section)),
        Case(NO_SET_POINT, base(section, "no-set-point")),
        Case(LP, base(section, "lp")),
    ]


def _sweep(phase: int) -> Callable[[MonteCarlo], list[Case]]:
    """Sections 4.2 to 4.4: horizons and sample times of one phase, that phase alone."""

    def make(section: MonteCarlo) -> list[Case]:
        law, sweep = base(section), section.studies[PHASES[phase]]
        return [
            Case(
                sweep_case(horizon, sample_time),
                _sampled(law, phase, sample_time).with_(
                    horizons=in_phase(law.horizons, phase, horizon)
                ),
                (phase, phase),
            )
            for horizon in sweep.horizons
            for sample_time in sweep.sample_times_s
        ]

    return make


def _weights(section: MonteCarlo) -> list[Case]:
    """Section 4.5: other weights of the control, and whether sample times then compare alike."""
    law, factors = base(section), section.studies.weights.factors
    times = section.studies.rendezvous.sample_times_s
    whole = [
        Case(weight_case(factor, name), _weighted(law, phase, factor))
        for phase, name in enumerate(PHASES)
        for factor in factors
    ]
    sampled = [
        Case(
            weighted_sweep_case(factor, sample_time),
            _sampled(_weighted(law, 0, factor), 0, sample_time),
            (0, 0),
        )
        for factor in (factors[0], factors[-1])
        for sample_time in (times[0], times[-1])
    ]
    return whole + sampled


def _delay(section: MonteCarlo) -> list[Case]:
    """Section 5.5: the control acts late, known to the prediction or not."""
    law = base(section)
    return [
        Case(delay_case(delay, known), law.with_(delay=float(delay), delay_known=known))
        for delay in section.studies.delay.delays_s
        for known in (False, True)
    ]


def _prediction(section: MonteCarlo) -> list[Case]:
    """Section 3.7: J2 in the prediction, over inclinations, in the field of degree 8."""
    law, found = base(section), list[Case]()
    n, radius = law.mean_motion, orbit_radius(law.mean_motion)
    for inclination in section.studies.prediction.inclinations_deg:
        tilted = section.with_(truth=section.truth.with_(inclination_deg=inclination))
        motion = disturbed_motion(tilted, law, thrust_error=False, measurement_error=False)
        matrix = schweighart_sedwick(n, float(np.radians(inclination)), radius)
        for model, prediction in ((CLOHESSY_WILTSHIRE, None), (SCHWEIGHART_SEDWICK, matrix)):
            name = prediction_case(model, inclination)
            found.append(Case(name, law.with_(prediction=prediction), motion=motion))
    return found


def _robustness(section: MonteCarlo) -> list[Case]:
    """Chapter 5, and with its disturbances one by one, with a filter, or with better sensors."""
    law, table = base(section), section.studies.robustness
    few = table.variant_runs
    variants: dict[str, tuple[int, dict[str, Any]]] = {
        UNDISTURBED: (1, {"thrust_error": False, "measurement_error": False}),
        AS_DOCUMENTED: (table.runs, {}),
        "thrust error alone": (few, {"measurement_error": False}),
        "measurement error alone": (few, {"thrust_error": False}),
        "Kalman filter": (few, {"filtered": True}),
        "burns in place of impulses": (few, {"burns": True}),
        **{
            near_errors_case(share): (few, {"near_error_share": share})
            for share in table.near_error_shares
        },
    }
    found = [
        Case(name, law, motion=disturbed_motion(section, law, **changes), runs=runs)
        for name, (runs, changes) in variants.items()
    ]
    best = min(table.near_error_shares)
    laws = {
        PATH: (path_law(section, law), 1.0),
        TUBE: (flown_tube(section, law, 1.0), 1.0),
        near_errors_tube_case(best): (flown_tube(section, law, best), best),
    }
    for name, (other, share) in laws.items():
        motion = disturbed_motion(section, law, near_error_share=share)
        found.append(Case(name, other, motion=motion, runs=few))
    return found


def _passages(section: MonteCarlo) -> list[Case]:
    """What the docking distance and the time limit decide: the closest and the longest of them."""
    settings = section.studies.passages
    law = base(section)
    farthest = law.with_(
        switch_distances=in_phase(law.switch_distances, 2, min(settings.distances_m)),
        time_limit=MINUTE * max(settings.limits_min),
    )
    motion = disturbed_motion(section, farthest)
    return [Case("passages", farthest, motion=motion, runs=settings.runs)]


def _ablations(section: MonteCarlo) -> list[Case]:
    """What the document says that a part of the algorithm is for, seen by leaving the part out.

    Sections 2.2.1 (LP), 3.1.2 (penalty), 3.1.3 (zone, faster planes), 3.2.1 (reference), 3.6.4 (set
    point against zone) and 4.4 (corridor).
    """
    law, settings = base(section), section.studies.ablations
    nowhere = -2000.0 * max(section.studies.distance_km)  # planes so far behind bind nothing
    first, *_, last = section.studies.docking.sample_times_s
    wide = law.with_(cone_angles=in_phase(law.cone_angles, 2, np.radians(settings.corridor_deg)))
    rendezvous = (0, 0)
    found = [
        Case(NO_PENALTY, law.with_(penalties=in_phase(law.penalties, 0, 0.0)), rendezvous),
        Case(NO_ZONE, law.with_(keep_out=nowhere), rendezvous),
        Case(
            NO_SET_POINT_NO_ZONE,
            base(section, "no-set-point").with_(keep_out=nowhere),
            rendezvous,
        ),
        *(
            Case(planes_case(rate), law.with_(plane_rate=rate), rendezvous)
            for rate in settings.plane_rates
        ),
        Case(NO_REFERENCE, law.with_(set_points=(law.set_points[0], 0.0)), (1, 1)),
        *(Case(corridor_case(t), _sampled(wide, 2, t), (2, 2)) for t in (first, last)),
    ]
    linear = base(section, "lp")
    runs = section.studies.robustness.variant_runs
    for name, count, disturbed in ((LP_DISTURBED, runs, True), (LP_UNDISTURBED, 1, False)):
        motion = disturbed_motion(section, linear, disturbed, disturbed)
        found.append(Case(name, linear, rendezvous, motion, count))
    return found


# How thrust acts where bits are looked at: without disturbances, by impulses or by burns from each
# step's start, or by impulses with the disturbances of chapter 5.
THRUSTS: dict[str, dict[str, bool]] = {
    "impulses": {"thrust_error": False, "measurement_error": False},
    "burns": {"thrust_error": False, "measurement_error": False, "burns": True},
    "disturbed": {},
}
# From which part of the bit on a smaller impulse is raised to it; what is less is not flown.
TREATMENTS = {"left out": 1.0, "rounded": 0.5}


def _impulse_bits(section: MonteCarlo) -> list[Case]:
    """Thrusters that are on or off, for a least time, which Eq. 2.6 names and does not print."""
    law, settings, found = base(section), section.studies.impulse_bits, dict[str, Case]()
    for thrust, changes in THRUSTS.items():
        motion = disturbed_motion(section, law, **changes)
        for bit in settings.bits_mN_s:
            on_time = 1e-3 * bit / motion.force
            for treatment, share in TREATMENTS.items():
                name = bit_case(thrust, treatment, bit)
                own = motion._replace(minimum_on_time=on_time, flown_from=share * on_time)
                found[name] = Case(name, law, motion=own, states=settings.states)
    return list(found.values())


# Phases that are flown with a rotating target: all, or the last one from where the baseline, whose
# target rests, ended the one before.
EXTENTS = {"all phases": (0, 2), "docking alone": (2, 2)}


def rotation_rates(section: MonteCarlo) -> list[float]:
    """Rates of the target's rotation that are flown, rad/s: the configured sweep and Case 3's."""
    own = abs(section.inferred.rotation_rate_rad_s)
    return sorted({*section.studies.rotation.rates_rad_s, own})


def _rotation(section: MonteCarlo) -> list[Case]:
    """Case 3 of chapter 3 with other rates, the way that the configured one turns."""
    law, states = base(section, "rotating"), section.studies.rotation.states
    way = -1.0 if law.rotation_rate < 0.0 else 1.0
    return [
        Case(
            rotation_case(extent, rate),
            law.with_(rotation_rate=way * rate),
            phases,
            states=states,
        )
        for extent, phases in EXTENTS.items()
        for rate in rotation_rates(section)
    ]


def _orbits(section: MonteCarlo) -> list[Case]:
    """Section 2.1.1: a target on an ellipse in the central field, and what the law predicts by."""
    settings, circular, found = section.studies.orbits, base(section), list[Case]()
    around = section.with_(truth=central(section.truth))
    for e in settings.eccentricities:
        law = circular.with_(mean_motion=elliptic_mean_motion(circular.mean_motion, e))
        for anomaly in settings.anomalies_deg:
            begun = float(np.radians(anomaly))
            target = elliptic_target(section.truth, circular.mean_motion, e, begun)
            motion = nonlinear_motion(around, circular, COMMANDED)._replace(target=target)
            elliptic = law.with_(eccentricity=e, true_anomaly=begun)
            for model, own in ((CLOHESSY_WILTSHIRE, law), (YAMANAKA_ANKERSEN, elliptic)):
                name = orbit_case(model, e, anomaly)
                found.append(Case(name, own, motion=motion, states=settings.states))
    return found


# Each group is one table of results, made in shards.
GROUPS: dict[str, Callable[[MonteCarlo], list[Case]]] = {
    "domain": _domain,
    "rendezvous-sweep": _sweep(0),
    "approach-sweep": _sweep(1),
    "docking-sweep": _sweep(2),
    "weights": _weights,
    "delay": _delay,
    "prediction": _prediction,
    "robustness": _robustness,
    "passages": _passages,
    "ablations": _ablations,
    "impulse-bits": _impulse_bits,
    "rotation": _rotation,
    "orbits": _orbits,
}


def cases(section: MonteCarlo, group: str) -> list[Case]:
    """The cases of a group, in the order of its results."""
    return GROUPS[group](section)
