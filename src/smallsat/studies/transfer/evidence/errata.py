"""Proofs of the errata of the orbit-transfer document; each recomputes a quantity both ways."""

from dataclasses import replace
from pathlib import Path

import casadi as ca
import numpy as np

from smallsat.config import Config
from smallsat.evidence.errata import Proof
from smallsat.evidence.not_converged import NotConverged
from smallsat.results import read_table
from smallsat.studies.transfer.evidence.observations import degree_spread
from smallsat.studies.transfer.evidence.printed import (
    contradictions,
    mass_from_time,
    printed_cases,
    printed_value,
)
from smallsat.studies.transfer.methods.extremals import find_extremals
from smallsat.studies.transfer.model.problem import TransferProblem
from smallsat.studies.transfer.model.units import canonical, units_of
from smallsat.studies.transfer.results import PrintedCase, read_cases, select


def _solve(config: Config, **changes: float) -> tuple[float, float]:
    study = config["transfer"]
    problem = replace(TransferProblem.from_config(study), **changes)
    units, steps = units_of(problem), study["numerics"]["steps"]["indirect"]
    found = find_extremals(canonical(problem), units, (1,), study["guess"], steps)[1]
    if isinstance(found, NotConverged):
        raise LookupError(found.status)
    final_time = found.extremal.final_time * units.time
    return final_time, problem.final_mass(final_time)


def exhaust_speed(config: Config, results: Path) -> Proof:
    """Solve the problem with the exhaust speed of the prose and with that of the listings."""
    prose = printed_value("transfer/section-2-3/v-e-exhaust-speed")
    listing = printed_value("transfer/listing-1/param-ve")
    wrong, right = (_solve(config, exhaust_speed=speed) for speed in (prose, listing))
    printed = (
        printed_value("transfer/table-1/terminal-time/indirect-shooting"),
        printed_value("transfer/table-1/terminal-mass/indirect-shooting"),
    )
    fits = np.allclose(right, printed, rtol=0, atol=5e-6)
    return Proof(
        holds=bool(fits and not np.isclose(wrong[0], printed[0], rtol=0, atol=5e-6)),
        as_printed=f"t_f = {wrong[0]:.6f}, m_f = {wrong[1]:.6f}",
        as_corrected=f"t_f = {right[0]:.6f}, m_f = {right[1]:.6f}",
        statement=(
            f"Only v_e = {listing} of the listings gives Table 1 "
            f"({printed[0]:.5f}, {printed[1]:.5f}); v_e = {prose} does not"
        ),
    )


def final_radius(config: Config, results: Path) -> Proof:
    """A final radius of 1 is the initial orbit, which needs no transfer at all."""
    prose = printed_value("transfer/section-2-3/boundary-transversality-condition/r-f")
    table = printed_value("transfer/section-2-1-conditions-table/terminal-condition/r-t-f")
    problem = TransferProblem.from_config(config["transfer"])
    same_orbit = replace(problem, final_radius=prose)
    error = float(np.max(np.abs(same_orbit.terminal_error(same_orbit.initial_state))))
    time, _ = _solve(config, final_radius=table)
    printed = printed_value("transfer/table-1/terminal-time/indirect-shooting")
    return Proof(
        holds=error == 0.0 and abs(time - printed) <= 5e-6,
        as_printed="the initial state meets every terminal condition: t_f = 0",
        as_corrected=f"t_f = {time:.6f}",
        statement=(
            f"With r(t_f) = {prose:g} the spacecraft is there already; "
            f"r(t_f) = {table:g} gives the printed {printed:.5f}"
        ),
    )


