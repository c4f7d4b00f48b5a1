"""The ledger: damage of any kind is one line that names file, line and what is allowed."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

from smallsat.catalogue import read_catalogue
from smallsat.errors import InputError
from smallsat.evidence.ledger import (
    ARTEFACT_COLUMNS,
    VALUE_COLUMNS,
    Ledger,
    read_artefacts,
    read_ledger,
    read_published,
)

HEADER = ",".join(VALUE_COLUMNS)
ROW = "transfer/table-1/time,Table 1,time,case,,3.24694,s,result,"
ARTEFACT = "Table 1,table,Performance,computed,data/results/transfer/tables/table-1.csv"
PUBLISHED = Path(__file__).parents[2] / "data/published"


def ledger(tmp_path, *rows, header=HEADER):
    path = tmp_path / "values.csv"
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


@pytest.mark.parametrize("study", read_catalogue(PUBLISHED), ids=lambda study: study.name)
def test_the_real_ledgers_are_whole(study):
    """Every published number and artefact is there: none may be lost in an edit."""
    values, artefacts = read_published(PUBLISHED, study)
    assert (len(values), len(artefacts)) == (study.values, study.artefacts)
    with pytest.raises(InputError, match=r"values.csv: \d+ rows, but study.yaml says values: 1;"):
        read_published(PUBLISHED, replace(study, values=1))


def test_a_good_row_is_read_as_text(tmp_path):
    (row,) = read_ledger(ledger(tmp_path, ROW))
    assert row["printed"] == "3.24694"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (",result,", ",guess,", "line 2: 'kind' is 'guess'; allowed: input, result, timing"),
        ("3.24694", "3.24.694", "line 2: 'printed' is '3.24.694', which is no number"),
        ("3.24694", "", "line 2: 'printed' is empty; write (illegible) if lost"),
        (",result,", ",result", "line 2: not 9 fields"),
        (",result,", ",result,,,", "line 2: not 9 fields"),
    ],
)
def test_a_damaged_row_is_named_by_its_line(tmp_path, old, new, message):
    path = ledger(tmp_path, ROW.replace(old, new))
    with pytest.raises(InputError, match=re.escape(message)) as caught:
        read_ledger(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_words_and_lost_values_are_allowed_and_inputs_may_be_anything(tmp_path):
    rows = [
        ROW.replace("3.24694", "Twenty"),
        ROW.replace("time,Table", "time/2,Table").replace("3.24694", "(illegible)"),
        ROW.replace("time,Table", "time/3,Table")
        .replace("3.24694", "2 or 3")
        .replace("result", "input"),
    ]
    assert len(read_ledger(ledger(tmp_path, *rows))) == 3


def test_a_duplicate_id_is_named(tmp_path):
    with pytest.raises(InputError, match="line 3: duplicate id 'transfer/table-1/time'"):
        read_ledger(ledger(tmp_path, ROW, ROW))


def test_a_missing_column_is_named(tmp_path):
    path = ledger(tmp_path, ROW, header=HEADER.replace("printed", "value"))
    with pytest.raises(InputError, match="column 'printed' is missing; needed: id, locator"):
        read_ledger(path)


def test_a_missing_file_says_where_to_get_it(tmp_path):
    with pytest.raises(InputError, match="no such file; restore it from the repository"):
        read_ledger(tmp_path / "values.csv")


def test_bytes_that_are_no_text_are_said_to_be_none(tmp_path):
    path = tmp_path / "values.csv"
    path.write_bytes(b"\xff\xfe\x00binary")
    with pytest.raises(InputError, match="not a CSV file"):
        read_ledger(path)


def test_artefacts_may_have_no_target_yet_but_occur_once(tmp_path):
    path = tmp_path / "artefacts.csv"
    header = ",".join(ARTEFACT_COLUMNS)
    path.write_text(f"{header}\n{ARTEFACT}\nTable 2,table,Results,computed,\n")
    assert [row["target"] == "" for row in read_artefacts(path)] == [False, True]
    path.write_text(f"{header}\n{ARTEFACT}\n{ARTEFACT}\n")
    with pytest.raises(InputError, match="duplicate id 'Table 1'"):
        read_artefacts(path)
    path.write_text(f"{header}\n{ARTEFACT.replace('table,', 'poem,')}\n")
    with pytest.raises(InputError, match="'kind' is 'poem'; allowed: table, figure, animation"):
        read_artefacts(path)


PLACES = {"mars/r/x": "-669.3", "mars/r/y": "3227.5", "mars/r/z/min": "1", "mars/name": "Eeny"}


@pytest.fixture
def places():
    rows = [{"id": name, "document": "mars", "printed": text} for name, text in PLACES.items()]
    return Ledger(rows, "mars")


def test_a_ledger_is_asked_by_ids_of_its_document(places):
    """Numbers with their digits, text, and the components of a place in their order."""
    assert places.value("r/x").value == -669.3
    assert places.value("r/x").half_unit == pytest.approx(0.05)
    assert places.literal("name") == "Eeny"
    assert [float(one) for one in places.values("r")] == [-669.3, 3227.5]
    assert len(places.rows) == 4


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda ledger: ledger.value("r/q"), "no id 'mars/r/q'"),
        (lambda ledger: ledger.literal("slew/r/x"), "no id 'mars/slew/r/x'"),
        (lambda ledger: ledger.values("v"), "no id 'mars/v/...'"),
        (lambda ledger: ledger.value("name"), "'mars/name': 'Eeny' is no number"),
    ],
)
def test_what_a_ledger_does_not_have_is_named(places, ask, message):
    with pytest.raises(InputError, match=message):
        ask(places)
