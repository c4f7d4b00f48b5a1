"""What each claim and each proof came to is pinned in ``data/accepted/<study>``: a flip is shown.

``claims.csv`` has two outcomes a claim: of the reproduction, and of the run that `make test` makes,
in which the Monte Carlo parts have a share of their samples and some claims stay undecided.
``errata.csv`` says whether a proof holds, in either run.
"""

import pandas as pd
import pytest

ACCEPT = (
    "if the change is right, edit {file} in a commit that says why it changed; "
    "if not, find what changed it"
)


def flips(accepted, found, name, column, file):
    """Lines that say what differs from the accepted outcomes; none where all is as accepted.

    Parameters
    ----------
    accepted, found
        Outcome by (study, name); what was found with its evidence, as columns of a frame.
    """
    lines = []
    for key in sorted(set(accepted) | set(found.index)):
        before = accepted.get(key, "not listed")
        now = found.loc[key, column] if key in found.index else "no longer judged"
        if before != now:
            evidence = found.loc[key, name] if key in found.index else ""
            lines.append(f"{key[0]}: {key[1]}: accepted {before}, now {now}: {evidence}")
    return [*lines, ACCEPT.format(file=file)] if lines else []


def accepted_of(root, file, name, column):
    tables = [
        pd.read_csv(path, dtype=str).assign(study=path.parent.name)
        for path in sorted(root.glob(file))
    ]
    table = pd.concat(tables).fillna("nothing yet").set_index(["study", name])
    assert table.index.is_unique
    return table[column].to_dict()


def found_in(run, table, name):
    paths = sorted((run / "data/results").glob(f"*/{table}.csv"))
    frames = [pd.read_csv(path).assign(study=path.parent.name) for path in paths]
    return pd.concat(frames).set_index(["study", name])


@pytest.fixture(params=["share", "reproduction"])
def judged_run(request, root):
    """The run of `make test`, and the reproduction where it is there."""
    if request.param == "share":
        return request.getfixturevalue("tested_run"), "outcome_of_a_share"
    if not (root / "data/results/verdicts.csv").exists():
        pytest.skip("the reproduction is not built here")
    return root, "outcome"


def test_no_claim_flips(root, judged_run):
    """Every claim has its accepted outcome."""
    run, column = judged_run
    file = "data/accepted/*/claims.csv"
    accepted = accepted_of(root, file, "id", column)
    found = flips(accepted, found_in(run, "claims", "id"), "evidence", "outcome", file)
    assert not found, "\n".join(found)


def test_no_proof_flips(root, judged_run):
    """Every proof holds or fails as accepted."""
    run, _ = judged_run
    file = "data/accepted/*/errata.csv"
    accepted = accepted_of(root, file, "key", "holds")
    found = found_in(run, "errata", "key").astype({"holds": str})
    found = flips(accepted, found, "statement", "holds", file)
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    ("outcomes", "words"),
    [
        ({"a": "holds"}, []),
        ({"a": "fails"}, ["mars: a: accepted holds, now fails: because", "data/accepted/x.csv"]),
        ({"a": "holds", "b": "holds"}, ["mars: b: accepted not listed, now holds"]),
        ({}, ["mars: a: accepted holds, now no longer judged"]),
    ],
)
def test_a_flip_is_shown(outcomes, words):
    """A changed outcome, a new claim and a lost one are lines; the last says how to accept."""
    keys = pd.MultiIndex.from_tuples([("mars", key) for key in outcomes], names=["study", "id"])
    found = pd.DataFrame({"outcome": list(outcomes.values()), "evidence": "because"}, index=keys)
    file = "data/accepted/x.csv"
    text = "\n".join(flips({("mars", "a"): "holds"}, found, "evidence", "outcome", file))
    assert bool(text) == bool(words)
    assert all(word in text for word in words)
