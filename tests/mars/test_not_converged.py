"""A run that overflows: a row that says so, and nothing that rests on it."""

from dataclasses import replace

import numpy as np
import pytest

from smallsat.drawing.style import apply_style
from smallsat.results import read_table
from smallsat.step import Step
from smallsat.studies.mars.evidence import claims, errata
from smallsat.studies.mars.figures.responses import response_data, response_figure
from smallsat.workflow.run_step import run_step


@pytest.fixture(scope="module")
def short(section):
    """A hundred times the torque, and runs no longer than that needs."""
    return section.with_(
        fixed_torque_N_m=[1.0, -1.0, 2.0],
        durations_s={"response": 500.0, "mission": 300.0, "day": 300.0},
        answer_times_s=section.answer_times_s.with_(pointing=[15.0], mission=[300.0]),
    )


@pytest.fixture(scope="module")
def results(tmp_path_factory, short, root):
    folder = tmp_path_factory.mktemp("results")
    step = Step(short, folder, root / "data/published/mars")
    run_step("mars", "simulation", step)
    shorter = short.with_(durations_s=short.durations_s.with_(response=30.0))
    run_step("mars", "independent_check", replace(step, section=shorter))
    return folder


def test_the_row_names_run_time_and_method(results):
    """The one run that overflows is listed; the others are flown to their ends."""
    table = read_table(results / "simulation-not-converged.csv")
    assert table["case"].tolist() == ["the run 'fixed torque'"]
    assert "no number from" in table["status"][0] and "Runge-Kutta" in table["tried"][0]
    flown = read_table(results / "trajectories.parquet")
    lost = flown.groupby("run")["sigma_1"].apply(lambda sigma: sigma.isna().all())
    assert lost[lost].index.tolist() == ["fixed torque"]


def test_what_needs_the_run_is_not_decided(short, results, grounds):
    """Claims and proofs say that a case is missing; they do not judge what is none."""
    given = grounds("mars", short, results)
    for predicate in (claims.rates_oscillate_about_zero, claims.step_leaves_artefacts):
        with pytest.raises(LookupError, match="overflowed"):
            predicate(given)
    with pytest.raises(LookupError, match="overflowed"):
        errata.second_rate_panel(given)


def test_its_figure_says_so(results):
    """Empty panels with a word, not curves of what is no number."""
    apply_style()
    data = response_data(read_table(results / "trajectories.parquet"), "fixed torque")
    figure = response_figure(data)
    assert "not converged" in [text.get_text() for text in figure.texts]
    drawn = [line.get_ydata() for panel in figure.axes for line in panel.get_lines()]
    assert all(np.isnan(np.asarray(values, dtype=float)).all() for values in drawn)


def test_a_run_that_is_known_says_nothing(results):
    """The word is for missing runs alone."""
    apply_style()
    data = response_data(read_table(results / "trajectories.parquet"), "sun")
    assert not [text for text in response_figure(data).texts if "converged" in text.get_text()]
