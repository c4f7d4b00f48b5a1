"""Proofs of the errata: each recomputes a quantity as printed and as corrected, and can fail."""

import numpy as np

from smallsat.dynamics.orbits.clohessy_wiltshire import rate_matrix
from smallsat.evidence.errata import Proof
from smallsat.evidence.grounds import Grounds
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.evidence.case_tables import CASE_TABLES
from smallsat.studies.rendezvous.guidance.law import DISTANCE, RENDEZVOUS
from smallsat.studies.rendezvous.inference.misfit import printed_steps
from smallsat.studies.rendezvous.model.geometry import cone_faces, rotated
from smallsat.studies.rendezvous.model.prediction import terminal_weight, transition
from smallsat.studies.rendezvous.parameters import law, start_state
from smallsat.studies.rendezvous.simulation.flights import STATE

ROUNDING = 1e-9


def control_bound_unit(grounds: Grounds[Configuration]) -> Proof:
    """Table 3.1: the bounds are impulses over mass; as accelerations they would end too soon."""
    section = grounds.section
    craft = section.spacecraft
    push = craft.thruster_N / craft.mass_kg
    bounds = [
        grounds.ledger.value(f"table-3-1/u-max/{phase}")
        for phase in ("far-range", "mid-range", "close-range")
    ]
    pulses = [bound.value / push for bound in bounds]
    whole = all(
        round(pulse) >= 1 and bound.matches(push * round(pulse))
        for bound, pulse in zip(bounds, pulses, strict=True)
    )
    # Rest to rest over the printed start distance along one axis at full control: 2 sqrt(d / a).
    distance = float(np.linalg.norm(start_state(section)[:3]))
    sample = section.phases.far.sample_time_s
    steps = 2.0 * np.sqrt(distance / bounds[0].value) / sample
    impulse_steps = 2.0 * np.sqrt(distance * sample / bounds[0].value) / sample
    # The fewest steps of a far range to a target at rest.
    printed = printed_steps(section, grounds.ledger)
    fewest = min(printed[case, "far"] for case in ("v-bar", "r-bar"))
    return Proof(
        whole and pulses[0] > 1.0 and steps < fewest / 2 < impulse_steps,
        f"{distance:.0f} m in {np.ceil(steps):.0f} far-range steps",
        f"in {np.ceil(impulse_steps):.0f} steps; printed are {fewest}",
        f"A thruster of {craft.thruster_N:g} N gives {craft.mass_kg:g} kg at most "
        f"{push:.4f} m/s^2; the bounds are that times "
        f"{', '.join(f'{pulse:.2f}' for pulse in pulses)} s, whole seconds to the printed digits. "
        f"Held as accelerations they would bring the chaser over the start distance and to rest "
        f"in {np.ceil(steps):.0f} steps, and five times the thrust at hand would be needed",
    )


def initial_distance(grounds: Grounds[Configuration]) -> Proof:
    """The distance of Section 3.6 is compared with the position in Table 3.2."""
    distance = float(np.linalg.norm(start_state(grounds.section)[:3])) / 1000.0
    printed = grounds.ledger.value("section-3-6/initial-chaser-distance/all-cases")
    return Proof(
        not printed.matches(distance),
        f"{printed.value:g} km",
        f"{distance:.3f} km",
        f"The position of Table 3.2 has the length {1000.0 * distance:.1f} m",
        correct=distance,
    )


def thrust_as_delta_v(grounds: Grounds[Configuration]) -> Proof:
    """Chapter 1: the printed bound holds for the thrust, and the delta-v has another unit."""
    craft = grounds.section.spacecraft
    bound = max(phase.control_bound_m_s for _, phase in grounds.section.phases)
    seconds = bound * craft.mass_kg / craft.thruster_N
    name = "chapter-1/maximum-thrust-order-of-small-satellite-propulsion/background"
    printed = grounds.ledger.value(name)
    return Proof(
        printed.matches(craft.thruster_N) and abs(seconds - 1.0) > 0.5,
        "a delta-v in newtons",
        f"a thrust: {craft.thruster_N:g} N < {printed.value:g} N",
        f"Thrust and delta-v differ by a time over the mass: the largest delta-v of a step is "
        f"{bound:g} m/s, {seconds:.0f} s of {craft.thruster_N:g} N on {craft.mass_kg:g} "
        f"kg; Section 2.1.2 cites the same source for thrusts up to {printed.value:g} N",
    )


def on_time(grounds: Grounds[Configuration]) -> Proof:
    """Eq. 2.5: the impulse of the printed on-time against the one that was asked for."""
    craft = grounds.section.spacecraft
    phase = grounds.section.phases.far
    sample, delta_v = phase["sample_time_s"], phase["control_bound_m_s"]
    mass, thrust = craft.mass_kg, craft.thruster_N
    force = mass * delta_v / sample  # "F dt = m dv"
    printed, correct = force / thrust, force * sample / thrust
    return Proof(
        abs(thrust * correct / mass - delta_v) < ROUNDING
        and abs(thrust * printed / mass - delta_v) > 0.5 * delta_v,
        f"{printed:.3f}, without a unit",
        f"{correct:.2f} s",
        f"For {delta_v:g} m/s the printed ratio, taken in seconds, gives an impulse of "
        f"{thrust * printed:.3f} N s where {mass * delta_v:.2f} N s are needed; with the "
        f"sample time it gives them exactly",
    )


