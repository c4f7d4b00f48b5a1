"""Errata, claims and the commands: prove and judge a study, merge all, summarise, exit status."""

import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest
import yaml

from smallsat.config import as_json
from smallsat.errors import InputError
from smallsat.evidence.claims import judge_claims, judged
from smallsat.evidence.errata import Proof, prove_errata
from smallsat.evidence.grounds import Grounds
from smallsat.evidence.ledger import ARTEFACT_COLUMNS, VALUE_COLUMNS, Ledger
from smallsat.evidence.observation import Observation, observations_table
from smallsat.evidence.summary import failures, value_kinds, verdict_counts
from smallsat.evidence.verdicts import VERDICTS
from smallsat.quantities import Part
from smallsat.results import read_table, write_table

HERE = "tests_of_commands"


@pytest.fixture(autouse=True)
def importable(monkeypatch):
    """Proofs and predicates are named by module; this one goes by the name `HERE`."""
    monkeypatch.setitem(sys.modules, HERE, sys.modules[__name__])


def proof_of_sign(grounds: Grounds) -> Proof:
    sign = grounds.section.sign
    return Proof(sign < 0, "1", "-1", f"the sign is {sign}", grounds.section.correct)


def sign_is_negative(grounds: Grounds):
    return judged(grounds.section.sign < 0, f"sign {grounds.section.sign}")


class Made(Part):
    """A section of a study."""

    sign: int = 1
    correct: float | str = ""


def given(**section) -> Grounds:
    return Grounds(Made(**section), Path("nowhere"), Ledger([], "transfer"), {})


@pytest.mark.parametrize(("sign", "holds"), [(-1, True), (1, False)])
def test_an_erratum_holds_if_its_proof_does(sign, holds):
    entry = {"key": "sign", "locator": "Eq. 1", "printed": "+", "correct": "-"}
    entries = [entry | {"proof": f"{HERE}:proof_of_sign"}]
    (row,) = prove_errata(entries, given(sign=sign), "errata.yaml").itertuples()
    assert row.holds is holds
    assert (row.key, row.explanation, row.as_corrected) == ("sign", "", "-1")


@pytest.mark.parametrize(
    ("entry", "computed", "holds", "shown"),
    [
        ({"correct": "-0.433"}, -0.43301, True, "-0.433"),
        ({"correct": "-0.443"}, -0.43301, False, "-0.443"),
        ({"correct": "+0.4698"}, 0.46984, True, "+0.4698"),
        ({"correct": "36.7 %"}, 36.747, True, "36.7 %"),
        ({"correct": "36.8 %"}, 36.747, False, "36.8 %"),
        ({"correct": "v_e = 1.8658344"}, 1.8658344, True, "v_e = 1.8658344"),
        (
            {"correct": "0.026 % at K = 2, from Table 4"},
            0.0262,
            True,
            "0.026 % at K = 2, from Table 4",
        ),
        ({"correct": -0.001533}, -0.0015331, True, -0.001533),
        ({"correct": "(1/36)/5"}, 1 / 180, True, "(1/36)/5"),
        ({"correct": "(1/36)/5"}, 1 / 181, False, "(1/36)/5"),
        # Words are the proof's where the entry has none, and the entry's where the proof has none.
        ({}, "N = 4", True, "N = 4"),
        ({"correct": "N = 5"}, "N = 4", False, "N = 5"),
        ({"correct": "u' R u"}, "", True, "u' R u"),
    ],
)
def test_a_correction_must_be_what_the_proof_computes(entry, computed, holds, shown):
    """A number to its own digits; where it is another, the erratum does not hold and says so."""
    entry = {"key": "sign", "locator": "Eq. 1", "printed": "+", **entry}
    entries = [entry | {"proof": f"{HERE}:proof_of_sign"}]
    found = prove_errata(entries, given(sign=-1, correct=computed), "errata.yaml")
    (row,) = found.itertuples()
    assert (row.holds, row.correct) == (holds, shown)
    assert ("is not what the proof finds" in row.statement) is not holds


def test_a_correction_without_its_number_is_named():
    entries = [{"key": "sign", "correct": "another", "proof": f"{HERE}:proof_of_sign"}]
    with pytest.raises(InputError, match="'sign': 'correct' is 'another'; needed: the number"):
        prove_errata(entries, given(sign=-1, correct=2.0), "errata.yaml")


