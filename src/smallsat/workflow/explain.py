"""Say all that is known of a printed value, an erratum, a claim, a table or a figure."""

import argparse
import difflib
import inspect
import textwrap
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from smallsat.catalogue import Study, read_catalogue
from smallsat.errors import InputError
from smallsat.evidence.bindings import binding_name
from smallsat.evidence.ledger import read_published
from smallsat.evidence.patterns import names
from smallsat.evidence.reference import resolve
from smallsat.report.values import read_findings, records
from smallsat.strict_yaml import read_yaml
from smallsat.workflow.figures import NotebookRun, read_runs

WIDTH = 100
LABEL = 12
# So many are listed where a name has several meanings.
LISTED = 20

Lines = Iterator[tuple[str, str]]
Row = Mapping[str, Any]


@dataclass(frozen=True)
class Subject:
    """Something that can be explained.

    Attributes
    ----------
    name
        Unique: the id of a value, or its study and key, such as ``mars/claims/velocity``.
    sort
        ``value``, ``erratum``, ``claim`` or ``artefact``.
    row
        Its row of the published values or artefacts, or its entry of the YAML file.
    """

    name: str
    sort: str
    study: Study
    row: Row


def subjects(published: Path) -> list[Subject]:
    """All that can be explained, in the order of the report.

    Parameters
    ----------
    published
        Folder ``data/published``.
    """
    found = []
    for study in read_catalogue(published):
        values, artefacts = read_published(published, study)
        found += [Subject(row["id"], "value", study, row) for row in values]
        found += [Subject(_artefact_name(study, row), "artefact", study, row) for row in artefacts]
        for file, sort, key in (("errata", "erratum", "key"), ("claims", "claim", "id")):
            for entry in read_yaml(published / study.name / f"{file}.yaml") or []:
                name = f"{study.name}/{file}/{entry[key]}"
                found.append(Subject(name, sort, study, entry))
    return found


def _artefact_name(study: Study, row: Row) -> str:
    """Study and file without its ending, such as ``mars/fig-10``; where none is made, its id."""
    return f"{study.name}/{Path(row['target']).stem or row['id']}"


def named(known: list[Subject], text: str) -> list[Subject]:
    """What a name or a part of one means: the whole name first, then its end, then any part.

    Raises
    ------
    InputError
        If it means nothing, with the nearest names.
    """
    wanted = text.lower()
    if not wanted:
        raise InputError("explain: no name; give an id or a part of one: make explain ID=table-8")
    for means in (
        lambda name: name == wanted,
        lambda name: name.endswith(f"/{wanted}"),
        lambda name: wanted in name,
    ):
        if found := [subject for subject in known if means(subject.name.lower())]:
            return found
    names = [subject.name for subject in known]
    close = difflib.get_close_matches(wanted, names, n=3, cutoff=0.4)
    hint = f"did you mean {' or '.join(close)}?" if close else "ids stand in data/published"
    raise InputError(
        f"'{text}': no printed value, erratum, claim, table or figure has this in its name; {hint}"
    )


def known_of(subject: Subject, project: Path, run: Path) -> list[tuple[str, str]]:
    """All that is known of a subject: label and text of each thing that there is to say.

    Parameters
    ----------
    project
        Folder of the project, with ``data/published``.
    run
        Folder of the run, with ``data/results``.
    """
    study = subject.study
    document = ", ".join(str(word) for word in (study.author, study.title, study.year) if word)
    lines = [("document", document), *EXPLAIN[subject.sort](subject, project, run)]
    if run.resolve() != project.resolve():
        lines.append(("with", "the --config or --configfile of the run"))
    return [(label, text) for label, text in lines if text]


def explained(subject: Subject, project: Path, run: Path) -> str:
    """What `known_of` finds, for the terminal."""
    lines = known_of(subject, project, run)
    return "\n".join([subject.name, *(_wrapped(label, text) for label, text in lines)])


def _value(subject: Subject, project: Path, run: Path) -> Lines:
    row, study = subject.row, subject.study.name
    published, results = project / f"data/published/{study}", run / f"data/results/{study}"
    yield "where", _join(row["locator"], row["quantity"], row["case"], row["component"])
    yield "printed", f"{row['printed']} {row['unit']}".strip()
    yield "kind", _join(row["kind"], row["note"])
    found = _finding(results / "verdicts.csv", "id", row["id"])
    if found:
        yield "computed", "" if found["computed"] == "" else f"{found['computed']} {row['unit']}"
        yield "difference", str(found["difference"])
        yield "verdict", str(found["verdict"])
        yield "why", str(found["reason"])
    else:
        yield "verdict", "not built yet"
    if rule := _entry(published, "rules", row["id"]):
        yield "rule", f"{_rule(rule)}; {rule['reason']}"
    if binding := _entry(published, "bindings", row["id"]):
        yield "feeds", binding.get("not_ours") or binding_name(binding)
    if erratum := _entry(published, "errata", row["id"]):
        yield "erratum", f"{study}/errata/{erratum['key']}"
    made = f"data/results/{study}/observations.csv"
    if source := found.get("source"):
        yield "code", _place(source, project)
        yield "data", made
    again = f"data/results/{study}/verdicts.csv" if row["kind"] == "input" else made
    yield "again", f"snakemake --force {again}"


