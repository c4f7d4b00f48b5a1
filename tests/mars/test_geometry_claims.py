"""Claims on orbits, frames and sight: as configured, and where they come out otherwise."""

import numpy as np
import pandas as pd
import pytest

from smallsat.studies.mars.evidence import claims, geometry_claims
from smallsat.studies.mars.methods.independent_check import check_runs
from smallsat.studies.mars.methods.simulation import as_table
from smallsat.studies.mars.model.modes import GMO, SUN, pointing_mode


@pytest.fixture(scope="module")
def on(section, parameters, runs, tmp_path_factory, grounds):
    """The grounds for a section, with other printed literals, or modes over a day in minutes."""
    folder = tmp_path_factory.mktemp("results")
    tables = [as_table(record).assign(run=name) for name, record in runs.items()]
    pd.concat(tables).to_parquet(folder / "trajectories.parquet")
    check_runs(section, parameters).to_parquet(folder / "independent.parquet")
    times = np.arange(0.0, section.durations_s.day, 60.0)

    def given(printed=None, mode=None, section=section):
        limit = parameters.visibility
        modes = [pointing_mode(parameters.lmo, parameters.gmo, t, limit) for t in times]
        table = pd.DataFrame({"time_s": times, "mode": modes if mode is None else mode})
        table.to_parquet(folder / "day.parquet")
        return grounds("mars", section, folder, printed)

    return given


def test_position_and_velocity(on, monkeypatch):
    """Orthogonal in closed form; not where the radius grows too."""
    assert geometry_claims.velocity_is_normal_to_position(on()).outcome == "holds"
    outwards = geometry_claims.position
    monkeypatch.setattr(geometry_claims, "velocity", outwards)
    assert geometry_claims.velocity_is_normal_to_position(on()).outcome == "fails"


def test_the_printed_sun_frame(on):
    """A rotation as printed; a reflection with one sign the other way."""
    assert geometry_claims.sun_frame_is_right_handed(on()).outcome == "holds"
    mirrored = on({"equation-19/dcm-rsn/11": "1"})
    assert geometry_claims.sun_frame_is_right_handed(mirrored).outcome == "fails"


def test_the_closed_form_of_the_rate(on, monkeypatch):
    """It is the frame's own rate, so that the claim fails; a wrong one would leave it standing."""
    assert geometry_claims.analytic_rate_is_difficult(on()).outcome == "fails"
    monkeypatch.setattr(geometry_claims, "analytic_rate", lambda *_: np.zeros(3))
    assert geometry_claims.analytic_rate_is_difficult(on()).outcome == "holds"


def test_transmission_and_sight(on, parameters):
    """In sight, but not whenever there is sight; then full use of it, and blindness."""
    given = on()
    judged = geometry_claims.transmits_in_line_of_sight(given)
    assert judged.outcome == "undecided"
    day = given.table("day.parquet")
    lmo, gmo = claims.directions(parameters, day["time_s"].to_numpy())
    # Past the edge, both spacecraft have the planet's radius or more from the line between them.
    rim = given.section.orbits.mars_radius_km * 1000.0
    horizon = sum(np.arccos(rim / orbit.radius) for orbit in (parameters.lmo, parameters.gmo))
    sight = (claims.angle_between(lmo, gmo) <= horizon) & (lmo[:, 1] <= 0.0)
    used = on(mode=np.where(sight, GMO, SUN))
    assert geometry_claims.transmits_in_line_of_sight(used).outcome == "holds"
    blind = on(mode=np.full(len(day), GMO))
    assert geometry_claims.transmits_in_line_of_sight(blind).outcome == "fails"


def test_turns_faster_than_a_step(on, section, changed):
    """Not in steps of a second, as far as the run goes; in steps of two it would."""
    assert claims.turns_faster_than_a_step(on()).outcome == "fails"
    coarse = on(section=changed(section, "step_s", 2.0))
    assert claims.turns_faster_than_a_step(coarse).outcome == "holds"
