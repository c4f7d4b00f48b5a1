"""Predicates that compare printed numbers with each other alone; each verdict says so."""

import numpy as np
import pandas as pd

from smallsat.evidence.claims import Judgement, judged
from smallsat.evidence.grounds import Grounds
from smallsat.studies.transfer.evidence.printed_cases import printed_cases

# What "almost linear" and "almost quadratic" are taken to mean: the growth of the seconds with
# twice the intervals, and the power of K with which they grow.
LINEAR_GROWTH = 2.5
QUADRATIC_POWERS = (1.5, 2.6)
# Per cent of a final time that counts as a small difference.
SMALL = 0.1


def of_print(condition: bool | np.bool, evidence: str) -> Judgement:
    """A claim that printed numbers decide without any of ours."""
    return judged(condition, f"by printed numbers alone: {evidence}")


def _grid(grounds: Grounds, quantity: str) -> pd.DataFrame:
    """A column of Table 4, degrees by numbers of intervals."""
    column = printed_cases(grounds.ledger, "Table 4")[quantity]
    return column.droplevel("method").unstack("intervals")


def _multiple(grounds: Grounds, quantity: str) -> pd.Series:
    """A column of Table 2, by the number of intervals."""
    return printed_cases(grounds.ledger, "Table 2")[quantity].droplevel(["method", "degree"])


def _single(grounds: Grounds, quantity: str) -> pd.Series:
    """A column of Table 3, by the degree."""
    return printed_cases(grounds.ledger, "Table 3")[quantity].droplevel(["method", "intervals"])


def _indirect(grounds: Grounds, quantity: str) -> float:
    """The one row of Table 1."""
    return float(printed_cases(grounds.ledger, "Table 1")[quantity].iloc[0])


def _prose(grounds: Grounds, quantity: str, degree: int) -> pd.Series:
    """What Section 3.4's prose gives for a degree, by the number of intervals."""
    column = printed_cases(grounds.ledger, "Section 3.4")[quantity]
    return column.xs(("direct", degree), level=("method", "degree"))


def _listed(values: pd.Series, name: str, form: str = "g") -> str:
    return ", ".join(f"{name} = {index}: {value:{form}}" for index, value in values.items())


def seconds_rise_with_intervals(grounds: Grounds) -> Judgement:
    """Every doubling of K costs indirect multiple shooting more seconds."""
    seconds = _multiple(grounds, "sim time")
    return of_print((seconds.diff().iloc[1:] > 0).all(), f"seconds, {_listed(seconds, 'K')}")


def no_benefit_over_single(grounds: Grounds) -> Judgement:
    """Indirect multiple shooting ends where single shooting does, and costs more."""
    seconds, times = _multiple(grounds, "sim time"), _multiple(grounds, "terminal time")
    time, cost = _indirect(grounds, "terminal time"), _indirect(grounds, "sim time")
    return of_print(
        (times == time).all() and (seconds > cost).all(),
        f"t_f = {time} in Tables 1 and 2; {seconds.min()} to {seconds.max()} s against {cost} s",
    )


def indirect_growth_linear(grounds: Grounds) -> Judgement:
    """The seconds of indirect multiple shooting grow almost linearly with K."""
    seconds = _multiple(grounds, "sim time")
    ratios = (seconds / seconds.shift()).dropna()
    return of_print(
        (ratios < LINEAR_GROWTH).all(), f"growth by doubling to {_listed(ratios, 'K', '.1f')}"
    )


def direct_growth_quadratic(grounds: Grounds) -> Judgement:
    """The seconds of direct multiple shooting grow almost quadratically with K."""
    seconds = _grid(grounds, "sim time")
    slopes = [np.polyfit(np.log(seconds.columns), np.log(row), 1)[0] for row in seconds.to_numpy()]
    low, high = QUADRATIC_POWERS
    return of_print(
        min(slopes) > low and max(slopes) < high,
        f"seconds grow as K to the power {min(slopes):.2f} to {max(slopes):.2f}",
    )


