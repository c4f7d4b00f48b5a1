"""Reading the ledger's names of cases."""

import pytest

from smallsat.studies.transfer.results import PrintedCase, parse_case


@pytest.mark.parametrize(
    ("name", "case"),
    [
        ("Indirect Shooting", PrintedCase("indirect", 0, 1)),
        ("Indirect Multiple Shooting K=8", PrintedCase("indirect", 0, 8)),
        ("Direct Shooting N=5", PrintedCase("direct", 5, 1)),
        ("Direct Multiple Shooting N=6 K=16", PrintedCase("direct", 6, 16)),
    ],
)
def test_cases_are_read(name, case):
    """Every form of name that the ledger uses."""
    assert parse_case(name) == case


@pytest.mark.parametrize("name", ["", "Direct Multiple Shooting", "K=2", "Direct Shooting"])
def test_a_name_of_no_single_case_is_none(name):
    """A range of cases, or none, is not mistaken for one."""
    assert parse_case(name) is None
