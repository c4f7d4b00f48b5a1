"""What each value, claim and proof came to is pinned in ``data/accepted``: a flip is shown."""

import pandas as pd
import pytest

from smallsat.errors import InputError
from smallsat.evidence.accept import accept
from smallsat.evidence.accepted import SHARE, findings, flipped, movement_text
from smallsat.results import read_table, write_table


@pytest.fixture(params=["share", "reproduction"])
def judged_run(request, root):
    """The run of `make test`, and the reproduction where it is there."""
    if request.param == "share":
        return request.getfixturevalue("tested_run"), SHARE
    if not (root / "data/results/verdicts.csv").exists():
        pytest.skip("the reproduction is not built here")
    return root, ""


def test_no_outcome_flips(root, judged_run):
    """Every printed value, claim and proof is judged as accepted, and none is new or lost."""
    run, of = judged_run
    before, now = findings(root / "data/accepted", of), findings(run / "data/results")
    assert not len(flipped(before, now)), movement_text(before, now)
    assert set(before.index) == set(now.index), (
        "if right, in the full build: make accept REASON=..."
    )


@pytest.fixture
def made(tmp_path):
    """Writes results of one study: verdict and computed of a value, outcome of a claim."""

    def write(folder, computed=1.0, verdict="reproduced", outcome="holds", key="velocity"):
        study = tmp_path / folder / "mars"
        values = {"id": ["mars/a", "mars/b"], "computed": [computed, None]}
        write_table(
            pd.DataFrame(values | {"verdict": [verdict, "context"]}), study / "verdicts.csv"
        )
        claims = pd.DataFrame({"id": [key], "outcome": [outcome], "evidence": "because"})
        write_table(claims, study / "claims.csv")
        write_table(pd.DataFrame({"key": ["sign"], "holds": [True]}), study / "errata.csv")
        return tmp_path / folder

    return write


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, ["Nothing has moved."]),
        ({"computed": 1.0 + 1e-11}, ["1 values moved within rounding"]),
        ({"computed": 1.25}, ["1 values moved, the largest first:", "mars/a: 1, now 1.25 (20 %)"]),
        ({"computed": None}, ["mars/a: 1, now nan"]),
        ({"verdict": "mismatch"}, ["1 outcomes are not", "mars/a: reproduced, now mismatch"]),
        ({"outcome": "fails"}, ["mars/claims/velocity: holds, now fails"]),
        ({"key": "other"}, ["1 findings are new", "1 findings are accepted and not found"]),
    ],
)
def test_what_moved_is_said(made, changes, words):
    """By how much, the largest first; flips and what is new or lost by name or number."""
    text = movement_text(findings(made("before")), findings(made("now", **changes)))
    assert all(word in text for word in words), text


def test_accepted_results_are_what_was_found(made, tmp_path):
    """Afterwards nothing has moved, of both runs; a line says when, why and how much changed."""
    results, share, accepted = (
        made("results"),
        made("share", outcome="undecided"),
        tmp_path / "kept",
    )
    accept(results, share, accepted, "first", "2026-01-01")
    accept(
        made("results", computed=2.0, outcome="fails"),
        share,
        accepted,
        "of  the\nair",
        "2026-01-02",
    )
    assert movement_text(findings(accepted), findings(results)) == "Nothing has moved."
    assert movement_text(findings(accepted, SHARE), findings(share)).count("moved") == 1
    assert not len(flipped(findings(accepted, SHARE), findings(share)))
    last = read_table(accepted / "releases.csv").iloc[-1].to_dict()
    assert last == {"date": "2026-01-02", "reason": "of the air", "outcomes": 1, "values": 1}


def test_what_is_not_accepted(made, tmp_path):
    """Results without a reason, and a wrong verdict, are refused in a line; nothing is written."""
    with pytest.raises(InputError, match="no reason"):
        accept(made("results"), made("share"), tmp_path / "kept", " ", "2026-01-01")
    with pytest.raises(InputError, match="mars/a: its verdict is wrong"):
        accept(made("results", verdict="mismatch"), made("share"), tmp_path / "kept", "x", "")
    assert not (tmp_path / "kept").exists()
