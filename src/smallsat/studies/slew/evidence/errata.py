"""Proofs of the errata: each recomputes a quantity as printed and as corrected, and can fail."""

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from smallsat.dynamics.attitude.quaternions import quaternion_to_dcm
from smallsat.dynamics.environment.torques import gravity_gradient
from smallsat.evidence.errata import Proof
from smallsat.evidence.grounds import Grounds
from smallsat.optimal_control.gauss_pseudospectral import differentiation_matrix, legendre_gauss
from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.evidence.observations import scaled_durations
from smallsat.studies.slew.parameters import Parameters

# Columns of Table 4: turns and processors.
MEASURED = [f"{turn}-deg-{name}" for turn in (90, 180) for name in ("i7-2700k", "core2duo-t7700")]
ROUNDING = 1e-9
NODES = 7  # of the quadrature in proofs; any number would do


def _table_3(grounds: Grounds[Configuration], case: str) -> dict[Any, float]:
    """A line of Table 3: its scaled time, and the smallest and largest time that follow, s."""
    table = scaled_durations(Parameters.from_section(grounds.section), grounds.results)
    return table.set_index("case").to_dict("index")[case]


def table_3_time_optimal(grounds: Grounds[Configuration]) -> Proof:
    """52.80 s: the two columns of a row are one number times two known roots."""
    parameters = Parameters.from_section(grounds.section)
    row = _table_3(grounds, "90-deg-time-optimal")
    scales = np.sqrt(np.diag(parameters.inertia)[[0, 2]] / parameters.torque)
    printed = grounds.ledger.value("table-3/t-min/90-deg-time-optimal").value
    implied = printed / scales[0]
    return Proof(
        abs(row["t_min"] - printed) > 1.0 and abs(implied * scales[1] - row["t_max"]) > 1.0,
        f"{printed:.2f} s, a scaled time of {implied:.3f}",
        f"{row['t_min']:.2f} s, a scaled time of {row['t_hat']:.4f}",
        f"Eq. 30 gives both columns from one scaled time; {printed:.2f} s would "
        f"imply {implied:.3f} and {implied * scales[1]:.2f} s in the other column, where the "
        f"document has what follows from our least time of {row['t_hat']:.4f}",
        correct=row["t_min"],
    )


def table_3_eigenaxis(grounds: Grounds[Configuration]) -> Proof:
    """88.90 s: full torque forth and back about the axis of the largest moment."""
    parameters = Parameters.from_section(grounds.section)
    row = _table_3(grounds, "90-deg-eigenaxis")
    moment = parameters.inertia[2, 2]
    printed = grounds.ledger.value("table-3/t-max/90-deg-eigenaxis")
    turned = np.degrees(parameters.torque / moment * (printed.value / 2.0) ** 2)
    exact = np.degrees(parameters.torque / moment * (row["t_max"] / 2.0) ** 2)
    return Proof(
        abs(row["t_max"] - printed.value) > 2 * printed.half_unit and abs(exact - 90.0) < 1e-6,
        f"{printed.value:.2f} s turns the body by {turned:.2f} deg",
        f"{row['t_max']:.2f} s turns it by {exact:.2f} deg",
        f"2 sqrt(angle J / u) = {row['t_max']:.3f} s for J = {moment:g} kg m^2; in the printed "
        f"time the wheels turn the body by {turned:.2f} deg only",
        correct=row["t_max"],
    )


def table_2_velocity_sign(grounds: Grounds) -> Proof:
    """v_f,z: the height falls in 100 s, so its rate cannot be positive all the way."""
    table = grounds.table("orbit.csv")
    ours = float(grounds.rows("orbit.csv", gravity="J2")["vz_km_s"].iloc[0])
    before, after = (grounds.ledger.value(f"table-2/{r}/z").value for r in ("r-0", "r-f"))
    printed = grounds.ledger.value("table-2/v-f/z")
    return Proof(
        ours < 0.0 and (table["vz_km_s"] < 0.0).all() and after < before and printed.matches(-ours),
        f"v_z = +{printed.value:g} km/s, rising",
        f"v_z = {ours:.6f} km/s, falling",
        f"Table 2 itself has z falling from {before} to {after} km from a v_z of practically "
        f"zero; all {len(table)} propagations (two starts, with and without J2, two "
        f"integrators) give a negative v_z, with J2 of the printed magnitude",
        correct=ours,
    )


