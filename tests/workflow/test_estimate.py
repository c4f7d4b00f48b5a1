"""The estimate of what a build still takes: against small plans whose answer is plain."""

import numpy as np
import pytest

from smallsat.workflow.estimate import duration, pace, seconds_left


def left(waits, expected, seen=(), elapsed=(), cores=1):
    return seconds_left(waits, expected, dict(seen), dict(elapsed), cores)


ALONE = {"a": set(), "b": set(), "c": set(), "d": set()}
EQUAL = dict.fromkeys(ALONE, 100.0)


def test_independent_jobs_are_shared_out_over_the_cores():
    assert left(ALONE, EQUAL) == 400.0
    assert left(ALONE, EQUAL, cores=2) == 200.0


def test_a_chain_takes_its_whole_length_whatever_the_cores():
    chain = {"a": set(), "b": {"a"}, "c": {"b"}, "d": set()}
    assert left(chain, EQUAL, cores=8) == 300.0
    assert left(chain, EQUAL, seen={"a": 100.0}, cores=8) == 200.0


def test_what_runs_counts_for_its_rest_and_never_for_less_than_nothing():
    assert left(ALONE, EQUAL, elapsed={"a": 30.0}) == 370.0
    assert left(ALONE, EQUAL, elapsed={"a": 1e4}) == 300.0


def test_a_machine_half_as_fast_takes_twice_as_long():
    """The ratio of seen to expected seconds is approached from one as work is done."""
    expected = {"a": 1e4, "b": 100.0}
    assert pace(expected, {}) == 1.0
    assert pace(expected, {"a": 2e4}) == pytest.approx(2.0, rel=0.01)
    estimate = left({"a": set(), "b": set()}, expected, seen={"a": 2e4})
    assert estimate == pytest.approx(200.0, rel=0.01)
    # One slow small job says little.
    assert pace({"small": 1.0}, {"small": 4.0}) < 1.1


def test_a_job_without_a_time_takes_the_median_and_too_few_times_give_no_estimate():
    assert left(ALONE, {"a": 10.0, "b": 20.0, "c": 60.0}) == 110.0
    assert left(ALONE, {"a": 10.0}) is None
    assert left(ALONE, {}) is None


@pytest.mark.parametrize("cores", [1, 2, 4])
def test_the_estimate_holds_along_a_simulated_build(cores):
    """Sixty jobs of very different lengths, each waiting for one before, half as fast as expected.

    Both bounds are lower ones, so it never takes less; and in whatever order ready jobs are begun,
    less than twice as long as the larger of them (Graham, 1966). On one core it is exact.
    """
    random = np.random.default_rng(20240501)
    expected = {f"job {n}": float(s) for n, s in enumerate(random.lognormal(3.0, 1.2, 60))}
    jobs = list(expected)
    waits = {job: {jobs[int(random.integers(n))]} if n else set() for n, job in enumerate(jobs)}
    seen, ends, running, said, now, begun = {}, {}, [], [], 0.0, set()
    while len(seen) < len(jobs):
        for job in jobs:
            if len(running) < cores and job not in begun and waits[job] <= seen.keys():
                begun.add(job)
                running.append((now + 2.0 * expected[job], now, job))
        running.sort()
        now, began, done = running.pop(0)
        seen[done], ends[done] = now - began, now
        elapsed = {job: now - start for _, start, job in running}
        said.append((now, seconds_left(waits, expected, seen, elapsed, cores)))
    for when, left in said[:-1]:
        factor = 2.0 / pace(expected, {job: seen[job] for job in seen if ends[job] <= when})
        assert factor * left <= (now - when) * (1.0 + 1e-9)
        assert now - when < (2.0 if cores > 1 else 1.0 + 1e-9) * factor * left


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0.4, "0 s"), (99.0, "99 s"), (125.0, "2 min"), (5940.0, "99 min"), (6060.0, "1 h 41 min")],
)
def test_durations_are_said_as_a_person_does(seconds, text):
    assert duration(seconds) == text
