"""Proofs of the errata of the orbit-transfer document; each recomputes a quantity both ways."""

from dataclasses import replace

import casadi as ca
import numpy as np

from smallsat.evidence.errata import Proof
from smallsat.evidence.grounds import Grounds
from smallsat.evidence.not_converged import NotConverged
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.evidence.observations import degree_spread
from smallsat.studies.transfer.evidence.printed_cases import contradictions, printed_cases
from smallsat.studies.transfer.methods.extremals import find_extremals
from smallsat.studies.transfer.model.problem import TransferProblem
from smallsat.studies.transfer.model.units import canonical, units_of
from smallsat.studies.transfer.results import final_times, read_cases


def _solve(section: Configuration, **changes: float) -> tuple[float, float]:
    problem = replace(TransferProblem.of(section.problem), **changes)
    units, steps = units_of(problem), section.numerics.steps.indirect
    found = find_extremals(canonical(problem), units, (1,), section.guess, steps)[1]
    if isinstance(found, NotConverged):
        raise LookupError(found.status)
    final_time = found.extremal.final_time * units.time
    return final_time, problem.final_mass(final_time)


def _mass_after(grounds: Grounds[Configuration], final_time: float) -> float:
    """Final mass that a final time implies (equation 27)."""
    return TransferProblem.of(grounds.section.problem).final_mass(final_time)


def exhaust_speed(grounds: Grounds[Configuration]) -> Proof:
    """Solve the problem with the exhaust speed of the prose and with that of the listings."""
    ledger = grounds.ledger
    prose = ledger.value("section-2-3/v-e-exhaust-speed").value
    listing = ledger.value("listing-1/param-ve").value
    wrong, right = (_solve(grounds.section, exhaust_speed=speed) for speed in (prose, listing))
    time, mass = (
        ledger.value(f"table-1/terminal-{quantity}/indirect-shooting")
        for quantity in ("time", "mass")
    )
    return Proof(
        time.matches(right[0]) and mass.matches(right[1]) and not time.matches(wrong[0]),
        f"t_f = {wrong[0]:.6f}, m_f = {wrong[1]:.6f}",
        f"t_f = {right[0]:.6f}, m_f = {right[1]:.6f}",
        f"Only v_e = {listing} of the listings gives Table 1 "
        f"({time.value:.5f}, {mass.value:.5f}); v_e = {prose} does not",
        correct=listing,
    )


def final_radius(grounds: Grounds[Configuration]) -> Proof:
    """A final radius of 1 is the initial orbit, which needs no transfer at all."""
    ledger = grounds.ledger
    prose = ledger.value("section-2-3/boundary-transversality-condition/r-f").value
    table = ledger.value("section-2-1-conditions-table/terminal-condition/r-t-f").value
    problem = TransferProblem.of(grounds.section.problem)
    same_orbit = replace(problem, final_radius=prose)
    error = float(np.max(np.abs(same_orbit.terminal_error(same_orbit.initial_state))))
    time, _ = _solve(grounds.section, final_radius=table)
    printed = ledger.value("table-1/terminal-time/indirect-shooting")
    return Proof(
        error == 0.0 and printed.matches(time),
        "the initial state meets every terminal condition: t_f = 0",
        f"t_f = {time:.6f}",
        f"With r(t_f) = {prose:g} the spacecraft is there already; "
        f"r(t_f) = {table:g} gives the printed {printed.value:.5f}",
        correct=table,
    )


def mass_of_n4_k16(grounds: Grounds) -> Proof:
    """The mass flow is constant, so the printed time of the same row fixes the mass."""
    row = "direct-multiple-shooting-n-4-k-16"
    time = grounds.ledger.value(f"table-4/terminal-time/{row}").value
    printed = grounds.ledger.value(f"table-4/terminal-mass/{row}")
    mass, best = printed.value, _best_mass(grounds)
    implied = _mass_after(grounds, time)
    return Proof(
        not printed.matches(implied) and mass > best,
        f"{mass:.5f}",
        f"{implied:.5f}",
        f"m_f = 1 - (T / v_e) t_f with the row's own t_f = {time:.5f} gives {implied:.6f}; "
        f"the printed {mass:.5f} would beat the indirect optimum {best:.5f}",
        correct=implied,
    )