def dimensions(grounds: Grounds[Configuration]) -> Proof:
    """l, b, h: with the printed sizes the areas of Table 5 are a hundred times too large."""
    craft = grounds.section.spacecraft
    size, areas = craft.size_m, craft.panel_area_m2
    length, breadth, height = np.array(
        grounds.ledger.values("appendix-after-table-5/cubesat-dimension"), dtype=float
    )
    printed = length * breadth
    correct = size.length * size.breadth
    end = size.breadth * size.height
    density = craft.mass_kg / (printed * height)
    return Proof(
        np.isclose(correct, areas.side)
        and np.isclose(end, areas.end)
        and not np.isclose(printed, areas.side),
        f"l b = {printed:g} m^2, and {density:.2g} kg/m^3",
        f"l b = {correct:g} m^2, as in Table 5",
        f"Table 5 has panels of {areas.side} and {areas.end} m^2, which are l b and b h "
        f"of the sizes ten times the printed ones; with those the mass of "
        f"{craft.mass_kg:g} kg would have a density of {density:.2g} kg/m^3",
        correct=f"l = {size.length:g} m, b = h = {size.breadth:g} m",
    )


def zenith_axis(grounds: Grounds[Configuration]) -> Proof:
    """Table 5: with its zenith panel up, the gravity gradient turns the body over.

    A body whose vertical axis has the largest moment of inertia has no stable equilibrium in pitch,
    whichever of its other axes is along the orbit.
    """
    parameters = Parameters.from_section(grounds.section)
    normal = grounds.ledger.literal("table-5/area-normal-vector/panel-3").strip("$+")
    label = grounds.ledger.literal("table-5/label/panel-3")
    moments = dict(zip("xyz", np.diag(parameters.inertia), strict=True))
    named = next(axis for axis in "xyz" if axis in normal)
    least, largest = (pick(moments, key=moments.__getitem__) for pick in (min, max))
    r, _ = parameters.state
    up = np.array(quaternion_to_dcm(tuple(parameters.initial))) @ r
    start = "xyz"[int(np.argmax(np.abs(up)))]
    return Proof(
        label.startswith("Zenith") and named == largest,
        f"zenith along {named}, J = {moments[named]:g} kg m^2",
        f"along {least}, J = {moments[least]:g} kg m^2",
        f"Gravity gradient holds the axis of the least moment upright, and booms for it make that "
        f"moment the least. The tensor of Section V.F has its least about {least} and its largest "
        f"about {largest}, and in Table 2 the body starts with {start} upright; with {named} "
        f"upright it would be unstable in pitch. Which of the axes slipped, the text does not tell",
    )


def scaled_derivative(grounds: Grounds[Configuration]) -> Proof:
    """Eqs. 10 and 11: the matrix differentiates by tau, so that 2 / (tf - t0) is missing."""
    duration = grounds.section.manoeuvre.duration_s
    points, _ = legendre_gauss(NODES)
    matrix = differentiation_matrix(points)
    time = duration * (np.r_[-1.0, points] + 1.0) / 2.0
    slope = matrix @ time**2
    exact = 2.0 * time[1:]
    printed = float(np.max(np.abs(slope / exact - 1.0)))
    correct = float(np.max(np.abs(2.0 / duration * slope / exact - 1.0)))
    return Proof(
        printed > 0.5 and correct < ROUNDING,
        f"d(t^2)/dt is wrong by a factor of {duration / 2:g}",
        "2 / (tf - t0) D X: exact for polynomials",
        f"Applied to t^2 on {duration:g} s the printed form is off by a factor of "
        f"{duration / 2:g}; with 2 / (tf - t0), as in Eq. 14, the error is below {ROUNDING:g}",
    )


def matrix_size(grounds: Grounds) -> Proof:
    """Eq. 15: N rows for N points, not N + 1."""
    points, _ = legendre_gauss(NODES)
    matrix = differentiation_matrix(points)
    rows, columns = matrix.shape
    return Proof(
        rows == NODES and columns == NODES + 1,
        "(N + 1) x (N + 1)",
        "N x (N + 1)",
        f"The dynamics are collocated at the N Gauss points alone (Section IV.A): for N = "
        f"{NODES} the matrix has {rows} rows and {columns} columns",
    )


