"""Value tables: which rows a table has, what is said once for all of them, and lettered remarks."""

from math import nan

import pandas as pd

from smallsat.report.inputs import input_groups
from smallsat.report.values import of_table, read_findings, value_table
from smallsat.results import write_table


def verdicts(**columns: list) -> pd.DataFrame:
    rows = len(next(iter(columns.values())))
    blank = {
        "locator": "Table 1",
        "quantity": "time",
        "case": "",
        "component": "",
        "printed": "1.0",
        "computed": 1.0,
        "unit": "",
        "difference": 0.0,
        "verdict": "reproduced",
        "reason": "equal to the printed digits",
        "seconds": nan,
    }
    return pd.DataFrame({name: [value] * rows for name, value in blank.items()} | columns)


def test_a_table_has_its_own_rows_and_its_footnote_but_not_those_of_table_10():
    table = verdicts(locator=["Table 1", "Table 1 footnote", "Table 10", "Section 1"])
    assert list(of_table(table, "Table 1")["locator"]) == ["Table 1", "Table 1 footnote"]


def test_literals_are_read_as_printed_and_empty_columns_as_empty_text(tmp_path):
    write_table(verdicts(printed=["0.75550", "1.0"], computed=[0.7555, nan]), tmp_path / "v.csv")
    table = read_findings(tmp_path / "v.csv")
    assert list(table["printed"]) == ["0.75550", "1.0"]
    assert list(table["case"]) == ["", ""]
    assert table["computed"].dtype == float


def test_words_that_all_cases_share_are_given_once():
    table = value_table(verdicts(case=["Direct Shooting N=2", "Direct Shooting N=3"]))
    assert table["shared"] == {"case": "Direct Shooting"}
    assert [row["case"] for row in table["rows"]] == ["N=2", "N=3"]


def test_a_case_that_is_the_shared_words_keeps_a_word():
    table = value_table(verdicts(case=["sun pointing", "sun pointing slow"]))
    assert [row["case"] for row in table["rows"]] == ["pointing", "pointing slow"]


def test_equal_cases_and_units_are_given_once():
    table = value_table(verdicts(case=["sun", "sun"], unit=["km", "km"]))
    assert table["shared"] == {"case": "sun", "unit": "km"}
    assert {row["unit"] for row in table["rows"]} == {""}


def test_a_case_that_only_some_rows_have_is_not_shared():
    assert value_table(verdicts(case=["", "sun pointing"]))["shared"] == {}


def test_a_repeated_remark_is_one_letter_and_the_obvious_one_is_left_out():
    reasons = ["early stopping", "equal to the printed digits", "copied row", "early stopping"]
    table = value_table(verdicts(reason=reasons))
    assert [row["note"] for row in table["rows"]] == ["a", "", "b", "a"]
    assert table["notes"] == [
        {"letter": "a", "text": "early stopping"},
        {"letter": "b", "text": "copied row"},
    ]


def test_remarks_that_differ_in_a_residual_only_are_one_with_the_largest():
    reasons = [f"shorter; constraints met to {r} in a check" for r in ("9e-12", "3e-11", "9e-12")]
    table = value_table(verdicts(reason=reasons))
    (note,) = table["notes"]
    assert note["text"] == "shorter; constraints met to 3e-11 or better in a check"
    single = value_table(verdicts(reason=reasons[:1]))
    assert single["notes"][0]["text"] == reasons[0]


def test_our_seconds_stand_beside_printed_seconds():
    table = value_table(verdicts(printed=["0.156104"], computed=[nan], seconds=[0.0123456]))
    assert table["rows"][0]["computed"] == "0.0123"


def test_inputs_are_grouped_by_what_they_feed_those_that_feed_nothing_last():
    groups = input_groups(
        verdicts(
            locator=["Listing 1", "Listing 4", "Table 2", "Listing 10"],
            printed=["1e5", "1.5", "1.5", "1.50"],
            verdict=["context", "reproduced", "reproduced", "reproduced"],
            reason=["not a parameter of ours: an option", *["feeds transfer.radius"] * 3],
        )
    )
    assert [group["name"] for group in groups] == ["transfer.radius", "an option"]
    assert groups[0]["printed"] == ["1.5", "1.50"]
    assert groups[0]["places"] == ["Listings 4, 10", "Table 2"]
    assert groups[0]["values"] == 3
    assert not groups[1]["ours"]
