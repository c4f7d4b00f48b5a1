"""A course file is an input of what is flown on it: move a ring, and the race is flown again."""

import os
import re
import shutil
import time
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

_SPEC = spec_from_file_location(
    "workflow_project", Path(__file__).parents[1] / "workflow/conftest.py"
)
assert _SPEC is not None and _SPEC.loader is not None
_WORKFLOW = module_from_spec(_SPEC)
_SPEC.loader.exec_module(_WORKFLOW)
make_project = _WORKFLOW.make_project

RUN = (
    "--config",
    "run=own",
    'racing={"scenarios": {"scenario-1": {"course_file": "course.csv"}}}',
)
TARGETS = (
    "data/results/racing/verdicts.csv",
    "data/results/transfer/verdicts.csv",
    "data/results/mars/modes.csv",
)
# What reads a course file, and only that: the commands of the study, and its judge.
READERS = {
    "racing_courses",
    "racing_listing_scenario_1",
    "racing_listing_scenario_2",
    "racing_optima_scenario_1",
    "racing_optima_scenario_2",
    "racing_variants",
    "racing_without_thrust",
    "racing_simple_guesses",
    "racing_propellant",
    "racing_weighted_misses",
    "racing_drifting_rings",
    "racing_checks",
    "racing_dynamic_programming",
    "racing_random_courses_1_of_2",
    "racing_random_courses_2_of_2",
    "racing_observations",
    "racing_verdicts",
}


@pytest.fixture(scope="module")
def flown(make_project):
    """A copy of the project with a course file, and with files in the place of its results.

    What is in the results does not matter here, only how old they are.
    """
    project = make_project()
    copy = project.folder / "course.csv"
    shutil.copy(project.folder / "data/published/racing/course-scenario-1.csv", copy)
    listed = project.snakemake("--summary", *TARGETS, *RUN).stdout.splitlines()
    header = next(line for line in listed if line.startswith("output_file"))
    now = time.time()
    for line in listed[listed.index(header) + 1 :]:
        path = project.folder / "runs/own" / line.partition("\t")[0]
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
        os.utime(path, (now, now))
    return project


def _planned(project) -> set[str]:
    """Rules in the table of jobs of a dry run."""
    return set(re.findall(r"^(\w+) +1$", project.jobs(*TARGETS, *RUN), re.M)) - {"total"}


def test_a_moved_ring_is_flown_again(flown):
    """Nothing is to be done; with a ring moved all that reads the course is, and nothing else."""
    assert "Nothing to be done" in flown.jobs(*TARGETS, *RUN)
    path = flown.folder / "course.csv"
    intact = path.read_text()
    path.write_text(intact.replace("-130.528862707", "-131.528862707", 1))
    later = time.time() + 2.0
    os.utime(path, (later, later))
    assert path.read_text() != intact
    assert _planned(flown) == READERS


def test_a_wrong_course_file_stops_before_anything_runs(flown):
    """One line, with the file, its line and its column."""
    path = flown.folder / "course.csv"
    intact = path.read_text()
    path.write_text(intact.replace("0.000000000000,1.000000000000", "0,0", 1))
    try:
        line = flown.refusal(*TARGETS, *RUN)
    finally:
        path.write_text(intact)
    for word in ("course.csv", "line 3", "'nx, ny, nz'", "must not be zero"):
        assert word in line, line
