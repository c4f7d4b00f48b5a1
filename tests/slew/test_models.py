"""The printed run beside plans by two models: what is compared, and what is drawn."""

import numpy as np
import pandas as pd
import pytest

from smallsat.drawing.style import apply_style
from smallsat.studies.slew.figures import motions
from smallsat.studies.slew.methods.models import LEFT, MODELS, PEAKS, PRINTED, READINGS, compared
from smallsat.studies.slew.model.simulation import COLUMNS


@pytest.fixture
def printed_flight(parameters, ledger):
    """A flight whose body has the printed momenta, x, y and z, and whose wheels have none."""
    where = "section-vi-b/{}-angular-momentum-usage/180-deg-torque-optimal"
    momenta = [
        np.array(ledger("slew").values(where.format(name)), dtype=float)
        for name in ("maximum", "final")
    ]
    rates = np.array(momenta) / 100.0 * parameters.momentum / np.diag(parameters.inertia)
    flown = pd.DataFrame(0.0, index=range(2), columns=list(COLUMNS))
    flown["q_4"] = 1.0
    flown["time_s"] = [0.0, 100.0]
    flown[["omega_x", "omega_y", "omega_z"]] = rates
    return flown.assign(flight=next(iter(MODELS)), rate_weight=1.0)


def test_a_flight_with_the_printed_momenta_is_off_by_nothing(printed_flight, parameters, ledger):
    """Read as the body's momentum; as the wheels' it is off by all that is printed."""
    table = compared(printed_flight, parameters, ledger("slew"))
    assert table["model"].tolist() == [PRINTED, *[next(iter(MODELS))] * len(READINGS)]
    off = table.set_index("reading")["off_printed_pct"]
    assert off[READINGS[0]] == pytest.approx(0.0, abs=1e-9)
    printed = table.loc[0, [*PEAKS, *LEFT]].to_numpy(dtype=float)
    assert off[READINGS[1]] == pytest.approx(np.sqrt(np.mean(printed**2)))


def test_without_a_plan_there_is_the_printed_row_alone(printed_flight, parameters, ledger):
    """And a word in the place of the figure."""
    apply_style()
    none = printed_flight[:0]
    table = compared(none, parameters, ledger("slew"))
    assert table["model"].tolist() == [PRINTED]
    _, data = motions.models(none, table, parameters)
    assert "no plan" in data["note"][0]
