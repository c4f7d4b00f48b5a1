"""Counting verdicts, and deciding whether a build stands."""

from pathlib import Path

import pandas as pd

from smallsat.evidence.verdicts import PENDING, VERDICTS


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


def summary_text(
    verdicts: pd.DataFrame, kinds: pd.Series, not_converged: pd.DataFrame, report: Path
) -> str:
    """The few lines that end a build: counts, failures, unsolved cases, where the report lies."""
    counts = verdict_counts(verdicts, kinds)
    lines = [counts.to_string(), ""]
    wrong = failures(verdicts)
    lines += [
        f"{row.id}: printed {row.printed}, computed {row.computed}: {row.reason}"
        for row in wrong.itertuples()
    ]
    lines += [
        f"not converged: {row.study}: {row.case}: {row.status}"
        for row in not_converged.itertuples()
    ]
    judged = len(verdicts) - int((verdicts["verdict"] == PENDING).sum())
    lines.append(
        f"{judged} of {len(verdicts)} published values have a verdict, {len(wrong)} of them wrong."
    )
    if len(not_converged):
        lines.append(
            f"{len(not_converged)} cases did not converge; they are left out of the figures."
        )
    if report.exists():
        lines.append(f"report: {report} and {report.with_suffix('.html')}")
    return "\n".join(lines)
