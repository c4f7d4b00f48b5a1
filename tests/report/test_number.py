"""Digits shown to a reader: two more than printed for a value, two significant for a difference."""

from math import inf, nan

import pytest

from smallsat.report.number import NOTHING, computed_text, difference_text, significant_text


@pytest.mark.parametrize(
    ("value", "printed", "text"),
    [
        (3.246941234, "3.24694", "3.2469412"),
        (-0.0001, "-0.00", "-0.0001"),
        (-0.000001, "0.00", "0.0000"),
        (27.0, "27", "27"),
        (27.4, "27", "27.40"),
        (1500012.0, "1,500,000", "1500012"),
        (1.2345e-8, "1.2e-8", "1.235e-8"),
        (0.0012, "<0.01", "0.0012"),
        (1 / 6, "20/120 = 1/6", "0.166667"),
        (2.5, "Twenty", "2.5"),
        (nan, "1.0", NOTHING),
        (inf, "1.0", NOTHING),
    ],
)
def test_computed_values_have_two_digits_more_than_printed(value, printed, text):
    assert computed_text(value, printed) == text


@pytest.mark.parametrize(
    ("difference", "text"),
    [(1.234e-5, "+1.2e-5"), (-0.0456, "-0.046"), (0.0, "0"), (3e-16, "0"), (nan, NOTHING)],
)
def test_differences_are_signed_and_rounding_noise_is_zero(difference, text):
    assert difference_text(difference, 3.2) == text


def test_significant_digits_are_a_limit_not_a_width():
    assert significant_text(0.5, 7) == "0.5"
    assert significant_text(1.23456789, 7) == "1.234568"