def mass_of_n4_k16(config: Config, results: Path) -> Proof:
    """The mass flow is constant, so the printed time of the same row fixes the mass."""
    row = "direct-multiple-shooting-n-4-k-16"
    time = printed_value(f"transfer/table-4/terminal-time/{row}")
    mass = printed_value(f"transfer/table-4/terminal-mass/{row}")
    best = printed_value("transfer/table-1/terminal-mass/indirect-shooting")
    implied = mass_from_time(time, config)
    return Proof(
        holds=abs(mass - implied) > 5e-6 and mass > best,
        as_printed=f"{mass:.5f}",
        as_corrected=f"{implied:.5f}",
        statement=(
            f"m_f = 1 - (T / v_e) t_f with the row's own t_f = {time:.5f} gives {implied:.6f}; "
            f"the printed {mass:.5f} would beat the indirect optimum {best:.5f}"
        ),
    )


def _mass_of_single(config: Config, degree: int) -> Proof:
    row = f"direct-shooting-n-{degree}"
    time = printed_value(f"transfer/table-3/terminal-time/{row}")
    table = printed_value(f"transfer/table-3/terminal-mass/{row}")
    prose = printed_value(f"transfer/section-3-3/terminal-mass/{row}")
    # The printed time is rounded at its fourth decimal: the mass it implies has this much room.
    room = config["transfer"]["problem"]["thrust"] * 5e-5
    implied = mass_from_time(time, config)
    return Proof(
        holds=abs(prose - implied) > 5e-6 + room,
        as_printed=f"{prose:.5f}",
        as_corrected=f"{implied:.5f}",
        statement=(
            f"Table 3's t_f = {time:.4f} implies {implied:.5f} (give or take {room:.0e}); "
            f"its own mass is {table:.4f}, the prose says {prose:.5f}"
        ),
    )


def mass_of_n4_prose(config: Config, results: Path) -> Proof:
    """The prose's mass for N = 4 against the time of the same case."""
    return _mass_of_single(config, 4)


def mass_of_n6_prose(config: Config, results: Path) -> Proof:
    """The prose's mass for N = 6 against the time of the same case."""
    return _mass_of_single(config, 6)


def extra_digit_k16(config: Config, results: Path) -> Proof:
    """The seventh digit of the prose for K = 16 against Table 2 and the converged solution."""
    case = "indirect-multiple-shooting-k-16"
    prose = printed_value(f"transfer/section-3-2/terminal-time/{case}")
    table = printed_value(f"transfer/table-2/terminal-time/{case}")
    row = select(read_cases(results), PrintedCase("indirect", 0, 16), "as published").iloc[0]
    ours = float(row["final_time"])
    if not row["converged"]:
        raise LookupError("a case that did not converge")
    return Proof(
        holds=abs(prose - table) > 5e-6 and abs(ours - table) <= 5e-6 and row["residual"] < 1e-9,
        as_printed=f"{prose:.6f}",
        as_corrected=f"{ours:.6f}",
        statement=(
            f"{prose:.6f} does not round to Table 2's {table:.5f}; the converged t_f is "
            f"{ours:.8f}, its conditions met to {row['residual']:.0e} when flown anew"
        ),
    )


def effect_of_degree(config: Config, results: Path) -> Proof:
    """The spread of the final time over the degrees, from Table 4 and from converged runs."""
    printed = printed_value(
        "transfer/section-3-4-1/effect-of-degree-on-terminal-time/direct-multiple-shooting"
    )
    times = printed_cases("Table 4")["terminal time"].groupby("intervals")
    own = 100 * (times.max() - times.min()) / times.min()
    ours = degree_spread(read_cases(results), "converged")
    if ours.isna().any():
        raise LookupError("a case that did not converge")
    listed = ", ".join(f"K = {k}: {value:.4f} %" for k, value in own.items())
    return Proof(
        holds=bool(own.max() > 2 * printed),
        as_printed=f"{printed} %",
        as_corrected=f"up to {own.max():.3f} % in Table 4, {ours.max():.3f} % converged",
        statement=f"Table 4's own spread over N is {listed}",
    )


