"""Printed literals: the number that each form means, and how finely it was printed."""

import math

import pytest

from smallsat.evidence.printed import looks_numeric, parse_printed


@pytest.mark.parametrize(
    ("literal", "value", "half_unit"),
    [
        ("3.24694", 3.24694, 5e-6),
        ("0.75550", 0.7555, 5e-6),
        ("-0.7390", -0.739, 5e-5),
        ("+12", 12.0, 0.5),
        ("1e-8", 1e-8, 0.5e-8),
        ("9.03E-4", 9.03e-4, 0.5e-6),
        ("1,500,000", 1.5e6, 0.5),
        (" 27 ", 27.0, 0.5),
        ("1/6", 1 / 6, 0.0),
        ("sqrt(2)/2", math.sqrt(2) / 2, 0.0),
        ("(1/36)/(3/5)", 5 / 108, 0.0),
        ("20/120 = 1/6", 1 / 6, 0.0),
        ("2*3^2", 18.0, 0.0),
    ],
)
def test_a_literal_is_read_as_the_number_it_prints(literal, value, half_unit):
    printed = parse_printed(literal)
    assert printed.value == pytest.approx(value, rel=1e-15)
    assert printed.half_unit == pytest.approx(half_unit, rel=1e-12)
    assert not printed.bound


@pytest.mark.parametrize(
    "literal",
    ["", "Twenty", "(illegible)", "free", "1.2.3", "1/0", "mu", "sin(1)", "__import__('os')"],
)
def test_text_is_no_number(literal):
    assert parse_printed(literal) is None


@pytest.mark.parametrize(
    ("printed", "computed", "equal"),
    [
        ("0.50", 0.504999, True),
        ("0.50", 0.505, True),  # half a unit counts, whatever binary rounding makes of it
        ("0.50", 0.495, True),
        ("0.50", 0.5051, False),
        ("0.5", 0.5051, True),  # fewer digits are a wider statement
        ("27", 27.4, True),
        ("27", 28.0, False),
        ("1/6", 1 / 6, True),
        ("1/6", 0.1667, False),
        ("<0.01", 0.00999, True),
        ("<0.01", -0.00999, True),
        ("<0.01", 0.01, False),
        ("0.50", math.nan, False),
    ],
)
def test_equal_means_to_half_a_unit_of_the_last_printed_digit(printed, computed, equal):
    assert parse_printed(printed).matches(computed) is equal


@pytest.mark.parametrize(
    ("printed", "computed", "cut"),
    [
        ("0.75", 0.7599, True),
        ("0.75", 0.75, True),
        ("0.75", 0.7499, False),
        ("0.75", 0.76, False),
        ("-0.75", -0.7599, True),
        ("-0.75", -0.7499, False),
    ],
)
def test_truncated_digits_are_cut_towards_zero(printed, computed, cut):
    assert parse_printed(printed).truncates(computed) is cut


@pytest.mark.parametrize("literal", ["1.2.3", "<x", "4 km"])
def test_a_damaged_number_looks_like_one(literal):
    assert looks_numeric(literal) == (literal != "<x")