def _best_mass(grounds: Grounds) -> float:
    """The printed final mass of the indirect optimum."""
    return grounds.ledger.value("table-1/terminal-mass/indirect-shooting").value


def _mass_of_single(grounds: Grounds[Configuration], degree: int) -> Proof:
    """The prose's mass of one polynomial is compared with the mass that Table 3's time implies."""
    row = f"direct-shooting-n-{degree}"
    time = grounds.ledger.value(f"table-3/terminal-time/{row}")
    table = grounds.ledger.value(f"table-3/terminal-mass/{row}").value
    prose = grounds.ledger.value(f"section-3-3/terminal-mass/{row}")
    # The printed time is rounded: the mass that it implies has this much room.
    room = grounds.section.problem.thrust * time.half_unit
    implied = _mass_after(grounds, time.value)
    return Proof(
        abs(prose.value - implied) > prose.half_unit + room,
        f"{prose.value:.5f}",
        f"{implied:.5f}",
        f"Table 3's t_f = {time.value:.4f} implies {implied:.5f} (give or take {room:.0e}); "
        f"its own mass is {table:.4f}, the prose says {prose.value:.5f}",
        correct=implied,
    )


def mass_of_n4_prose(grounds: Grounds) -> Proof:
    """The prose's mass for N = 4 against the time of the same case."""
    return _mass_of_single(grounds, 4)


def mass_of_n6_prose(grounds: Grounds) -> Proof:
    """The prose's mass for N = 6 against the time of the same case."""
    return _mass_of_single(grounds, 6)


def effect_of_degree(grounds: Grounds) -> Proof:
    """The spread of the final time over the degrees, from Table 4 and from converged runs."""
    name = "section-3-4-1/effect-of-degree-on-terminal-time/direct-multiple-shooting"
    printed = grounds.ledger.value(name).value
    times = printed_cases(grounds.ledger, "Table 4")["terminal time"].groupby("intervals")
    own = 100 * (times.max() - times.min()) / times.min()
    ours = degree_spread(read_cases(grounds.results), "converged")
    if ours.isna().any():
        raise LookupError("a case that did not converge")
    listed = ", ".join(f"K = {k}: {value:.4f} %" for k, value in own.items())
    return Proof(
        own.max() > 2 * printed,
        f"{printed} %",
        f"up to {own.max():.3f} % in Table 4, {ours.max():.3f} % converged",
        f"Table 4's own spread over N is {listed}",
        correct=float(own.max()),
    )


def mass_increase(grounds: Grounds) -> Proof:
    """The sign of the mass change from the indirect method to one polynomial of degree 6."""
    direct = grounds.ledger.value("section-3-5/terminal-mass/direct-shooting-n-6").value
    best = _best_mass(grounds)
    change = 100 * (direct - best) / best
    return Proof(
        change < -0.5,
        "an increase of 1 %",
        f"a change of {change:+.2f} %",
        f"The mass goes from {best:.4f} to {direct:.4f}: it falls",
    )


def time_of_n4_prose(grounds: Grounds) -> Proof:
    """The elapsed time of N = 4 in the prose is that of N = 5."""
    prose = printed_cases(grounds.ledger, "Section 3.3")["elapsed time"]
    table = printed_cases(grounds.ledger, "Table 3")["sim time"]
    four, five = ("direct", 4, 1), ("direct", 5, 1)
    return Proof(
        prose[four] == prose[five] and prose[four] != table[four],
        f"{prose[four]} s",
        f"{table[four]} s (Table 3)",
        f"The prose gives {prose[four]} s for N = 4 and for N = 5; Table 3 has "
        f"{table[four]} s and {table[five]} s",
        correct=float(table[four]),
    )


