"""Predicates for what the orbit-transfer document says in prose."""

import numpy as np

from smallsat.evidence.claims import Judgement, judged
from smallsat.evidence.grounds import Grounds
from smallsat.studies.transfer.evidence.observations import degree_spread
from smallsat.studies.transfer.evidence.printed_cases import printed_cases
from smallsat.studies.transfer.results import final_times, indirect_times, read_cases


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
    feasible = cases[(cases["residual"] < 1e-9) & (cases["method"] == "direct")]
    if feasible.empty:
        raise LookupError("no feasible direct solution")
    margin = float(feasible["final_time"].min() - _indirect(grounds).min())
    return judged(
        margin > -1e-9,
        f"the best of {len(feasible)} feasible direct solutions is {margin:.1e} slower",
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


def no_gain_from_intervals(grounds: Grounds) -> Judgement:
    """For degree 2 more intervals do not give a better solution."""
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
        (spread < 0.1).all(),
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


def indirect_growth_linear(grounds: Grounds) -> Judgement:
    """The printed seconds of indirect multiple shooting grow almost linearly with K."""
    seconds = printed_cases(grounds.ledger, "Table 2")["sim time"].droplevel(["method", "degree"])
    ratios = (seconds / seconds.shift()).dropna()
    listed = ", ".join(f"to K = {k}: x {ratio:.1f}" for k, ratio in ratios.to_dict().items())
    return judged((ratios < 2.5).all(), f"printed growth by doubling K, {listed}")


def direct_growth_quadratic(grounds: Grounds) -> Judgement:
    """The printed seconds of direct multiple shooting grow almost quadratically with K."""
    seconds = (
        printed_cases(grounds.ledger, "Table 4")["sim time"]
        .droplevel("method")
        .unstack("intervals")
    )
    slopes = [np.polyfit(np.log(seconds.columns), np.log(row), 1)[0] for row in seconds.to_numpy()]
    return judged(
        min(slopes) > 1.5 and max(slopes) < 2.6,
        f"printed seconds grow as K to the power {min(slopes):.2f} to {max(slopes):.2f}",
    )


def single_polynomial_cost(grounds: Grounds) -> Judgement:
    """One polynomial of degree 6 costs 3.5 % in time against the indirect optimum."""
    cases = read_cases(grounds.results)
    best = cases[(cases["intervals"] == 1) & (cases["run"] == "converged")].set_index("degree")
    time = float(best["final_time"].dropna().to_dict()[6])
    excess = 100 * (time / float(_indirect(grounds).min()) - 1)
    return judged(
        excess > 3.4,
        f"the printed solution is a local minimum: the best of many starts has "
        f"t_f = {time:.6f}, {excess:.2f} % above the optimum",
    )


def direct_worse_than_indirect(grounds: Grounds) -> Judgement:
    """Both indirect methods give a better solution than direct multiple shooting."""
    gap = _grid(grounds, "converged") - _indirect(grounds).min()
    return judged(
        (gap > 0).all(),
        f"converged direct cases are {gap.min():.1e} to {gap.max():.1e} slower",
    )


def continuity_helps(grounds: Grounds) -> Judgement:
    """A continuous control might reach the optimum in direct multiple shooting."""
    loss = _grid(grounds, "continuous") - _grid(grounds, "converged")
    return judged(
        (loss < 0).any(),
        f"continuity is a constraint more: it costs {loss.min():.1e} to {loss.max():.1e} in t_f",
    )


def bounds_help(grounds: Grounds) -> Judgement:
    """Wider coefficient bounds improve the cases with 16 intervals."""
    return Judgement(
        "undecided", "the tighter bounds of the first runs are not printed, so nothing to compare"
    )


def early_stopping(grounds: Grounds) -> Judgement:
    """Our inference: the printed Table 4 holds iterates of an SQP method stopped early."""
    table = grounds.rows("early-stopping.csv")
    rows = table.groupby(["degree", "intervals"])
    hits = int(rows["equal_to_printed"].any().sum())
    in_band = int(rows["in_printed_band"].any().sum())
    best = table.groupby("tolerance")["equal_to_printed"].sum()
    return Judgement(
        "holds" if in_band > len(rows) / 2 else "undecided",
        f"stopped at one of the looser tolerances, {in_band} of {len(rows)} cases land in the "
        f"printed band and {hits} equal a printed value to its last digit "
        f"({int(best.max())} of them at one tolerance); an inference, not a proof",
    )