def lowest_degree_faster_than_indirect(grounds: Grounds) -> Judgement:
    """One polynomial of the lowest degree takes fewer seconds than indirect shooting."""
    direct, indirect = _single(grounds, "sim time"), _indirect(grounds, "sim time")
    return of_print(direct.iloc[0] < indirect, f"{direct.iloc[0]} s against {indirect} s")


def highest_degree_dearest_and_best(grounds: Grounds) -> Judgement:
    """Of single polynomials the highest degree costs most and leaves most mass."""
    seconds, masses = _single(grounds, "sim time"), _single(grounds, "terminal mass")
    degree = masses.index[-1]
    return of_print(
        seconds.idxmax() == masses.idxmax() == degree,
        f"seconds, {_listed(seconds, 'N')}; mass, {_listed(masses, 'N')}",
    )


def four_intervals_near_and_dearer(grounds: Grounds) -> Judgement:
    """Degree 2 in four intervals is close to the indirect optimum, and costs more than it."""
    time, best = _grid(grounds, "terminal time").T[2][4], _indirect(grounds, "terminal time")
    seconds = _grid(grounds, "sim time").T[2][4]
    indirect = max(_indirect(grounds, "sim time"), _multiple(grounds, "sim time")[4])
    excess = 100 * (time / best - 1)
    return of_print(
        excess < SMALL and seconds > indirect,
        f"t_f is {excess:.3f} % above the indirect one; {seconds} s against {indirect} s",
    )


def no_gain_for_degree_2(grounds: Grounds) -> Judgement:
    """For degree 2, intervals beyond four cost seconds and do not improve the prose's digits."""
    return _no_gain(grounds, 2, 4)


def no_gain_for_degree_3(grounds: Grounds) -> Judgement:
    """For degree 3, more intervals cost seconds and do not improve the prose's digits."""
    return _no_gain(grounds, 3, 2)


def _no_gain(grounds: Grounds, degree: int, first: int) -> Judgement:
    times = _prose(grounds, "terminal time", degree).loc[first:]
    seconds = _prose(grounds, "elapsed time", degree).loc[first:]
    table = _grid(grounds, "terminal time").T[degree].loc[first:]
    fall = 100 * (table.iloc[0] / table.iloc[-1] - 1)
    return of_print(
        times.nunique() == 1 and (seconds.diff().iloc[1:] > 0).all(),
        f"t_f in the prose, {_listed(times, 'K')}; seconds, {_listed(seconds, 'K')}; Table 4 falls "
        f"by {fall:.4f} % in all. The problem itself has more to gain, which is another claim",
    )


def cost_rises_with_degree_in_two_intervals(grounds: Grounds) -> Judgement:
    """In two intervals the seconds seem to rise with the degree."""
    prose = printed_cases(grounds.ledger, "Section 3.4")["elapsed time"].xs(2, level="intervals")
    prose = prose.droplevel("method")
    table = _grid(grounds, "sim time")[2]
    falls = int((table.diff().iloc[1:] < 0).sum())
    return of_print(
        (prose.diff().iloc[1:] > 0).all(),
        f"seconds of the run that the prose describes, {_listed(prose, 'N')}; in Table 4's run "
        f"they fall at {falls} of {len(table) - 1} degrees, {_listed(table, 'N')}",
    )


def multiple_better_than_single(grounds: Grounds) -> Judgement:
    """Every case of direct multiple shooting flies shorter than every single polynomial."""
    multiple, single = _grid(grounds, "terminal time"), _single(grounds, "terminal time")
    worst = multiple.to_numpy().max()
    return of_print(
        worst < single.min(),
        f"t_f is {worst} at most in Table 4, {single.min()} at least in Table 3",
    )


