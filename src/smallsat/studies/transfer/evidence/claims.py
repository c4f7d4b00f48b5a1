"""Predicates for what the orbit-transfer document says in prose, on computed results."""

from typing import Any

import casadi as ca
import numpy as np
import pandas as pd

from smallsat.evidence.claims import Judgement, judged
from smallsat.evidence.grounds import Grounds
from smallsat.studies.transfer.configuration import Configuration
from smallsat.studies.transfer.evidence.observations import degree_spread
from smallsat.studies.transfer.evidence.printed_cases import printed_cases
from smallsat.studies.transfer.evidence.printed_claims import SMALL
from smallsat.studies.transfer.evidence.printed_stop import chance_of_hits
from smallsat.studies.transfer.model.problem import TransferProblem
from smallsat.studies.transfer.results import final_times, indirect_times, read_cases

# Conditions met to this are met, in an independent integration.
MET = 1e-9
# Share of random deals below which as many hits are no chance.
CHANCE = 1e-3
# Fractions of the flight at which controls are compared.
PLACES = np.linspace(-1.0, 1.0, 481)


def _indirect(grounds: Grounds):
    return indirect_times(read_cases(grounds.results))


def _grid(grounds: Grounds, run: str):
    """Final times of all cases of direct multiple shooting; a `LookupError` if one is missing."""
    cases = read_cases(grounds.results)
    times = final_times(cases, run)
    asked = cases[(cases["run"] == run) & (cases["intervals"] > 1) & (cases["method"] == "direct")]
    if len(times) < len(asked) or times.empty:
        raise LookupError(f"a case of the {run} run that did not converge")
    return times


def same_extremal(grounds: Grounds) -> Judgement:
    """Multiple shooting ends at the solution of single shooting."""
    times = _indirect(grounds)
    spread = float(times.max() - times.min())
    return judged(spread < 1e-9, f"t_f over all K differs by {spread:.1e}")


def shortest(grounds: Grounds) -> Judgement:
    """No case beats the indirect methods."""
    cases = read_cases(grounds.results)
    feasible = cases[(cases["residual"] < MET) & (cases["method"] == "direct")]
    if feasible.empty:
        raise LookupError("no feasible direct solution")
    margin = float(feasible["final_time"].min() - _indirect(grounds).min())
    return judged(
        margin > -1e-9,
        f"the best of {len(feasible)} feasible direct solutions is {margin:.1e} slower",
    )


def solves_easily(grounds: Grounds) -> Judgement:
    """Indirect shooting solves the problem from the document's guess, accurately and fast."""
    row = grounds.rows("indirect.csv", intervals=1, converged=True).iloc[0]
    ledger, name = grounds.ledger, "indirect-shooting"
    time = ledger.value(f"table-1/terminal-time/{name}")
    seconds = ledger.value(f"table-1/sim-time/{name}").value
    bound = "section-3-5/execution-time-bound/indirect-and-direct-shooting"
    return judged(
        row["status"] == "residual vanished"
        and row["residual"] < MET
        and time.matches(row["final_time"])
        and seconds < ledger.value(bound).value,
        f"from the document's guess it ends at the printed t_f = {time.value}, its conditions met "
        f"to {row['residual']:.0e} in another integrator; printed seconds: {seconds}",
    )


def small_node_errors(grounds: Grounds) -> Judgement:
    """The errors at the interval ends of indirect multiple shooting are minuscule."""
    table = grounds.table("indirect.csv")
    rows = table[(table["intervals"] > 1) & table["converged"]]
    if rows.empty:
        raise LookupError("no solution of indirect multiple shooting")
    worst = float(rows["residual"].max())
    return judged(
        worst < MET,
        f"flown through without resetting a node, the conditions at the end are met to {worst:.0e}",
    )


def continuous_control(grounds: Grounds) -> Judgement:
    """The control of the indirect methods does not jump at interval ends."""
    flown = grounds.table("indirect.parquet")
    jumps = []
    for _, group in flown[flown["intervals"] > 1].groupby("intervals"):
        first = group.groupby("segment")["beta"].first().to_numpy()[1:]
        last = group.groupby("segment")["beta"].last().to_numpy()[:-1]
        jumps.append(np.max(np.abs(np.angle(np.exp(1j * (first - last))))))
    if not jumps:
        raise LookupError("no solution of indirect multiple shooting")
    return judged(max(jumps) < 1e-8, f"largest jump at an interval end {max(jumps):.1e} rad")


def gain_from_intervals(grounds: Grounds) -> Judgement:
    """For degree 2 the problem itself has nothing to gain from more intervals."""
    times = _grid(grounds, "converged").loc[2]
    if len(times) < 2:
        raise LookupError("fewer than two numbers of intervals")
    gaps = times - _indirect(grounds).min()
    falling = bool((times.diff().iloc[1:] < -1e-9).all())
    listed = ", ".join(f"K = {k}: {gap:.1e}" for k, gap in gaps.items())
    return judged(not falling, f"converged distance to the optimum for N = 2: {listed}")


