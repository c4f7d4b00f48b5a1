"""The printed run beside plans by two models: what is compared, and what is drawn."""

import numpy as np
import pandas as pd
import pytest

from smallsat.drawing.style import apply_style
from smallsat.studies.slew.figures import motions as motions_of
from smallsat.studies.slew.methods.models import LEFT, PEAKS, PRINTED, READINGS, compared
from smallsat.studies.slew.methods.plan_names import MODELS
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
    _, data = motions_of.models(none, table, parameters)
    assert "no plan" in data["note"][0]


def test_figures_of_a_turn_show_each_model_by_its_title(printed_flight, parameters):
    """A row or a sphere each, and the data say which; one motion alone has no such column."""
    apply_style()
    one = printed_flight.drop(columns=["flight", "rate_weight"])
    one = pd.concat([one] * 6, ignore_index=True)
    plan = one.assign(node=1)
    draw = {
        "attitude": lambda motions: motions_of.attitude(motions),
        "usage": lambda motions: motions_of.usage(motions, parameters),
        "history": lambda motions: motions_of.history(motions, parameters),
        "traces": lambda motions: motions_of.traces(motions, {}),
    }
    for drawn in draw.values():
        _, alone = drawn({"": plan})
        assert "motion" not in alone
        figure, both = drawn(dict.fromkeys(MODELS, plan))
        assert both["motion"].unique().tolist() == list(MODELS)
        assert len(both) == 2 * len(alone)
        titles = [part.get_suptitle() for part in figure.subfigs]
        assert (titles or [text.get_text() for text in figure.texts])[: len(MODELS)] == list(MODELS)