def weight_argument(grounds: Grounds) -> Proof:
    """Eq. 13: the derivative of the Legendre polynomial is taken at the point."""
    points, weights = legendre_gauss(NODES)
    derivative = np.polynomial.legendre.Legendre.basis(NODES).deriv()
    correct = 2.0 / ((1.0 - points**2) * derivative(points) ** 2)
    value = np.polynomial.legendre.Legendre.basis(NODES)(points)
    error = float(np.max(np.abs(correct - weights)))
    return Proof(
        error < ROUNDING and np.max(np.abs(value)) < ROUNDING,
        "[P'_N]^2, called the polynomial itself",
        "[P'_N(tau_k)]^2, the derivative at the point",
        f"With the derivative at the point the weights are those of the quadrature to "
        f"{ROUNDING:g}; the polynomial itself, which the text names, vanishes there",
    )


def gradient_axis(grounds: Grounds[Configuration]) -> Proof:
    """Eq. 27 holds for a position along the first inertial axis only."""
    parameters = Parameters.from_section(grounds.section)
    r, v = parameters.state
    duration = grounds.section.manoeuvre.duration_s
    rate = np.linalg.norm(v) / np.linalg.norm(r)
    angle = rate * duration
    q = Rotation.from_euler("ZYX", [0.7, 0.4, 0.2]).as_quat()
    dcm = np.array(quaternion_to_dcm(tuple(q)))
    length = float(np.linalg.norm(r))

    def printed() -> np.ndarray:
        q1, q2, q3, q4 = q
        a = 2 * q4**2 + 2 * q1**2 - 1
        b, c = 2 * q2 * q1 - 2 * q4 * q3, 2 * q3 * q1 + 2 * q4 * q2
        ixx, iyy, izz = np.diag(parameters.inertia)
        factor = 3.0 * parameters.gravity.mu / length**3
        return factor * np.array([(izz - iyy) * b * c, (ixx - izz) * c * a, (iyy - ixx) * b * a])

    def general(position: np.ndarray) -> np.ndarray:
        return np.array(gravity_gradient(parameters.inertia, dcm @ position, parameters.gravity.mu))

    along = general(np.array([length, 0.0, 0.0]))
    moved = general(length * np.array([np.cos(angle), np.sin(angle), 0.0]))
    same = float(np.linalg.norm(printed() - along) / np.linalg.norm(along))
    off = float(np.linalg.norm(printed() - moved) / np.linalg.norm(moved))
    return Proof(
        same < ROUNDING and off > 0.01,
        f"wrong by {100 * off:.0f} % after {duration:g} s",
        "3 mu / r^5 r x J r, for any position and tensor",
        f"Eq. 27 uses the first column of the direction cosines: it equals the general formula "
        f"with r along the first inertial axis (to {ROUNDING:g}), and by the end of the "
        f"manoeuvre, {np.degrees(angle):.1f} deg further on, it is off by {100 * off:.0f} % "
        f"for a sample attitude",
    )


def mean_motion(grounds: Grounds[Configuration]) -> Proof:
    """Section V.D: mu / r^3 is the square of the mean motion."""
    parameters = Parameters.from_section(grounds.section)
    a = parameters.orbit.semi_major_axis
    motion = np.sqrt(parameters.gravity.mu / a**3)
    torque = parameters.gravity.mu / a**3
    return Proof(
        np.isclose(motion**2, torque) and not np.isclose(motion, torque, rtol=0.5),
        f"mu / r^3 = {torque:.3e} 1/s^2 approximated by {motion:.3e} 1/s",
        f"by its square, {motion**2:.3e} 1/s^2",
        "On a circular orbit mu / r^3 equals the squared mean motion; the mean motion has "
        "another unit",
    )


def guidance_share(grounds: Grounds) -> Proof:
    """Section VI.C: the smallest share of Table 4 is larger than 92 %."""
    guidance, total = (
        np.array(
            [grounds.ledger.value(f"table-4/{part}-run-time/{one}") for one in MEASURED], float
        )
        for part in ("guidance", "total")
    )
    shares = 100.0 * guidance / total
    printed = grounds.ledger.value("section-vi-c/guidance-share-of-run-time/min")
    return Proof(
        shares.min() > printed.value + printed.half_unit,
        f"{printed.value:g} %",
        f"{shares.min():.1f} %",
        f"Guidance over total time in Table 4 lies between {shares.min():.1f} and "
        f"{shares.max():.1f} %",
        correct=float(shares.min()),
    )
