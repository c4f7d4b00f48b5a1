"""Take the present results as accepted: `make accept REASON="why they changed"`."""

import argparse
import datetime
from pathlib import Path

import pandas as pd

from smallsat.errors import InputError
from smallsat.evidence.accepted import RELEASES, SHARE, SORTS, findings, flipped, moved
from smallsat.evidence.summary import failures
from smallsat.results import read_table, write_table

TAKEN = {
    "value": ["id", "computed", "verdict"],
    "claim": ["id", "outcome"],
    "erratum": ["key", "holds"],
}


def accept(results: Path, share: Path, accepted: Path, reason: str, date: str) -> str:
    """Write the tables of ``data/accepted`` anew, with a line that says when and why.

    Parameters
    ----------
    results, share
        Folders ``data/results`` of the reproduction and of the tests' run.
    accepted
        Folder ``data/accepted``.
    reason, date
        Why they changed, and today.

    Returns
    -------
    str
        What is said of it.

    Raises
    ------
    InputError
        If no reason is given, or a verdict is wrong.
    """
    if not reason.strip():
        raise InputError('accept: no reason; give one: make accept REASON="why they changed"')
    verdicts = {path: read_table(path) for path in sorted(results.glob("*/verdicts.csv"))}
    for path, table in verdicts.items():
        if len(wrong := failures(table)):
            raise InputError(
                f"accept: {path}: {wrong['id'].iloc[0]}: its verdict is wrong; mend it"
            )
    before, now = findings(accepted), findings(results)
    line = {
        "date": date,
        "reason": " ".join(reason.split()),
        "outcomes": len(flipped(before, now)),
        "values": len(moved(before, now)),
    }
    for study in (path.parent.name for path in verdicts):
        for sort, (file, key, outcome) in SORTS.items():
            table = read_table(results / study / file)[TAKEN[sort]]
            if sort != "erratum":
                shared = read_table(share / study / file).set_index(key)[outcome]
                table = table.assign(**{outcome + SHARE: table[key].map(shared)})
            write_table(table, accepted / study / file)
    log = accepted / RELEASES
    past = [read_table(log)] if log.exists() else []
    write_table(pd.concat([*past, pd.DataFrame([line])], ignore_index=True), log)
    return f"accepted: {line['outcomes']} other outcomes, {line['values']} values that moved; {log}"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``accept``."""
    parser.add_argument("--reason", required=True, help="why the results changed")
    parser.add_argument("--results", type=Path, default=Path("data/results"))
    parser.add_argument("--share", type=Path, default=Path("runs/tests/data/results"))
    parser.add_argument("--accepted", type=Path, default=Path("data/accepted"))


def main(arguments: argparse.Namespace) -> None:
    """Take the results and say what changed."""
    today = datetime.date.today().isoformat()
    folders = (arguments.results, arguments.share, arguments.accepted)
    print(accept(*folders, arguments.reason, today))