def _erratum(subject: Subject, project: Path, run: Path) -> Lines:
    row, study = subject.row, subject.study.name
    found = _finding(run / f"data/results/{study}/errata.csv", "key", row["key"])
    yield "where", row["locator"]
    yield "printed", str(row.get("printed", ""))
    yield "correct", str(found.get("correct", row.get("correct", "")))
    yield "explanation", row["explanation"]
    yield "proof", found.get("statement", "not built yet")
    yield "holds", str(found.get("holds", ""))
    yield "values", ", ".join(row.get("ids") or [])
    yield "code", _place(row["proof"], project)
    yield "again", f"snakemake --force data/results/{study}/errata.csv"


def _claim(subject: Subject, project: Path, run: Path) -> Lines:
    row, study = subject.row, subject.study.name
    found = _finding(run / f"data/results/{study}/claims.csv", "id", row["id"])
    yield "where", row["locator"]
    yield "claim", row["claim"]
    yield "outcome", found.get("outcome", "not built yet")
    yield "evidence", found.get("evidence", "")
    yield "code", _place(row["predicate"], project)
    yield "again", f"snakemake --force data/results/{study}/claims.csv"


def _artefact(subject: Subject, project: Path, run: Path) -> Lines:
    row, study = subject.row, subject.study.name
    stem, _, suffix = row["target"].rpartition(".")
    drawings = _drawings(project / "notebooks" / study)
    drawing = next((one for one in drawings if _makes(one, stem)), None)
    yield "caption", row["caption"]
    yield "kind", _join(row["kind"], row["class"])
    yield "file", row["target"] + ("" if (run / row["target"]).exists() else " (not built yet)")
    if drawing:
        yield "notebook", f"notebooks/{study}/{drawing.notebook}.ipynb"
        yield "reads", ", ".join(f"data/results/{study}/{name}" for name in drawing.reads)
    elif suffix == "csv":
        yield "notebook", "notebooks/tables.ipynb"
        yield "reads", f"data/results/{study}/verdicts.csv"
    yield "again", f"snakemake --force {row['target']}"


EXPLAIN = {"value": _value, "erratum": _erratum, "claim": _claim, "artefact": _artefact}


@cache
def _drawings(notebooks: Path) -> list[NotebookRun]:
    return read_runs(notebooks)


def _makes(drawing: NotebookRun, stem: str) -> bool:
    return stem in drawing.stems or stem == f"figures/{drawing.study}/{drawing.film}"


def _finding(path: Path, key: str, name: str) -> dict[str, Any]:
    """The row of a table of verdicts, errata or claims; empty where it is not built."""
    return _findings(path, key).get(name, {}) if path.exists() else {}


@cache
def _findings(path: Path, key: str) -> dict[str, dict[str, Any]]:
    table = read_findings(path)
    return {row[key]: row for row in records(table.astype(object).where(table.notna(), ""))}


def _entry(published: Path, file: str, identifier: str) -> dict[str, Any]:
    """The entry of a YAML file that names an id; empty where none does."""
    entries = _entries(published / f"{file}.yaml")
    return next((entry for entry in entries if names(entry, identifier)), {})


@cache
def _entries(path: Path) -> list[dict[str, Any]]:
    return read_yaml(path) or []


def _rule(rule: dict[str, Any]) -> str:
    said = {name: value for name, value in rule.items() if name not in ("ids", "reason")}
    return ", ".join(
        name if value is True else f"{name} {value}".replace("_", " ")
        for name, value in said.items()
    )


@cache
def _place(name: str, project: Path) -> str:
    """File and line of ``package.module:function``."""
    if not name:
        return ""
    function = resolve(name, "code")
    file = Path(inspect.getsourcefile(function) or "").resolve()
    line = inspect.getsourcelines(function)[1]
    return f"{file.relative_to(project.resolve())}:{line} ({function.__name__})"


def _join(*words: str) -> str:
    return ", ".join(word for word in words if word)


def _wrapped(label: str, text: str) -> str:
    head = f"  {label:<{LABEL}}"
    return textwrap.fill(
        " ".join(text.split()),
        WIDTH,
        initial_indent=head,
        subsequent_indent=" " * len(head),
        break_long_words=False,
        break_on_hyphens=False,
    )


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``explain``."""
    parser.add_argument("name", help="an id, or a part of one")
    parser.add_argument("--run", type=Path, default=Path(), help="folder of a what-if run")


def main(arguments: argparse.Namespace) -> None:
    """Explain the one subject that the name means, or list the several."""
    project = Path()
    found = named(subjects(project / "data/published"), arguments.name)
    if len(found) == 1:
        print(explained(found[0], project, arguments.run))
        return
    print(f"'{arguments.name}' is in {len(found)} names; give more of one:")
    for subject in found[:LISTED]:
        print(f"  {subject.name}")
    if len(found) > LISTED:
        print(f"  ... and {len(found) - LISTED} more")