def mass_increase(config: Config, results: Path) -> Proof:
    """The sign of the mass change from the indirect method to one polynomial of degree 6."""
    indirect = printed_value("transfer/section-3-5/terminal-mass/direct-shooting-n-6")
    best = printed_value("transfer/table-1/terminal-mass/indirect-shooting")
    change = 100 * (indirect - best) / best
    return Proof(
        holds=change < -0.5,
        as_printed="an increase of 1 %",
        as_corrected=f"a change of {change:+.2f} %",
        statement=f"The mass goes from {best:.4f} to {indirect:.4f}: it falls",
    )


def time_of_n4_prose(config: Config, results: Path) -> Proof:
    """The elapsed time of N = 4 in the prose is that of N = 5."""
    prose = printed_cases("Section 3.3")["elapsed time"]
    table = printed_cases("Table 3")["sim time"]
    four, five = ("direct", 4, 1), ("direct", 5, 1)
    return Proof(
        holds=bool(prose[four] == prose[five] and prose[four] != table[four]),
        as_printed=f"{prose[four]} s",
        as_corrected=f"{table[four]} s (Table 3)",
        statement=(
            f"The prose gives {prose[four]} s for N = 4 and for N = 5; Table 3 has "
            f"{table[four]} s and {table[five]} s"
        ),
    )


def increase_in_time(config: Config, results: Path) -> Proof:
    """The relative increase in execution time from N = 2 to N = 6 at K = 2."""
    table = printed_cases("Table 4")["sim time"]
    low, high = table["direct", 2, 2], table["direct", 6, 2]
    printed = printed_value("transfer/section-3-4-1/increase-in-computation-time-n-2-to-n-6/k-2")
    own = 100 * (high / low - 1)
    return Proof(
        holds=abs(own - printed) > 0.05,
        as_printed=f"{printed} %",
        as_corrected=f"{own:.1f} %",
        statement=f"{high} s against {low} s is an increase of {own:.1f} %",
    )


def prose_against_table_4(config: Config, results: Path) -> Proof:
    """Cells of Section 3.4's prose that Table 4 contradicts beyond rounding and cutting off."""
    cells = contradictions("Section 3.4", "Table 4", {"elapsed time": "sim time"})
    counts = cells["quantity"].value_counts(sort=False)
    listed = ", ".join(f"{name}: {count}" for name, count in counts.items())
    return Proof(
        holds=len(cells) > 0,
        as_printed=f"{len(cells)} cells differ",
        as_corrected="two different runs were written up",
        statement=f"Cells that differ by more than a unit of the last printed digit: {listed}",
    )


def nesting(config: Config, results: Path) -> Proof:
    """For fixed K the final time cannot rise with N: a polynomial of degree N is one of N + 1."""
    printed = printed_cases("Table 4")["terminal time"].droplevel("method").unstack("intervals")
    cases = read_cases(results)
    ours = cases[(cases["run"] == "converged") & (cases["intervals"] > 1)]
    if not ours["converged"].all():
        raise LookupError("a case that did not converge")
    converged = ours.pivot(index="degree", columns="intervals", values="final_time")
    rises = [
        f"K = {k}, N = {n} to {n + 1}: {printed.loc[n, k]:.5f} to {printed.loc[n + 1, k]:.5f}"
        for k in printed.columns
        for n in printed.index[:-1]
        if printed.loc[n + 1, k] > printed.loc[n, k]
    ]
    ours_rise = int((converged.diff().iloc[1:] > 1e-9).to_numpy().sum())
    return Proof(
        holds=len(rises) > 0 and ours_rise == 0,
        as_printed=f"{len(rises)} rises",
        as_corrected=f"{ours_rise} rises in the converged grid",
        statement="Printed final times that rise with N: " + "; ".join(rises),
    )


def optimal_choice(config: Config, results: Path) -> Proof:
    """The case with the smallest printed final time."""
    times = printed_cases("Table 4")["terminal time"].droplevel("method")
    degree, intervals = times.index[int(times.argmin())]
    return Proof(
        holds=(degree, intervals) != (6, 16),
        as_printed=f"N = 6, K = 16 ({times[6, 16]:.5f})",
        as_corrected=f"N = {degree}, K = {intervals} ({times.min():.5f})",
        statement=f"Table 4's smallest t_f is {times.min():.5f}, at N = {degree}, K = {intervals}",
    )