def degree_negligible(grounds: Grounds) -> Judgement:
    """The degree hardly matters for the final time of multiple shooting."""
    if _grid(grounds, "converged").index.get_level_values("degree").nunique() < 2:
        raise LookupError("fewer than two degrees")
    spread = degree_spread(read_cases(grounds.results), "converged")
    listed = ", ".join(f"K = {k}: {value:.4f} %" for k, value in spread.items())
    name = "section-3-4-1/effect-of-degree-on-terminal-time/direct-multiple-shooting"
    return judged(
        (spread < SMALL).all(),
        f"converged spread over N, {listed}: below a tenth of a per cent, but many times the "
        f"{grounds.ledger.literal(name)} % that the text names",
    )


def closer_with_intervals(grounds: Grounds) -> Judgement:
    """More intervals come closer to the indirect optimum."""
    times = _grid(grounds, "converged").unstack("intervals")
    steps = times.diff(axis=1).iloc[:, 1:]
    if not steps.size:
        raise LookupError("fewer than two numbers of intervals")
    return judged(
        (steps < 0).to_numpy().all(),
        f"t_f falls in {int((steps < 0).to_numpy().sum())} of {steps.size} doublings of K",
    )


def single_polynomial_cost(grounds: Grounds) -> Judgement:
    """The document's solution with one polynomial of degree 6 flies 3.5 % longer."""
    times = _single_times(grounds, "as published")
    excess = 100 * (times[6] / float(_indirect(grounds).min()) - 1)
    name = "section-3-5/terminal-time-increase-over-indirect/direct-shooting-n-6"
    best = 100 * (_single_times(grounds, "converged")[6] / float(_indirect(grounds).min()) - 1)
    return judged(
        grounds.ledger.value(name).matches(excess),
        f"{excess:.2f} % from the document's guess; the best of many starts, another minimum, "
        f"flies {best:.2f} % longer",
    )


def single_polynomial_short_of_optimum(grounds: Grounds) -> Judgement:
    """One polynomial does not reach the optimum, whatever its degree."""
    times, best = _single_times(grounds, "converged"), float(_indirect(grounds).min())
    excess = {degree: 100 * (time / best - 1) for degree, time in times.items()}
    worst = 100 * (float(_grid(grounds, "converged").max()) / best - 1)
    listed = ", ".join(f"N = {degree}: {value:.2f} %" for degree, value in excess.items())
    return judged(
        min(excess.values()) > worst,
        f"the best of many starts flies longer than the optimum by {listed}; the worst case of "
        f"multiple shooting by {worst:.2f} %",
    )


def _single_times(grounds: Grounds, run: str) -> dict[int, float]:
    cases = read_cases(grounds.results)
    rows = cases[(cases["intervals"] == 1) & (cases["run"] == run) & (cases["method"] == "direct")]
    rows = rows.dropna(subset=["final_time"])
    return dict(zip(rows["degree"], rows["final_time"], strict=True))


def direct_worse_than_indirect(grounds: Grounds) -> Judgement:
    """Both indirect methods give a better solution than direct multiple shooting."""
    gap = _grid(grounds, "converged") - _indirect(grounds).min()
    free = _grid(grounds, "unbounded") - _indirect(grounds).min()
    return judged(
        (gap > 0).all(),
        f"within the printed bounds direct cases are {gap.min():.1e} to {gap.max():.1e} slower, "
        f"without them {free.min():.1e} to {free.max():.1e}",
    )


def gap_from_parameterisation(grounds: Grounds) -> Judgement:
    """Most of what the printed direct cases miss is due to the parameterisation of the control."""
    optimum = _indirect(grounds).min()
    printed = printed_cases(grounds.ledger, "Table 4")["terminal time"].droplevel("method")
    share = ((_grid(grounds, "converged") - optimum) / (printed - optimum)).dropna()
    most = int((share > 0.5).sum())
    return judged(
        most > len(share) / 2,
        f"the best solution with the same polynomials and bounds leaves more than half of the "
        f"printed distance to the optimum in {most} of {len(share)} cases; the rest is the stop "
        f"before the end",
    )


def continuity_helps(grounds: Grounds) -> Judgement:
    """With a continuous control direct multiple shooting may achieve the optimum."""
    times = _grid(grounds, "continuous")
    loss = times - _grid(grounds, "unbounded")
    printed = grounds.ledger.value("table-1/terminal-time/indirect-shooting")
    reached = [f"N = {n}, K = {k}" for (n, k), time in times.items() if printed.matches(time)]
    return judged(
        bool(reached),
        f"continuous controls reach the printed t_f = {printed.value} at "
        f"{'; '.join(reached) or 'no case'}. Not by continuity, a constraint more, which costs "
        f" {loss.min():.1e} to {loss.max():.1e} in t_f",
    )


