"""Observations: one for each published result, and a clear word about impossible answer times."""

from pathlib import Path

import numpy as np
import pytest

from smallsat.errors import InputError
from smallsat.evidence.ledger import read_ledger
from smallsat.studies.mars.evidence.observations import observations

LEDGER = Path(__file__).parents[2] / "data/published/mars/values.csv"


def test_every_published_result_is_observed_once(section, parameters, runs):
    """The ids are exactly those of the document's results in the ledger."""
    observed = [observation.id for observation in observations(section, parameters, runs)]
    published = [
        row["id"]
        for row in read_ledger(LEDGER)
        if row["document"] == "mars" and row["kind"] == "result"
    ]
    assert sorted(observed) == sorted(published)


@pytest.mark.parametrize("time", [7000.0, 0.5])
def test_an_answer_time_off_the_grid_is_named(section, parameters, runs, changed, time):
    """Beyond the run or between two steps: an input error with key and value."""
    other = changed(section, "answer_times_s.mission", (time,))
    with pytest.raises(InputError, match=rf"answer_times_s\.mission': {time:g}"):
        observations(other, parameters, runs)


def test_a_run_that_overflowed_is_not_a_number_with_a_note(section, parameters, runs):
    """Its values are missing and say why; those of the other runs stay."""
    lost = dict(runs)
    lost["fixed torque"] = np.full_like(runs["fixed torque"], np.nan)
    lost["fixed torque"][:, 0] = runs["fixed torque"][:, 0]
    found = observations(section, parameters, lost)
    missing = [one for one in found if np.isnan(one.computed)]
    assert {one.id.rpartition("/")[0] for one in missing} == {
        "mars/section-ix-c/sigma-b-n-100-s/fixed-torque"
    }
    assert all(one.note.startswith("not converged") for one in missing)
    assert not any(one.note for one in found if not np.isnan(one.computed))