def cost_rises_with_degree(grounds: Grounds) -> Judgement:
    """The highest degree costs more seconds than the lowest for every number of intervals."""
    seconds = _grid(grounds, "sim time")
    rise = 100 * (seconds.iloc[-1] / seconds.iloc[0] - 1)
    falls = int((seconds.diff().iloc[1:] < 0).to_numpy().sum())
    return of_print(
        (rise > 0).all(),
        f"per cent more from N = {seconds.index[0]} to {seconds.index[-1]}, "
        f"{_listed(rise, 'K', '.0f')}; on the way the seconds fall {falls} times",
    )


def intervals_amplify_cost_of_degree(grounds: Grounds) -> Judgement:
    """What a higher degree costs in seconds grows with the number of intervals."""
    seconds = _grid(grounds, "sim time")
    more = seconds.iloc[-1] - seconds.iloc[0]
    relative = 100 * more / seconds.iloc[0]
    return of_print(
        (more.diff().iloc[1:] > 0).all() and relative.iloc[-1] > relative.iloc[0],
        f"from the lowest to the highest degree, seconds more, {_listed(more, 'K', '.1f')}; "
        f"per cent more, {_listed(relative, 'K', '.0f')}",
    )


def low_degree_more_efficient(grounds: Grounds) -> Judgement:
    """Degree 2 costs fewer seconds than degree 6 and flies hardly longer, for each K."""
    seconds, times = _grid(grounds, "sim time").T, _grid(grounds, "terminal time").T
    share, longer = seconds[2] / seconds[6], 100 * (times[2] / times[6] - 1)
    return of_print(
        (share < 1).all() and (longer < SMALL).all(),
        f"share of degree 6's seconds, {_listed(share, 'K', '.2f')}; "
        f"per cent longer flight, {_listed(longer, 'K', '.3f')}",
    )


def indirect_best_overall(grounds: Grounds) -> Judgement:
    """No method that flies as short as indirect shooting is as fast."""
    time, seconds = _indirect(grounds, "terminal time"), _indirect(grounds, "sim time")
    times = [*_multiple(grounds, "terminal time"), *_single(grounds, "terminal time")]
    times += [*_grid(grounds, "terminal time").to_numpy().ravel()]
    others = [*_multiple(grounds, "sim time"), *_single(grounds, "sim time")]
    others += [*_grid(grounds, "sim time").to_numpy().ravel()]
    as_short = [cost for other, cost in zip(times, others, strict=True) if other <= time]
    return of_print(
        min(times) >= time and min(as_short, default=np.inf) > seconds,
        f"t_f = {time} in {seconds} s; {len(as_short)} others fly as short, the fastest in "
        f"{min(as_short, default=np.nan)} s",
    )


def lowest_degree_fastest(grounds: Grounds) -> Judgement:
    """One polynomial of degree 2 takes fewer seconds than any other case."""
    single = _single(grounds, "sim time")
    others = [*_multiple(grounds, "sim time"), *_grid(grounds, "sim time").to_numpy().ravel()]
    fastest = min([*others, *single.iloc[1:], _indirect(grounds, "sim time")])
    return of_print(single.iloc[0] < fastest, f"{single.iloc[0]} s; the next takes {fastest} s")


def slowest_single_beats_most_multiple(grounds: Grounds) -> Judgement:
    """The slowest single polynomial is faster than most cases of indirect multiple shooting."""
    slowest, multiple = _single(grounds, "sim time").max(), _multiple(grounds, "sim time")
    beaten = int((multiple > slowest).sum())
    return of_print(
        beaten > len(multiple) / 2, f"{slowest} s is less than {beaten} of {len(multiple)} take"
    )


def all_near_baseline(grounds: Grounds) -> Judgement:
    """All cases of direct multiple shooting are close to indirect shooting."""
    excess = 100 * (_grid(grounds, "terminal time") / _indirect(grounds, "terminal time") - 1)
    values = excess.to_numpy()
    return of_print(
        (values < SMALL).all(),
        f"t_f of {values.size} cases is {values.min():.3f} to {values.max():.3f} % above",
    )