def bounds_help(grounds: Grounds) -> Judgement:
    """Wider coefficient bounds improve the cases with most intervals."""
    tight = _within_bounds(grounds, "final_time")
    most = int(grounds.table("tighter_bounds.csv")["intervals"].max())
    opened = _grid(grounds, "converged").xs(most, level="intervals")
    gain = tight.sub(opened, axis=0)
    listed = "; ".join(
        f"{bound:g}: {tight[bound].min():.5f} to {tight[bound].max():.5f}" for bound in tight
    )
    return judged(
        (gain > 1e-9).to_numpy().all(),
        f"t_f over N at K = {most} within bounds of ours, for the first ones are not printed, "
        f"{listed}; within the printed ones {opened.min():.5f} to {opened.max():.5f}",
    )


def bounds_cut_cost(grounds: Grounds) -> Judgement:
    """Wider coefficient bounds also cut the cost of the solve."""
    tight = _within_bounds(grounds, "iterations").iloc[:, 0]
    table = grounds.table("converged.csv")
    rows = table[table["intervals"] == table["intervals"].max()]
    opened = rows.set_index("degree")["iterations"]
    return judged(
        (opened < tight).all(),
        f"iterations of an interior-point method of ours, N = {opened.index[0]} to "
        f"{opened.index[-1]}: {_series(tight)} in the tightest bounds of ours, "
        f"{_series(opened)} in the printed ones",
    )


def _within_bounds(grounds: Grounds, column: str) -> pd.DataFrame:
    """A column of the runs in tighter bounds, degrees by bounds."""
    table = grounds.table("tighter_bounds.csv")
    if not table["converged"].all():
        raise LookupError("a case in tighter bounds that did not converge")
    table["bound"] = table["run"].str.removeprefix("bounds ").astype(float)
    return table.pivot(index="degree", columns="bound", values=column)


def _series(values: pd.Series) -> str:
    return ", ".join(f"{value:g}" for value in values)


def early_stopping(grounds: Grounds[Configuration]) -> Judgement:
    """Our inference: Table 4 holds iterates of an SQP method at the printed tolerance."""
    table = grounds.rows("printed-stop.csv")
    chance = chance_of_hits(table, grounds.section.numerics.seed)
    tolerance = grounds.ledger.literal("listing-10/fmincon-tolfun")
    return Judgement(
        "holds" if chance.share < CHANCE else "undecided",
        f"stopped at the printed tolerance of {tolerance}, {chance.hits} of {len(table)} cases "
        f"equal the printed value to its last digit; with the degrees' values dealt at random "
        f"{chance.mean:.2f} do on the average and {chance.most} at most; an inference, not a proof",
    )


def objectives_agree(grounds: Grounds[Configuration]) -> Judgement:
    """Least time, most final mass and least fuel are one objective."""
    problem = TransferProblem.of(grounds.section.problem)
    cases = read_cases(grounds.results).dropna(subset=["final_time", "final_mass"])
    if cases.empty:
        raise LookupError("no case was flown")
    implied = cases["final_time"].map(problem.final_mass)
    error = float((cases["final_mass"] - implied).abs().max())
    return judged(
        error < MET and problem.final_mass(1.0) < problem.initial_mass,
        f"in {len(cases)} flights the integrated final mass falls with t_f on one straight "
        f"line, to {error:.0e}",
    )


def newton_and_lagrange_agree(grounds: Grounds[Configuration]) -> Judgement:
    """Lagrange's equations give the accelerations that Newton's law gives."""
    problem = TransferProblem.of(grounds.section.problem)
    mass = problem.initial_mass
    r, theta, v_r, v_theta, beta = (ca.SX.sym(name) for name in ("r", "t", "vr", "vt", "b"))
    q, rate = ca.vertcat(r, theta), ca.vertcat(v_r, v_theta / r)
    rates = ca.SX.sym("rates", 2)
    # Equation 16, and the generalised forces of equations 17 and 18.
    lagrangian = mass / 2 * (rates[0] ** 2 + rates[1] ** 2 * r**2) + mass * problem.mu / r
    force = problem.thrust * ca.vertcat(ca.sin(beta), r * ca.cos(beta))
    momentum = ca.gradient(lagrangian, rates)
    right = force + ca.gradient(lagrangian, q) - ca.jacobian(momentum, q) @ rates
    lagrange = ca.substitute(ca.solve(ca.jacobian(momentum, rates), right), rates, rate)
    state: list[Any] = [r, theta, v_r, v_theta, mass]
    newton = problem.state_rate(state, ca.sin(beta), ca.cos(beta))
    # The speed across is r times the angular rate (equation 22).
    turning = (newton[3] - rate[1] * v_r) / r
    error = ca.vertcat(newton[2], turning) - lagrange
    function = ca.Function("error", [ca.vertcat(r, theta, v_r, v_theta, beta)], [error])
    places = np.random.default_rng(0).uniform(0.5, 2.0, (100, 5))
    largest = float(max(np.max(np.abs(function(place).full())) for place in places))
    return judged(
        largest < 1e-12,
        f"the accelerations of equations 16 to 18 and of 10 and 11 differ by {largest:.0e} at most "
        f"in {len(places)} states",
    )