def last_state_twice(grounds: Grounds[Configuration]) -> Proof:
    """Eq. 2.12: only the sum to N - 1 makes the Riccati weight stand for the infinite rest."""
    section = grounds.section
    given = law(section, "v-bar")
    # The final phase, whose heavy control weight leaves much to do after its horizon.
    matrix = transition(rate_matrix(given.mean_motion), given.sample_times[2])
    weights = np.diag(np.asarray(given.state_weights)[2])
    control = np.diag(np.asarray(given.control_weights)[2])
    rest = terminal_weight(matrix, np.diag(weights), np.diag(control))
    effect = matrix[:, 3:]
    gain = np.linalg.solve(control + effect.T @ rest @ effect, effect.T @ rest @ matrix)
    state = start_state(section)
    infinite = float(state @ rest @ state)
    running = 0.0
    for _ in range(given.horizons[2]):
        command = -gain @ state
        running += float(state @ weights @ state + command @ control @ command)
        state = matrix @ state + effect @ command
    corrected = running + float(state @ rest @ state)
    printed = corrected + float(state @ weights @ state)
    return Proof(
        abs(corrected / infinite - 1.0) < ROUNDING
        and abs(printed / infinite - 1.0) > 100.0 * ROUNDING,
        f"off by {printed / infinite - 1.0:.1e} of the cost",
        f"equal to it within {ROUNDING:g}",
        "Without constraints the cost with the Riccati weight of Section 2.2.2 must equal that "
        "of the infinite horizon. Summed to N - 1 it does; summed to N it exceeds it by the "
        "last state's stage cost, and the control u_N, which moves nothing, is paid for",
    )


def printed_stage_cost(command: np.ndarray, weight: float) -> float:
    """Eq. 2.11b as printed, without the one that counts time."""
    return float(np.abs(weight * command).sum())


def quadratic_stage_cost(grounds: Grounds[Configuration]) -> Proof:
    """Eq. 2.11b: a quadratic form has the same curvature everywhere, a norm none off its kinks."""
    weight = grounds.section.phases.far.control_weight
    command, direction = np.array([0.1, -0.2, 0.3]), np.array([0.5, 0.4, -0.7])
    step = 0.01

    def curvature(cost) -> float:
        ahead, here, behind = (cost(command + s * direction) for s in (step, 0.0, -step))
        return float(ahead - 2.0 * here + behind) / step**2

    printed = curvature(lambda u: printed_stage_cost(u, weight))
    correct = curvature(lambda u: u @ (weight * u))
    exact = 2.0 * weight * float(direction @ direction)
    return Proof(
        abs(printed) < 1e-6 * exact and abs(correct / exact - 1.0) < 1e-6,
        "no curvature: the 1-norm of Eq. 2.11a again",
        f"u' R u has a curvature of {correct:.0f} along a sample direction",
        f"Differences of second order along a sample direction give the printed form a curvature "
        f"of zero, where R makes {exact:.0f}: both lines of Eq. 2.11 are the same function",
    )


def docking_cone_apex(grounds: Grounds[Configuration]) -> Proof:
    """Eqs. 3.12 and 3.14: a chaser at the port, over the horizon of the rotating case."""
    section = grounds.section
    given = law(section, "rotating")
    axis, last, faces = np.empty(3), np.empty(3), np.empty((4, 3))
    tangent = np.tan(given.cone_angles[2])
    duration = given.horizons[2] * given.sample_times[2]
    rotated(np.array(given.axis), given.rotation_rate * duration, last)
    moved = given.port * float(np.linalg.norm(last - np.array(given.axis)))
    printed = corrected = -np.inf
    for i in range(given.horizons[2] + 1):
        rotated(np.array(given.axis), given.rotation_rate * i * given.sample_times[2], axis)
        cone_faces(axis, tangent, faces)
        port = given.port * axis
        printed = max(printed, float(np.max(faces @ (port - given.port * last))))
        corrected = max(corrected, float(np.max(faces @ (port - port))))
    return Proof(
        printed > ROUNDING and corrected <= 0.0,
        f"a docked chaser is outside by up to {1000.0 * printed:.0f} mm",
        "a docked chaser is at the tip of the cone at every stage",
        f"With the rotation of Case 3, inferred, the port moves by {1000.0 * moved:.0f} mm over "
        f"the horizon of {duration:g} s; the printed constraint has the tip of every stage's cone "
        f"at the port's last place, while H and the reference of Eq. 3.11 go with the stage",
    )


def _places(grounds: Grounds, **columns: str) -> np.ndarray:
    """Positions of a flight at its samples, m, shape (samples, 3)."""
    return grounds.rows("flights.parquet", **columns)[STATE[:3]].to_numpy(dtype=float)