def masses_coincide(grounds: Grounds) -> Judgement:
    """In Figure 69 all but the single polynomials lie on top of one another."""
    best = _indirect(grounds, "terminal mass")
    gaps = (_grid(grounds, "terminal mass") - best).abs().to_numpy().max()
    nearest = best - _single(grounds, "terminal mass").max()
    return of_print(
        gaps < nearest / 10,
        f"final masses differ by {gaps:.5f} at most, and from those of single polynomials by "
        f"{nearest:.4f} at least",
    )


def indirect_on_top(grounds: Grounds) -> Judgement:
    """In Figure 70 both indirect methods lie above all cases of direct multiple shooting."""
    indirect = [_indirect(grounds, "terminal time"), *_multiple(grounds, "terminal time")]
    direct = _grid(grounds, "terminal time").to_numpy()
    masses = _grid(grounds, "terminal mass").to_numpy()
    above = int((masses > _indirect(grounds, "terminal mass")).sum())
    return of_print(
        direct.min() > max(indirect),
        f"t_f is {direct.min()} at least against {max(indirect)}, and the mass follows from it; of "
        f"the printed masses {above} lies above, which is an erratum",
    )


def direct_multiple_least_efficient(grounds: Grounds) -> Judgement:
    """Direct multiple shooting takes more seconds than any other method."""
    direct, multiple = _grid(grounds, "sim time"), _multiple(grounds, "sim time")
    single = max(_single(grounds, "sim time").max(), _indirect(grounds, "sim time"))
    least = direct.min()
    return of_print(
        (least > multiple).all() and least.min() > single,
        f"least seconds, {_listed(least, 'K')}; indirect multiple shooting, "
        f"{_listed(multiple, 'K')}; single shooting takes {single} s at most",
    )


def indirect_multiple_faster_for_every_degree(grounds: Grounds) -> Judgement:
    """For every degree and number of intervals indirect multiple shooting is faster."""
    ratios = _grid(grounds, "sim time") / _multiple(grounds, "sim time")
    values = ratios.to_numpy()
    return of_print(
        (values > 1).all(), f"direct takes {values.min():.1f} to {values.max():.1f} times as long"
    )


def closer_with_intervals(grounds: Grounds) -> Judgement:
    """In Table 4 more intervals come closer to the indirect optimum.

    A rise below the printed tolerance of the solver is none that the solver could tell.
    """
    times = _grid(grounds, "terminal time")
    tolerance = grounds.ledger.value("listing-10/fmincon-tolfun").value
    steps = times.diff(axis=1).iloc[:, 1:]
    rises = [
        f"N = {n}, to K = {k}: +{steps.loc[n, k]:.5f}"
        for n in steps.index
        for k in steps.columns
        if steps.loc[n, k] > 0
    ]
    return of_print(
        (times.iloc[:, -1] < times.iloc[:, 0]).all() and steps.to_numpy().max() < tolerance,
        f"t_f falls from the fewest to the most intervals for every N, and in "
        f"{steps.size - len(rises)} of {steps.size} doublings; it rises at "
        f"{'; '.join(rises) or 'none'}",
    )


def scales(grounds: Grounds) -> Judgement:
    """The indirect methods run on a time scale, the direct ones on tau."""
    spans = {
        listing: [grounds.ledger.value(f"{name}/{end}").value for end in ("min", "max")]
        for listing, name in (
            ("Listing 2", "listing-2/tspan-effective"),
            ("Listing 5", "listing-5/tau-grid"),
            ("Listing 7", "listing-7/tspan"),
            ("Listing 11", "listing-11/tau-grid"),
        )
    }
    tau = [-1.0, 1.0]
    listed = ", ".join(f"{name}: {low:g} to {high:g}" for name, (low, high) in spans.items())
    return of_print(
        spans["Listing 7"] == spans["Listing 11"] == tau
        and tau not in (spans["Listing 2"], spans["Listing 5"]),
        f"spans of integration, {listed}",
    )
