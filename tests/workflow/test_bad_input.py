"""Bad input: one line that names the key or file, the value, what is allowed and what to do."""

import pytest


def test_configuration(project):
    """A wrong key is refused before anything runs; tests/test_run.py has the other sorts."""
    line = project.refusal("--config", 'transfer={"problm": {"thrust": 0.2}}')
    for word in ("transfer.problm", "unknown", "'problem'"):
        assert word in line, line


def test_configuration_file(project):
    """A file that is no YAML is refused by its name, in one line."""
    (project.folder / "broken.yaml").write_text("transfer: [1\n")
    assert "broken.yaml: line 2: not valid YAML" in project.refusal("--configfile", "broken.yaml")


def test_past_the_environments_own_command(project):
    """``python -m snakemake`` reads as strictly: a section twice is refused there too."""
    (project.folder / "twice.yaml").write_text("mars: {}\nmars: {}\n")
    python = str(project.folder / ".venv/bin/python")
    done = project.run([python, "-m", "snakemake", "-n", "--configfile", "twice.yaml"])
    assert done.returncode != 0
    assert "smallsat: " in done.stderr and "twice.yaml: line 2" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_file_that_is_none(project):
    """No such file, or a folder: one line."""
    assert "no such file" in project.refusal("--configfile", "none.yaml")
    assert "a folder" in project.refusal("--configfile", "config")


def test_a_setting_that_is_none(project):
    """A word after --config without a key, or with one that is no name."""
    assert "give key=value" in project.refusal("--config", "transfer")
    assert "give key=value" in project.refusal("--config", "1a=2")


@pytest.mark.parametrize(
    ("target", "words"),
    [
        ("trasnfer", ("trasnfer", "transfer, mars")),
        (
            "figures/transfer/fig-99.svg",
            ("fig-99", "did you mean 'figures/transfer/fig-"),
        ),
        ("data/results/transfer/tables/table-9.csv", ("table-9", "table-4.csv")),
    ],
)
def test_unknown_target(project, target, words):
    """A study, figure or table that does not exist is answered with what does."""
    line = project.refusal(target)
    for word in words:
        assert word in line, line


def _damaged(text: str, damage: str) -> str:
    lines = text.splitlines(keepends=True)
    if damage == "duplicate id":
        return "".join([*lines, lines[5]])
    if damage == "missing column":
        return text.replace("printed", "value", 1)
    # The first result row whose printed value is a plain decimal.
    place = next(i for i, line in enumerate(lines) if ",3.24694," in line)
    lines[place] = lines[place].replace("3.24694", "3.24x94")
    return "".join(lines)


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        ("duplicate id", ("duplicate id", "line 480")),
        ("missing column", ("column 'printed' is missing",)),
        ("unparsable number", ("'3.24x94'", "no number")),
    ],
)
def test_damaged_ledger(project, damage, words):
    """The ledger is checked before anything runs; nothing is lost by it."""
    path = project.folder / "data/published/transfer/values.csv"
    intact = path.read_text()
    path.write_text(_damaged(intact, damage))
    try:
        line = project.refusal()
    finally:
        path.write_text(intact)
    assert "values.csv" in line
    for word in words:
        assert word in line, line