def increase_in_time(grounds: Grounds) -> Proof:
    """The relative increase in execution time from N = 2 to N = 6 at K = 2."""
    table = printed_cases(grounds.ledger, "Table 4")["sim time"]
    low, high = table["direct", 2, 2], table["direct", 6, 2]
    name = "section-3-4-1/increase-in-computation-time-n-2-to-n-6/k-2"
    printed = grounds.ledger.value(name)
    own = 100 * (high / low - 1)
    return Proof(
        not printed.matches(own),
        f"{printed.value} %",
        f"{own:.1f} %",
        f"{high} s against {low} s is an increase of {own:.1f} %",
        correct=float(own),
    )


def prose_against_table_4(grounds: Grounds) -> Proof:
    """Cells of Section 3.4's prose that Table 4 contradicts beyond rounding and cutting off."""
    cells = contradictions(grounds.ledger, "Section 3.4", "Table 4", {"elapsed time": "sim time"})
    counts = cells["quantity"].value_counts(sort=False)
    listed = ", ".join(f"{name}: {count}" for name, count in counts.items())
    return Proof(
        len(cells) > 0,
        f"{len(cells)} cells differ",
        "two different runs were written up",
        f"Cells that differ by more than a unit of the last printed digit: {listed}",
    )


def nesting(grounds: Grounds) -> Proof:
    """For fixed K the final time cannot rise with N: a polynomial of degree N is one of N + 1."""
    printed = (
        printed_cases(grounds.ledger, "Table 4")["terminal time"]
        .droplevel("method")
        .unstack("intervals")
    )
    cases = read_cases(grounds.results)
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
        len(rises) > 0 and ours_rise == 0,
        f"{len(rises)} rises",
        f"{ours_rise} rises in the converged grid",
        "Printed final times that rise with N: " + "; ".join(rises),
    )


def optimal_choice(grounds: Grounds) -> Proof:
    """The case with the smallest printed final time."""
    times = printed_cases(grounds.ledger, "Table 4")["terminal time"].droplevel("method")
    degree, intervals = times.index[int(times.argmin())]
    ours = final_times(read_cases(grounds.results), "converged")
    if ours.empty:
        raise LookupError("no case that converged")
    best, most = ours.index[int(ours.argmin())]
    return Proof(
        (degree, intervals) != (6, 16),
        f"N = 6, K = 16 ({times[6, 16]:.5f})",
        f"N = {degree}, K = {intervals} ({times.min():.5f})",
        f"By printed numbers alone: Table 4's smallest t_f is {times.min():.5f}, at N = {degree}, "
        f"K = {intervals}. For the problem itself the converged grid chooses N = {best}, "
        f"K = {most}",
        correct=f"N = {degree} with K = {intervals} in the document's own table",
    )


def cheapest_choice(grounds: Grounds) -> Proof:
    """The case with the fewest printed seconds, which also flies shorter than the one chosen."""
    table = printed_cases(grounds.ledger, "Table 4").droplevel("method")
    seconds, times = table["sim time"], table["terminal time"]
    degree, intervals = seconds.index[int(seconds.argmin())]
    prose = printed_cases(grounds.ledger, "Section 3.4").droplevel("method")["elapsed time"]
    return Proof(
        seconds.min() < seconds[2, 2] and times[degree, intervals] < times[2, 2],
        f"N = 2, K = 2 ({seconds[2, 2]} s, t_f = {times[2, 2]})",
        f"N = {degree}, K = {intervals} ({seconds.min()} s, t_f = {times[degree, intervals]})",
        f"By printed numbers alone: in Table 4, whose seconds the section quotes, N = {degree} "
        f"with K = {intervals} is both faster and better. In the run that Section 3.4's prose "
        f"describes it takes {prose[degree, intervals]:.4f} s, and the choice is right",
        correct=f"N = {degree} with K = {intervals} in the document's own table",
    )


