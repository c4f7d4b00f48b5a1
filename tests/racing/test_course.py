"""Courses and start positions against the document and an independent copy of its first course."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from smallsat.errors import InputError
from smallsat.studies.racing.methods.recovery import search_days, start_positions
from smallsat.studies.racing.model.course import check_course, course_of, course_table, generate
from smallsat.studies.racing.model.matlab_random import MatlabStream

PUBLISHED = Path(__file__).parents[2] / "data/published/racing/course-scenario-1.csv"
# First outputs of MATLAB's `rng(0); rand` and `rng(0); randn`, as in its documentation.
UNIFORM = [0.8147, 0.9058, 0.1270, 0.9134, 0.6324]
NORMAL = [0.5377, 1.8339, -2.2588, 0.8622, 0.3188, -1.3077, -0.4336, 0.3426, 3.5784, 2.7694]
NORMAL += [-1.3499, 3.0349, 0.7254, -0.0631, 0.7147, -0.2050, -0.1241, 1.4897, 1.4090, 1.4172]


def test_uniform_numbers_are_matlabs():
    """Four digits of the first five."""
    assert np.round(MatlabStream(0).random(5), 4).tolist() == UNIFORM


def test_normal_numbers_are_matlabs():
    """Four digits of the first twenty; the ninth comes from the tail of the ziggurat."""
    stream = MatlabStream(0)
    assert [round(float(stream.normal()), 4) for _ in NORMAL] == NORMAL


def test_normal_numbers_are_normal():
    """Mean, variance and kurtosis of 20000 draws, within four standard errors."""
    stream = MatlabStream(1)
    z = np.array([stream.normal() for _ in range(20000)])
    root = np.sqrt(len(z))
    assert abs(z.mean()) < 4.0 / root
    assert abs(z.var() - 1.0) < 4.0 * np.sqrt(2.0) / root
    assert abs((z**4).mean() - 3.0) < 4.0 * np.sqrt(96.0) / root


def test_first_course_is_the_published_one(parameters):
    """All 22 rings of Scenario 1 from its seed, to the nine digits of the copy."""
    table = course_table(parameters.races["scenario-1"].course)
    published = pd.read_csv(PUBLISHED)
    rings = table["ring"].tolist()
    assert rings == published["ring"].tolist()
    numbers = table.columns[1:]
    inner = slice(1, -1)
    difference = table[numbers][inner].to_numpy() - published[numbers][inner].to_numpy(dtype=float)
    assert np.abs(difference).max() < 1e-8


@pytest.mark.parametrize(("scenario", "fits"), [("scenario-1", 8), ("scenario-2", 7)])
def test_start_positions_follow_from_the_seed(parameters, section, scenario, fits):
    """Printed x and z to half a digit: all of Table 1, all but one of Table 3."""
    race = parameters.races[scenario]
    rings, places = start_positions(parameters, section.scenarios[scenario].seed, 4)
    printed = np.array([cubesat.position for cubesat in race.cubesats])
    assert rings == race.course.rings
    assert (np.abs(places - printed)[:, [0, 2]] <= 0.05).sum() == fits
    assert np.abs(places - printed)[:, [0, 2]].max() < 0.07


def test_no_neighbouring_day_fits(parameters):
    """The day of the seed is the only one of its year within 100 m of Table 3."""
    days = search_days(parameters, "scenario-2", 2025, 2025)
    near = days[days["largest_difference_m"] < 100.0]
    assert near["day"].tolist() == ["2025-05-05"]


@pytest.mark.parametrize("halved", [True, False])
def test_random_courses_keep_the_rules(parameters, halved):
    """Distances, axes, number of rings, the mean of all centres: Section I."""
    for seed in range(20):
        course = generate(np.random.default_rng(seed), parameters.ranges, halved=halved)
        gaps = np.linalg.norm(np.diff(course.centres, axis=0), axis=1)
        assert 15 <= course.rings <= 25
        assert ((gaps >= 300.0) & (gaps <= 350.0)).all()
        assert ((course.semi_axes >= 1.0) & (course.semi_axes <= 5.0)).all()
        assert np.linalg.norm(course.normals, axis=1) == pytest.approx(1.0)
        assert np.vstack([course.centres, course.end]).mean(axis=0) == pytest.approx(0.0, abs=1e-9)
        assert np.abs(np.einsum("kij,kj->ki", course.axes, course.normals)).max() < 1e-12


def test_a_course_survives_its_table(parameters):
    """Written and read: the same course."""
    course = parameters.races["scenario-2"].course
    again = course_of(course_table(course), "course.csv")
    assert again.centres == pytest.approx(course.centres)
    assert again.semi_axes == pytest.approx(course.semi_axes)


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (lambda c: replace(c, centres=c.centres[:0], semi_axes=c.semi_axes[:0]), "no ring"),
        (lambda c: replace(c, semi_axes=0.0 * c.semi_axes), "ring 1 has a semi-axis of 0 m"),
        (
            lambda c: replace(c, centres=np.vstack([c.centres[:1], c.centres[:1], c.centres[2:]])),
            "ring 1 and ring 2 have the same centre",
        ),
    ],
)
def test_impossible_courses_are_refused(parameters, damage, words):
    """One line that names the ring and what to do."""
    with pytest.raises(InputError, match=words):
        check_course(damage(parameters.races["scenario-1"].course), "course.csv")