def two_intervals_nearer(grounds: Grounds) -> Judgement:
    """Degree 2 in two intervals is nearer to the indirect control than any single polynomial."""
    best = _control(grounds.rows("indirect.parquet", intervals=1))
    flown = grounds.rows("as-published.parquet")
    distance = {
        key: _distance(_control(path), best)
        for key, path in flown[flown["intervals"] <= 2].groupby(["degree", "intervals"])
    }
    two = distance.pop((2, 2), None)
    single = {degree: value for (degree, count), value in distance.items() if count == 1}
    if two is None or not single:
        raise LookupError("a case that was not flown")
    listed = ", ".join(f"N = {degree}: {value:.0f}" for degree, value in single.items())
    return judged(
        two < min(single.values()),
        f"root mean square of the angle between controls: {two:.0f} deg; single polynomials, "
        f"{listed} deg",
    )


def controls_alike(grounds: Grounds) -> Judgement:
    """For a number of intervals the optimal controls of all degrees look alike.

    Taken to mean that any two of them are nearer to each other than a single polynomial's is to
    the control that it approximates.
    """
    best = _control(grounds.rows("indirect.parquet", intervals=1))
    singles = grounds.rows("as-published.parquet", intervals=1).groupby("degree")
    nearest = min(_distance(_control(path), best) for _, path in singles)
    apart = {}
    for intervals, group in grounds.rows("converged.parquet").groupby("intervals"):
        controls = [_control(path) for _, path in group.groupby("degree")]
        apart[intervals] = max(_distance(one, other) for one in controls for other in controls)
    listed = ", ".join(f"K = {k}: {value:.1f}" for k, value in apart.items())
    return judged(
        max(apart.values()) < nearest,
        f"root mean square of the angle between the controls of two degrees, {listed} deg at most; "
        f"the nearest single polynomial is {nearest:.0f} deg off",
    )


def _control(path: pd.DataFrame) -> np.ndarray:
    """Direction of the thrust at `PLACES`, as complex numbers."""
    return np.interp(PLACES, path["tau"], np.cos(path["beta"])) + 1j * np.interp(
        PLACES, path["tau"], np.sin(path["beta"])
    )


def _distance(one: np.ndarray, other: np.ndarray) -> float:
    """Root mean square angle between two controls, in degrees."""
    return float(np.degrees(np.sqrt(np.mean(np.angle(one * other.conj()) ** 2))))


def single_fails_on_long_flights(grounds: Grounds) -> Judgement:
    """Indirect shooting is not robust to a long integration, and may fail."""
    found, _ = _long_flights(grounds)
    single = found[1]
    return judged(
        single.iloc[-1] < single.iloc[0],
        f"guesses of the flight time from which single shooting ends at the optimum, "
        f"{_counted(single)}",
    )


def multiple_solves_long_flights(grounds: Grounds) -> Judgement:
    """On long flights indirect multiple shooting is the better choice, in smaller intervals."""
    found, length = _long_flights(grounds)
    longest, most = found.iloc[-1], found.columns[-1]
    listed = ", ".join(f"K = {k}: {count:g}" for k, count in longest.items())
    return judged(
        longest[most] > longest[1],
        f"on the longest flight, {length:.2f}, guesses of the flight time that lead to the "
        f"optimum, {listed}. Hypersensitive problems were not tried",
    )


def _long_flights(grounds: Grounds) -> tuple[pd.DataFrame, float]:
    """How many guesses lead to the optimum, by optimal final time and K; and the longest flight."""
    table = grounds.rows("long-flights.csv")
    table["found"] = table["final_time"].notna()
    found = table.groupby(["optimum", "intervals"])["found"].sum().unstack("intervals")
    if len(found) < 2 or 1 not in found or found.shape[1] < 2:
        raise LookupError("fewer than two flights or two numbers of intervals")
    return found, float(table["optimum"].max())


def _counted(counts: pd.Series) -> str:
    return ", ".join(f"t_f = {time:.2f}: {count:g}" for time, count in counts.items())
