"""Count the verdicts, and decide whether a build stands: exit with 1 if one is wrong."""

import argparse
from pathlib import Path

import pandas as pd

from smallsat.catalogue import read_catalogue
from smallsat.evidence.ledger import read_ledger
from smallsat.evidence.not_converged import read_not_converged
from smallsat.evidence.verdicts import PENDING, TEXT_COLUMNS, VERDICTS
from smallsat.results import read_table

# Kinds of printed values, in the order in which they are counted. An input that equals our own
# configuration is no result and is not counted as one.
KIND_TITLES = {
    "result": "Results",
    "timing": "Timings, shown and not judged",
    "input": "Inputs, compared with our own configuration",
}


def verdict_counts(verdicts: pd.DataFrame, kinds: pd.Series) -> pd.DataFrame:
    """Number of rows for each document and kind (rows) and verdict (columns).

    Parameters
    ----------
    verdicts
        Table of verdicts.
    kinds
        Kind (input, result, timing) of each id, indexed by id.
    """
    kind = verdicts["id"].map(kinds).rename("kind")
    counts = pd.crosstab([verdicts["document"], kind], verdicts["verdict"])
    return counts.reindex(columns=[*VERDICTS, PENDING], fill_value=0)


def failures(verdicts: pd.DataFrame) -> pd.DataFrame:
    """Rows that must not stand: mismatches and rows without a verdict."""
    return verdicts[~verdicts["verdict"].isin([v for v in (*VERDICTS, PENDING) if v != "mismatch"])]


def summary_text(verdicts: pd.DataFrame, kinds: pd.Series, not_converged: pd.DataFrame) -> str:
    """The few lines that end a build: counts, failures, unsolved cases."""
    counts = verdict_counts(verdicts, kinds)
    lines = []
    for kind, title in KIND_TITLES.items():
        if kind in counts.index.unique("kind"):
            lines += [title, counts.xs(kind, level="kind").to_string(), ""]
    wrong = failures(verdicts)
    lines += [
        f"{row.id}: printed {row.printed}, computed {row.computed}: {row.reason}"
        for row in wrong.itertuples()
    ]
    lines += [
        f"not converged: {row.study}: {row.case}: {row.status}"
        for row in not_converged.itertuples()
    ]
    kind_of = verdicts["id"].map(kinds)
    for kind in KIND_TITLES:
        own = verdicts[kind_of == kind]
        judged = int((own["verdict"] != PENDING).sum())
        lines.append(
            f"{judged} of {len(own)} {kind}s have a verdict, {len(failures(own))} of them wrong."
        )
    if len(not_converged):
        lines.append(
            f"{len(not_converged)} cases did not converge; they are left out of the figures."
        )
    return "\n".join(lines)


def value_kinds(published: Path) -> pd.Series:
    """Kind (input, result, timing) of every printed value, by id."""
    return pd.Series(
        {
            row["id"]: row["kind"]
            for study in read_catalogue(published)
            for row in read_ledger(published / study.name / "values.csv")
        }
    )


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``summary``."""
    parser.add_argument("verdicts", type=Path)
    parser.add_argument("--published", type=Path, default=Path("data/published"))
    parser.add_argument("--what-if", action="store_true", help="report differences, never fail")


def main(arguments: argparse.Namespace) -> None:
    """Print the counts, what is wrong and what did not converge."""
    verdicts = read_table(arguments.verdicts, TEXT_COLUMNS)
    results = arguments.verdicts.parent
    kinds = value_kinds(arguments.published)
    print(summary_text(verdicts, kinds, read_not_converged(results)))
    if len(failures(verdicts)) and not arguments.what_if:
        raise SystemExit(1)