def rendezvous_end_distance(grounds: Grounds[Configuration]) -> Proof:
    """Algorithm 1: the end as printed never comes, for the keep-out constraint forbids it.

    The corrected form is the one that is flown; the phase ends by it.
    """
    given = law(grounds.section, "v-bar")
    far, mid = (_places(grounds, flight="v-bar", phase=phase) for phase in ("far", "mid"))
    distance, end = np.linalg.norm(far, axis=1), float(np.linalg.norm(mid[0]))
    switch, measured = given.switch_distances[RENDEZVOUS], given.switches[RENDEZVOUS]
    never = bool((distance > given.keep_out - 1e-6 * given.keep_out).all())
    flown = measured == DISTANCE and given.keep_out < end <= switch
    return Proof(
        never and flown,
        f"never within r1: {distance.min():.1f} m is the least of {len(far)} samples",
        f"with d = {switch:.1f} m, inferred, it ends at {end:.1f} m",
        f"Eq. 3.5 makes n'x >= r1 and so |x| >= r1 at every predicted step. In our run of "
        f"Case 1, which ends the phase by the corrected form, no sample of the far range comes "
        f"within r1 = {given.keep_out:.1f} m, inferred",
    )


def rendezvous_end_cone(grounds: Grounds[Configuration]) -> Proof:
    """Algorithm 1: x <= Hx compares three entries with four; Hx <= 0 is the cone."""
    section = grounds.section
    given = law(section, "v-bar")
    faces = np.empty((section.cone_faces, 3))
    cone_faces(np.array(given.axis), np.tan(given.cone_angles[0]), faces)
    end = _places(grounds, flight="v-bar", phase="mid")[0]
    start = start_state(section)[:3]
    inside, outside = float((faces @ end).max()), float((faces @ start).max())
    return Proof(
        len(faces) != len(end) and inside <= ROUNDING < outside,
        f"{len(end)} entries against {len(faces)}",
        f"largest of H x: {outside:.0f} m at the start, {inside:.1f} m at the end",
        f"H has {len(faces)} rows for the polyhedron of Section 3.1.2 and x has {len(end)} "
        f"components, so the printed condition is no condition; Hx <= 0 is false where Case 1 "
        f"starts and true where our run of it enters the mid range",
    )


def approach_end_vector(grounds: Grounds[Configuration]) -> Proof:
    """Algorithm 1: x <= r2 by components is true far away, on the other side of the target."""
    overshoot = law(grounds.section, "v-bar").overshoot
    mid = grounds.rows("flights.parquet", phase="mid")
    mid = mid[mid["flight"].isin(CASE_TABLES)]
    # The motion is linear: mirrored at the target, a flight is one to a port on the other side.
    mirrored = -mid[STATE[:3]].to_numpy()
    distance = np.linalg.norm(mirrored, axis=1)
    wrong = (mirrored <= overshoot).all(axis=1) & (distance > 2.0 * overshoot)
    reach = float(distance[wrong].max(initial=0.0))
    return Proof(
        wrong.any(),
        f"true at up to {reach:.0f} m from the target",
        f"|x| <= r2 is false wherever |x| > {overshoot:.1f} m",
        f"A vector is not below a number. Read by components, the condition is true at "
        f"{int(wrong.sum())} of {len(mid)} samples of our mid ranges, mirrored to a port on "
        f"the other side of the target, although they lie farther off than twice r2 = "
        f"{overshoot:.1f} m, inferred. Section 3.3 speaks of the distance",
    )


def impulse_matrix(grounds: Grounds[Configuration]) -> Proof:
    """Section 2.1.1 against Eq. 3.1: which of B and B-bar the transition matrix is applied to."""
    given = law(grounds.section, "v-bar")
    matrix = transition(rate_matrix(given.mean_motion), given.sample_times[0])
    push = np.vstack([np.zeros((3, 3)), np.eye(3)])
    once, twice = matrix @ push, matrix @ matrix @ push
    return Proof(
        abs(twice[1, 1] - once[1, 1]) > 1.0,
        f"one put into the other, an impulse of 1 m/s moves the chaser by {twice[1, 1]:.1f} m in "
        f"a step of {given.sample_times[0]:g} s",
        f"by {once[1, 1]:.1f} m",
        "Section 2.1.1 has B = A B-bar, Eq. 3.1 B-bar = A B; each is right in its own names, and "
        "one put into the other applies the transition matrix twice",
    )


def printed_drag(flow: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """The right side of Eq. 5.5 for plates of unit area in unit air, with unit coefficient."""
    cosines = np.maximum(normals @ flow / np.linalg.norm(flow), 0.0)
    return -0.5 * (flow @ flow) * cosines.sum()


def drag_direction(_: Grounds) -> Proof:
    """Eq. 5.5: what stands on the right, for a box in a flow, against what a force is."""
    flow = np.array([0.3, -0.8, 0.5])
    found = printed_drag(flow, np.vstack([np.eye(3), -np.eye(3)]))
    return Proof(
        np.shape(found) != np.shape(flow),
        f"{np.size(found)} number",
        f"{np.size(flow)} components",
        "The left side is a force in the body's frame. The square of the relative speed leaves its "
        "direction out, and no plate's normal stands in the sum by itself",
    )