def one_argument_atan2(grounds: Grounds) -> Proof:
    """The thrust angle from the quotient of the costates, which has lost their signs."""
    flown = grounds.rows("indirect.parquet", intervals=1)
    quotient = np.arctan(flown["lambda_vr"] / flown["lambda_vtheta"])
    pair = np.arctan2(flown["lambda_vr"], flown["lambda_vtheta"])
    rate = flown["lambda_vr"] * np.sin(quotient) + flown["lambda_vtheta"] * np.cos(quotient)
    wrong = 100 * float((rate < 0).mean())
    error = float(np.degrees(np.max(np.abs(np.angle(np.exp(1j * (quotient - pair)))))))
    return Proof(
        wrong > 0.0,
        f"up to {error:.0f} deg off",
        "the angle that the listings compute",
        f"Along the extremal the quotient's angle points against the primer vector for "
        f"{wrong:.0f} % of the flight; Listing 3 has two arguments",
    )


def lagrange_gravity(grounds: Grounds[Configuration]) -> Proof:
    """The gravity term of Lagrange's equation, by differentiating the printed Lagrangian."""
    r, rate, mu = ca.SX.sym("r"), ca.SX.sym("rate"), grounds.section.problem.mu
    lagrangian = 0.5 * rate**2 * r**2 + mu / r
    derivative = ca.Function("d", [r, rate], [ca.gradient(lagrangian, r)])
    radius = grounds.section.problem.final_radius
    force = float(derivative(radius, 0.0))
    return Proof(
        np.isclose(force, -mu / radius**2) and not np.isclose(force, -mu / radius),
        f"-mu / r = {-mu / radius:.6f} at r = {radius}",
        f"-mu / r^2 = {-mu / radius**2:.6f}",
        f"Differentiating equation 16 by r gives {force:.6f}",
    )


def generalised_force(grounds: Grounds[Configuration]) -> Proof:
    """The generalised force of theta needs the derivative of the position by theta."""
    angle, radius, beta = 0.7, grounds.section.problem.final_radius, 0.4
    u_r = np.array([np.cos(angle), np.sin(angle)])
    u_theta = np.array([-np.sin(angle), np.cos(angle)])
    force = np.cos(beta) * u_theta + np.sin(beta) * u_r
    step = 1e-6
    ahead = radius * np.array([np.cos(angle + step), np.sin(angle + step)])
    by_theta = float(force @ (ahead - radius * u_r) / step)
    by_radius = float(force @ u_r)
    return Proof(
        np.isclose(by_theta, radius * np.cos(beta), atol=1e-5)
        and not np.isclose(by_radius, radius * np.cos(beta), atol=1e-5),
        f"derivative by r: {by_radius:.6f} T",
        f"derivative by theta: {by_theta:.6f} T",
        f"Equation 18's result T r cos(beta) = {radius * np.cos(beta):.6f} T at an arbitrary "
        "angle follows from the derivative by theta alone",
    )


def hamiltonian_exhaust(grounds: Grounds[Configuration]) -> Proof:
    """The Hamiltonian vanishes along the extremal with v_e in the mass term, not with v_theta."""
    flown = grounds.rows("indirect.parquet", intervals=1)
    problem = TransferProblem.of(grounds.section.problem)
    correct = flown["hamiltonian"].abs().max()
    mass_term = flown["lambda_m"] * problem.thrust
    wrong = (
        (flown["hamiltonian"] + mass_term / problem.exhaust_speed - mass_term / flown["v_theta"])
        .abs()
        .max()
    )
    return Proof(
        correct < 1e-8 and wrong > 1e-3,
        f"largest H = {wrong:.3f}",
        f"largest H = {correct:.1e}",
        "Along the extremal H must vanish: with -T / v_e in the mass term it does to "
        f"{correct:.0e}, with the printed v_theta it reaches {wrong:.3f}",
    )
