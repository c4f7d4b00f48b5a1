"""Inputs: a printed parameter is compared with the value of ours that it feeds."""

import re
import sys
import types
from math import isnan

import pytest

from smallsat.errors import InputError
from smallsat.evidence.bindings import agrees, binding_name, bound_value
from smallsat.quantities import Part


class Made(Part):
    """A section of a study."""

    step_s: float = 1.0
    rates: tuple[float, ...] = (1.0, 1.75, -2.2)
    inertia: tuple[tuple[float, ...], ...] = ((10.0, 0.0, 0.0), (0.0, 5.0, 0.0), (0.0, 0.0, 7.5))


SECTION = Made()


def row(printed="1", component="", case=""):
    return {"id": "mars/x", "printed": printed, "component": component, "case": case}


@pytest.mark.parametrize(
    ("key", "component", "value"),
    [
        ("mars.step_s", "", 1.0),
        ("mars.step_s", "x", 1.0),  # a number has no components to pick from
        ("mars.rates.1", "", 1.75),
        ("mars.rates", "item 2", 1.75),
        ("mars.rates", "z", -2.2),
        ("mars.rates", "3", -2.2),
        ("mars.rates", "min", 1.0),
        ("mars.rates", "max", -2.2),
        ("mars.inertia", "22", 5.0),
    ],
)
def test_the_component_picks_the_entry(key, component, value):
    assert bound_value(row(component=component), {"config": key}, SECTION) == value


def test_the_case_picks_the_entry_where_there_is_no_component():
    assert bound_value(row(case="item 3"), {"config": "mars.rates"}, SECTION) == -2.2


def test_a_constant_of_the_code_can_be_fed():
    binding = {"constant": "math:pi"}
    assert bound_value(row(), binding, SECTION) == pytest.approx(3.14159265)
    assert (
        binding_name({"constant": "smallsat.studies.mars.model.modes:LIMIT"})
        == "mars.model.modes.LIMIT"
    )
    assert binding_name({"config": "mars.step_s"}) == "mars.step_s"


def test_a_value_can_be_derived_from_the_configuration(monkeypatch):
    module = types.ModuleType("derivations")
    module.half_step = lambda section: {"half": section.step_s / 2}
    monkeypatch.setitem(sys.modules, "derivations", module)
    binding = {"derived": "derivations:half_step", "entry": "half"}
    assert bound_value(row(), binding, SECTION) == 0.5
    assert binding_name(binding) == "derivations.half_step"


@pytest.mark.parametrize(
    ("binding", "component", "message"),
    [
        ({"config": "mars.step"}, "", "config key 'mars.step': not in the configuration"),
        ({"config": "mars.step_s.7"}, "", "config key 'mars.step_s.7': not in the configuration"),
        ({"constant": "math:no_such"}, "", "bindings.yaml: 'math:no_such' does not exist"),
        ({"constant": "no.such:x"}, "", "bindings.yaml: 'no.such:x' does not exist"),
        ({"config": "mars.rates"}, "", "component '' picks no entry"),
        ({"config": "mars.rates"}, "w", "component 'w' picks no entry"),
    ],
)
def test_a_binding_that_leads_nowhere_is_named(binding, component, message):
    with pytest.raises(InputError, match=re.escape(message)):
        bound_value(row(component=component), binding, SECTION)


@pytest.mark.parametrize(
    ("key", "component"), [("mars.rates", "item 4"), ("mars.inertia", "44"), ("mars.rates.7", "")]
)
def test_an_entry_beyond_the_list_feeds_nothing(key, component):
    """A what-if run may have a shorter list: the printed entry then agrees with no value."""
    binding = {"config": key}
    value = bound_value(row("1.75", component=component), binding, SECTION)
    assert isnan(value)
    assert not agrees(row("1.75", component=component), binding, value)


@pytest.mark.parametrize(
    ("printed", "binding", "value", "agree"),
    [
        ("1.75", {}, 1.75, True),
        ("1.7500", {}, 1.75, True),
        ("1.75", {}, 1.7500001, False),  # inputs are exact: half a digit is no excuse
        ("1/6", {}, 1 / 6, True),
        ("pi/2 rad", {"reading": "90"}, 90.0, True),
        ("Twenty", {"reading": 20}, 20.0, True),
    ],
)
def test_an_input_agrees_only_if_it_is_equal(printed, binding, value, agree):
    assert agrees(row(printed), binding, value) is agree


def test_words_need_a_reading():
    with pytest.raises(InputError, match="'mars/x': 'Twenty' is no number; add a 'reading'"):
        agrees(row("Twenty"), {}, 20.0)