@pytest.mark.parametrize(("sign", "outcome"), [(-1, "holds"), (1, "fails")])
def test_a_claim_is_judged_by_its_predicate(sign, outcome):
    entries = [
        {"id": "c", "locator": "Eq. 1", "claim": "down", "predicate": f"{HERE}:sign_is_negative"}
    ]
    (row,) = judge_claims(entries, given(sign=sign), "claims.yaml").itertuples()
    assert (row.outcome, row.evidence) == (outcome, f"sign {sign}")


@pytest.mark.parametrize("name", [f"{HERE}:no_such", "no.such.module:f", "no colon"])
def test_a_proof_that_does_not_exist_is_named(name):
    with pytest.raises(InputError, match=r"errata.yaml: '.*' does not exist"):
        prove_errata([{"key": "k", "proof": name}], given(), "errata.yaml")


LEDGER = """\
transfer/a,Table 1,time,,,3.25,s,result,
transfer/b,Table 1,radius,,,1.5,,input,
transfer/c,Table 1,elapsed,,,0.1,s,timing,
"""


@pytest.fixture
def published(tmp_path):
    """A small ledger with one study."""
    folder = tmp_path / "published"
    (folder / "transfer").mkdir(parents=True)
    (folder / "transfer/values.csv").write_text(",".join(VALUE_COLUMNS) + "\n" + LEDGER)
    (folder / "transfer/study.yaml").write_text(
        "{order: 1, title: A paper, subject: Transfers, values: 4, artefacts: 3}"
    )
    (folder / "transfer/artefacts.csv").write_text(",".join(ARTEFACT_COLUMNS) + "\n")
    entries = {
        "rules": [],
        "errata": [],
        "claims": [],
        "bindings": [{"ids": ["transfer/b"], "config": "transfer.problem.final_radius"}],
    }
    for name, content in entries.items():
        (folder / f"transfer/{name}.yaml").write_text(yaml.safe_dump(content))
    return folder


def evidence(*arguments):
    command = [sys.executable, "-m", "smallsat", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(("time", "status"), [(3.2461, 0), (3.3, 1)])
def test_from_observations_to_a_summary(published, tmp_path, config, time, status):
    """A study is judged, merged, and a mismatch makes the summary fail."""
    results = tmp_path / "transfer"
    write_table(observations_table([Observation("transfer/a", time)]), results / "observations.csv")
    study = ["judge", "--config", as_json(config.transfer), "--published", published / "transfer"]
    assert evidence(*study, "--results", results).returncode == 0
    merged = tmp_path / "verdicts.csv"
    assert evidence("merge", results / "verdicts.csv", "--output", merged).returncode == 0

    verdicts = read_table(merged).set_index("id")["verdict"]
    assert list(verdicts.index) == ["transfer/a", "transfer/b", "transfer/c"]
    assert verdicts["transfer/a"] == ("mismatch" if status else "reproduced")
    assert list(verdicts[1:]) == ["reproduced", "context"]

    summary = evidence("summary", merged, "--published", published)
    assert summary.returncode == status
    for count in (
        f"1 of 1 results have a verdict, {status} of",
        "1 of 1 inputs have a verdict, 0 of",
    ):
        assert count in summary.stdout
    # Each kind has a table of its own; an input that is our own configuration is no result.
    results_table, _, inputs_table = summary.stdout.split("\n\n")[:3]
    assert results_table.startswith("Results\n") and inputs_table.startswith("Inputs, compared")
    found = [int(table.split()[-len(VERDICTS) - 1]) for table in (results_table, inputs_table)]
    assert found == [0 if status else 1, 1]
    assert ("transfer/a: printed 3.25, computed 3.3" in summary.stdout) == bool(status)
    assert evidence("summary", merged, "--published", published, "--what-if").returncode == 0


def test_missing_observations_are_one_line_and_status_2(published, tmp_path, config):
    study = ["judge", "--config", as_json(config.transfer), "--published", published / "transfer"]
    run = evidence(*study, "--results", tmp_path / "none")
    assert run.returncode == 2
    assert run.stderr.startswith("smallsat: ")
    assert "observations.csv: no such results file; run `snakemake" in run.stderr
    assert run.stderr.count("\n") == 1


def test_counts_have_a_column_for_each_verdict_and_failures_are_mismatches(published):
    kinds = value_kinds(published)
    verdicts = pd.DataFrame(
        {"id": kinds.index, "document": "transfer", "verdict": ["mismatch", "none such", "pending"]}
    )
    counts = verdict_counts(verdicts, kinds)
    assert counts.loc[("transfer", "result"), "mismatch"] == 1
    assert counts.loc[("transfer", "timing"), "pending"] == 1
    assert list(counts.columns)[-2:] == ["mismatch", "pending"]
    assert list(failures(verdicts)["id"]) == ["transfer/a", "transfer/b"]
