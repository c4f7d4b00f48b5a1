"""What `make explain` says of a value, an erratum, a claim, a table and a figure."""

import re
import subprocess
import sys

import pytest

from smallsat.errors import InputError
from smallsat.evidence.reference import resolve
from smallsat.report.values import read_findings
from smallsat.workflow.explain import explained, known_of, named, subjects


@pytest.fixture(scope="module")
def known(root):
    return subjects(root / "data/published")


def lines_of(text):
    """The labelled lines of an explanation."""
    joined = re.sub(r"\n {14}", " ", text)
    return dict(line.strip().split(maxsplit=1) for line in joined.splitlines()[1:])


def test_every_name_means_one_thing(known):
    """So that a whole name needs no choice."""
    names = [subject.name for subject in known]
    assert len(set(names)) == len(names)


def test_a_value_has_its_verdict_and_its_code(known, root, tested_run):
    """As the verdicts say; the code is the function at that line."""
    (subject,) = named(known, "mars/table-8/sigma-b-n-at-t-4400-s/full-mission/1")
    said = lines_of(explained(subject, root, tested_run))
    assert said["printed"] == "-0.443"
    assert said["verdict"] == "erratum"
    assert said["erratum"] == "mars/errata/table-8-sigma-1"
    path, line, function = re.fullmatch(r"(\S+):(\d+) \((\w+)\)", said["code"]).groups()
    assert f"def {function}(" in (root / path).read_text().splitlines()[int(line) - 1]


def test_every_computed_value_knows_its_code(tested_run):
    """The function that made it, for every value that is computed and no input of ours."""
    table = read_findings(tested_run / "data/results/verdicts.csv")
    computed = table[table["computed"].notna() & ~table["reason"].str.startswith("feeds ")]
    sources = computed["source"]
    known = sources[sources != ""]
    assert len(known) > len(sources) / 2
    for source in set(known):
        assert callable(resolve(source, "verdicts.csv")), source


@pytest.mark.parametrize(
    ("name", "labels"),
    [
        ("mars/claims/line-of-sight", {"claim", "outcome", "evidence", "code", "again"}),
        ("mars/errata/table-8-sigma-1", {"printed", "correct", "proof", "holds", "code", "again"}),
        ("slew/fig-12", {"caption", "file", "notebook", "reads", "again"}),
        ("transfer/table-4", {"caption", "file", "notebook", "reads", "again"}),
    ],
)
def test_the_other_sorts(known, root, tested_run, name, labels):
    """Everything that there is to say of an erratum, a claim, a figure and a table."""
    (subject,) = named(known, name)
    assert labels <= set(lines_of(explained(subject, root, tested_run)))


def test_without_a_build(known, root, tmp_path):
    """It says so, and which command builds it."""
    firsts = {(subject.study.name, subject.sort): subject for subject in known}
    for subject in firsts.values():
        text = explained(subject, root, tmp_path)
        assert "not built yet" in text
        assert "snakemake --force" in text


def test_again_in_a_run_of_its_own(known, root, tested_run):
    """The command makes the reproduction anew; a what-if needs its configuration too."""
    again = {run: [*dict(known_of(known[0], root, run))][-1] for run in (root, tested_run)}
    assert again == {root: "again", tested_run: "with"}


def test_a_part_of_a_name(known):
    """A unique part suffices, an end goes before a middle, and several are listed."""
    assert [one.name for one in named(known, "LINE-OF-SIGHT")] == ["mars/claims/line-of-sight"]
    assert "mars/fig-10" in [one.name for one in named(known, "fig-10")]
    assert [one.name for one in named(known, "mars/table-8")] == ["mars/table-8"]


@pytest.mark.parametrize(
    ("text", "says"), [("mars/tabel-8", "did you mean mars/table-8"), ("", "no name")]
)
def test_nothing_has_that_name(known, text, says):
    """One line, with the nearest."""
    with pytest.raises(InputError, match=says):
        named(known, text)


def test_on_the_terminal(root):
    """Several are listed, with how many more there are."""
    command = [sys.executable, "-m", "smallsat", "explain", "rendezvous/table"]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True)
    assert "give more of one" in done.stdout.splitlines()[0]
    assert "more" in done.stdout.splitlines()[-1]
