"""The list of studies: what is wrong in a ``study.yaml`` is one line that names it."""

import re

import pytest

from smallsat.catalogue import read_catalogue
from smallsat.errors import InputError
from smallsat.evidence.summary import KIND_TITLES, value_kinds

GOOD = "order: {order}\ntitle: A note\nsubject: Orbits\nvalues: 3\nartefacts: 1\n"


def write(folder, name, content):
    (folder / name).mkdir()
    (folder / name / "study.yaml").write_text(content)


def test_studies_come_in_their_order(tmp_path):
    write(tmp_path, "a", GOOD.format(order=2))
    write(tmp_path, "b", GOOD.format(order=1))
    (tmp_path / "no-study").mkdir()
    assert [study.name for study in read_catalogue(tmp_path)] == ["b", "a"]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (GOOD.format(order=1), "b/study.yaml: 'order' is 1, as that of a; give every study"),
        (GOOD.format(order="first"), "b/study.yaml: 'order' is 'first'; give a whole number"),
        ("order: 2\ntitle: A note\n", "b/study.yaml: 'artefacts' is missing; add it"),
        (GOOD.format(order=2) + "auther: Kepler\n", "b/study.yaml: allowed are the keys order"),
        ("", "b/study.yaml: allowed are the keys order"),
    ],
)
def test_a_wrong_study_is_named(tmp_path, content, message):
    write(tmp_path, "a", GOOD.format(order=1))
    write(tmp_path, "b", content)
    with pytest.raises(InputError, match=message):
        read_catalogue(tmp_path)


def test_the_table_of_the_readme_follows_from_the_list(root):
    """Study, document with author and year, results, timings and inputs: a row a study, in order.

    Inputs are printed parameters, no results: nowhere may one number count both.
    """
    published, readme = root / "data/published", (root / "README.md").read_text()
    kinds = value_kinds(published)
    rows = []
    for study in read_catalogue(published):
        own = kinds[kinds.index.str.startswith(f"{study.name}/")]
        counts = [str((own == kind).sum() or "") for kind in KIND_TITLES]
        document = ", ".join(str(part) for part in (study.title, study.author, study.year) if part)
        assert len(own) == study.values
        rows.append(
            " ".join(f"| {cell} ".rstrip() for cell in (f"`{study.name}`", document, *counts))
            + " |"
        )
    assert "\n".join(rows) in readme
    totals = ", ".join(f"{(kinds == kind).sum()} {kind}s" for kind in KIND_TITLES)
    assert f"published values with stable ids: {totals}" in (root / "docs/verdicts.md").read_text()


def test_no_study_is_named_outside_its_own_folders(root):
    """The list of studies is the folders: code that all share knows none of them by name."""
    names = [study.name for study in read_catalogue(root / "data/published")]
    shared = [
        root / "Snakefile",
        *[root / f"rules/{name}.smk" for name in ("common", "notebooks", "evidence", "report")],
        *(root / "src/smallsat").glob("*.py"),
        *[
            path
            for folder in ("workflow", "evidence", "report", "drawing", "statistics")
            for path in (root / "src/smallsat" / folder).glob("*.py")
        ],
    ]
    word = re.compile(rf"""["'/.]({"|".join(names)})["'/.]""")
    named = [
        f"{path.relative_to(root)}: {line.strip()}"
        for path in shared
        for line in path.read_text().splitlines()
        if word.search(line) and not line.startswith("#") and "such as" not in line
    ]
    assert named == []