def lagrange_gravity(config: Config, results: Path) -> Proof:
    """The gravity term of Lagrange's equation, by differentiating the printed Lagrangian."""
    r, rate, mu = ca.SX.sym("r"), ca.SX.sym("rate"), config["transfer"]["problem"]["mu"]
    lagrangian = 0.5 * rate**2 * r**2 + mu / r
    derivative = ca.Function("d", [r, rate], [ca.gradient(lagrangian, r)])
    radius = config["transfer"]["problem"]["final_radius"]
    force = float(derivative(radius, 0.0))
    return Proof(
        holds=bool(np.isclose(force, -mu / radius**2) and not np.isclose(force, -mu / radius)),
        as_printed=f"-mu / r = {-mu / radius:.6f} at r = {radius}",
        as_corrected=f"-mu / r^2 = {-mu / radius**2:.6f}",
        statement=f"Differentiating equation 16 by r gives {force:.6f}",
    )


def generalised_force(config: Config, results: Path) -> Proof:
    """The generalised force of theta needs the derivative of the position by theta."""
    angle, radius, beta = 0.7, config["transfer"]["problem"]["final_radius"], 0.4
    u_r = np.array([np.cos(angle), np.sin(angle)])
    u_theta = np.array([-np.sin(angle), np.cos(angle)])
    force = np.cos(beta) * u_theta + np.sin(beta) * u_r
    step = 1e-6
    ahead = radius * np.array([np.cos(angle + step), np.sin(angle + step)])
    by_theta = float(force @ (ahead - radius * u_r) / step)
    by_radius = float(force @ u_r)
    return Proof(
        holds=bool(
            np.isclose(by_theta, radius * np.cos(beta), atol=1e-5)
            and not np.isclose(by_radius, radius * np.cos(beta), atol=1e-5)
        ),
        as_printed=f"derivative by r: {by_radius:.6f} T",
        as_corrected=f"derivative by theta: {by_theta:.6f} T",
        statement=(
            f"Equation 18's result T r cos(beta) = {radius * np.cos(beta):.6f} T at an arbitrary "
            "angle follows from the derivative by theta alone"
        ),
    )


def hamiltonian_exhaust(config: Config, results: Path) -> Proof:
    """The Hamiltonian vanishes along the extremal with v_e in the mass term, not with v_theta."""
    flown = read_table(results / "indirect.parquet")
    flown = flown[flown["intervals"] == 1]
    if flown.empty:
        raise LookupError("no solution of indirect shooting")
    problem = TransferProblem.from_config(config["transfer"])
    correct = flown["hamiltonian"].abs().max()
    mass_term = flown["lambda_m"] * problem.thrust
    wrong = (
        (flown["hamiltonian"] + mass_term / problem.exhaust_speed - mass_term / flown["v_theta"])
        .abs()
        .max()
    )
    return Proof(
        holds=bool(correct < 1e-8 and wrong > 1e-3),
        as_printed=f"largest H = {wrong:.3f}",
        as_corrected=f"largest H = {correct:.1e}",
        statement=(
            "Along the extremal H must vanish: with -T / v_e in the mass term it does to "
            f"{correct:.0e}, with the printed v_theta it reaches {wrong:.3f}"
        ),
    )


def iterations_unit(config: Config, results: Path) -> Proof:
    """Whole numbers in a column headed in seconds, beside a column of seconds without a unit."""
    columns = printed_cases("Table 4")
    whole = bool((columns["iterations"] % 1 == 0).all())
    fractional = bool((columns["sim time"] % 1 != 0).any())
    return Proof(
        holds=whole and fractional,
        as_printed="Iterations (s)",
        as_corrected="Iterations; Sim Time (s)",
        statement="Every iteration count is a whole number and no sim time of Table 4 needs to be",
    )
