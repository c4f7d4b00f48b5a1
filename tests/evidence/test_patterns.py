"""Patterns of ids: each id has at most one entry, and no pattern is idle."""

import pytest

from smallsat.errors import InputError
from smallsat.evidence.patterns import match_entries

IDS = ["a/table-1/time", "a/table-1/mass", "a/table-10/time"]


def test_a_star_crosses_slashes_and_a_question_mark_is_one_character():
    one, two = {"ids": ["*/table-1/*"]}, {"ids": ["a/table-??/time"]}
    matched = match_entries([one, two], IDS, "rules.yaml")
    assert [matched[identifier] is one for identifier in IDS] == [True, True, False]
    assert matched["a/table-10/time"] is two


def test_an_id_without_an_entry_is_left_out():
    assert set(match_entries([{"ids": ["*/mass"]}], IDS, "rules.yaml")) == {"a/table-1/mass"}


def test_two_patterns_of_one_entry_may_overlap():
    assert len(match_entries([{"ids": ["*", "*/mass"]}], IDS, "rules.yaml")) == len(IDS)


def test_an_id_that_two_entries_name_is_an_error():
    with pytest.raises(InputError, match=r"rules.yaml: 'a/table-1/mass' is matched by two entries"):
        match_entries([{"ids": ["*/mass"]}, {"ids": ["a/table-1/*"]}], IDS, "rules.yaml")


def test_an_idle_pattern_is_an_error():
    with pytest.raises(InputError, match=r"rules.yaml: '\*/speed' matches no id of values.csv"):
        match_entries([{"ids": ["*/speed"]}], IDS, "rules.yaml")
