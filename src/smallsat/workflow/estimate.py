"""How long a build still takes, from what its jobs took before."""

from collections.abc import Collection, Mapping
from graphlib import TopologicalSorter
from statistics import median

# So many seconds are taken to have passed at the expected pace before a build begins, so that its
# first small jobs, which are slow on cold caches, do not set the pace of all the others.
_SETTLING_S = 60.0


def pace(expected: Mapping[str, float], seen: Mapping[str, float]) -> float:
    """How much longer than expected the jobs take that are done.

    Parameters
    ----------
    expected, seen
        Seconds by job, before and now; only jobs in both count.
    """
    both = expected.keys() & seen.keys()
    now, before = (sum(seconds[job] for job in both) for seconds in (seen, expected))
    return (now + _SETTLING_S) / (before + _SETTLING_S)


def seconds_left(
    waits: Mapping[str, Collection[str]],
    expected: Mapping[str, float],
    seen: Mapping[str, float],
    elapsed: Mapping[str, float],
    cores: int,
) -> float | None:
    """Seconds until all jobs are done.

    The larger of two lower bounds, each at the `pace` so far: the work left, shared out over the
    cores, and the longest chain of jobs that wait for one another. No order of the jobs takes twice
    as long (R. L. Graham, Bounds for certain multiprocessing anomalies, 1966).

    Parameters
    ----------
    waits
        All jobs of the build, and for which others each waits.
    expected
        Seconds that each took before, where known; the others are taken to need the median.
    seen
        Seconds of those that are done.
    elapsed
        Seconds since those began that are running.
    cores
        How many run at once.

    Returns
    -------
    float or None
        None if it is known of less than half of the jobs how long they take.
    """
    known = [expected[job] for job in waits if job in expected]
    if not known or 2 * len(known) < len(waits):
        return None
    usual, factor = median(known), pace(expected, seen)
    left = {
        job: max(factor * expected.get(job, usual) - elapsed.get(job, 0.0), 0.0)
        for job in waits
        if job not in seen
    }
    until: dict[str, float] = {}
    for job in TopologicalSorter(waits).static_order():
        earlier = (until[other] for other in waits.get(job, ()))
        until[job] = left.get(job, 0.0) + max(earlier, default=0.0)
    return max(sum(left.values()) / cores, *until.values())


def duration(seconds: float) -> str:
    """Seconds as a person says them."""
    minutes = round(seconds / 60)
    if seconds < 99.5:
        return f"{seconds:.0f} s"
    return f"{minutes} min" if minutes < 100 else f"{minutes // 60} h {minutes % 60} min"
