"""Manoeuvres that never dock: rows, words in the figures, and nothing that stops."""

import numpy as np
import pytest
from matplotlib import pyplot as plt

from smallsat.results import read_table, write_table
from smallsat.studies.rendezvous.evidence.case_tables import TOTAL
from smallsat.studies.rendezvous.evidence.observations import case_cells, observations, undocked
from smallsat.studies.rendezvous.figures import cases as plots
from smallsat.studies.rendezvous.figures import schematics
from smallsat.studies.rendezvous.guidance.law import PHASES
from smallsat.studies.rendezvous.methods.solver_comparison import samples
from smallsat.studies.rendezvous.parameters import CASES, law, start_state
from smallsat.studies.rendezvous.simulation.flights import simulate_cases


@pytest.fixture(scope="module")
def section(config):
    """A far range whose control cannot bring the chaser into its narrow cone within the time."""
    phases = config.rendezvous.phases
    # Long steps, so that few programs are solved.
    far = phases.far.with_(
        control_bound_m_s=1e-5, cone_angle_deg=0.01, sample_time_s=300.0, horizon=5
    )
    return config.rendezvous.with_(phases=phases.with_(far=far))


@pytest.fixture(scope="module")
def results(section, tmp_path_factory):
    folder = tmp_path_factory.mktemp("undocked")
    for name, table in simulate_cases(section).items():
        write_table(table, folder / name)
    return folder


def test_every_case_is_listed(results):
    """Its first phase without an end, how long and how far, and how many programs there were."""
    found = undocked(results)
    assert [one.case for one in found] == [f"{case}, far phase" for case in CASES]
    for one in found:
        assert "not ended within 200 min" in one.status
        assert one.residual > 100.0
        assert one.tried.startswith("40 programs")


def test_what_it_would_have_printed_is_missing(section, results):
    """No time and no delta-v of what did not end, and no total."""
    cells = case_cells(section, results)
    assert cells[["time_s", "delta_v_m_s"]].isna().all(axis=None)
    assert set(cells["phase"]) == {*PHASES, TOTAL}
    found = [one for one in observations(section, results) if "/table-3-3/" in one.id]
    assert found
    assert all(np.isnan(one.computed) and one.note.startswith("not converged") for one in found)


def test_figures_say_what_was_not_reached(section, results):
    """All of chapters 2 and 3 are drawn."""
    flights, paths = (read_table(results / f"{name}.parquet") for name in ("flights", "paths"))
    for case in CASES[:3]:
        figure, _ = plots.manoeuvre(section, case, flights, paths)
        words = [text.get_text() for axes in figure.axes for text in axes.texts]
        assert words.count("not reached") == 2
    figure, _ = plots.comparison(section, flights, paths)
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels and all("does not dock" in label for label in labels)
    figure, table = schematics.horizon(section, flights)
    assert "does not come to its mid range" in figure.axes[0].texts[0].get_text()
    assert table.empty
    schematics.phases(section, flights, paths)
    schematics.rotating_planes(section, flights)
    plt.close("all")


def test_solvers_are_compared_on_the_programs_there_are(section):
    """Of the far range alone."""
    found = samples({"QP": law(section)}, start_state(section)[None], 3)
    assert [one.kind for one in found] == ["far (QP)"] * 3
