"""What the study computed for each printed result and count of iterations."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import pandas as pd

from smallsat.evidence.observation import Observation
from smallsat.evidence.printed import Printed, parse_printed
from smallsat.studies.transfer.results import PrintedCase, parse_case, read_cases, select

# Runs in the order in which they are shown; the last is the best one.
RUNS = ("as published", "converged")
COLUMN_OF = {
    "iterations": "iterations",
    "terminal time": "final_time",
    "terminal mass": "final_mass",
    "largest terminal mass": "final_mass",
    "terminal time after opening coefficient bounds": "final_time",
}
SECONDS = ("sim time", "elapsed time", "execution time")

Row = Mapping[str, str]


def observe(rows: Sequence[Row], results: Path) -> Iterator[Observation]:
    """Observations for the ledger rows of the document.

    Parameters
    ----------
    rows
        Ledger rows of the document.
    results
        Folder with the study's case tables.
    """
    cases = read_cases(results)
    times = {
        (row["locator"], row["case"]): row["printed"]
        for row in rows
        if row["quantity"] == "terminal time"
    }
    for row in rows:
        case = parse_case(row["case"])
        column = COLUMN_OF.get(row["quantity"])
        if case and column:
            runs: Sequence[str] = RUNS
            if column == "final_mass":
                # A mass belongs to the run that decides the time printed beside it.
                time = parse_printed(times.get((row["locator"], row["case"]), ""))
                runs = _deciding(cases, case, time) if time else RUNS
            yield from _observe_case(row["id"], cases, case, column, runs)
    yield from _derived(rows, cases)


def seconds(rows: Sequence[Row], results: Path, timings: pd.DataFrame) -> pd.DataFrame:
    """Our seconds for the printed ones: columns id, seconds.

    The printed seconds are of the as-published kind of run, and so are ours.
    """
    keys = ["method", "run", "degree", "intervals"]
    timed = timings.set_index(keys)["seconds"]
    found = []
    for row in rows:
        case = parse_case(row["case"])
        if case and row["kind"] == "timing" and row["quantity"] in SECONDS:
            key = (case.method, RUNS[0], case.degree, case.intervals)
            if key in timed.index:
                found.append({"id": row["id"], "seconds": timed.loc[key]})
    return pd.DataFrame(found, columns=["id", "seconds"])


def _deciding(cases: pd.DataFrame, case: PrintedCase, time: Printed) -> Sequence[str]:
    """The first run whose final time equals the printed one; where none does, the best run."""
    for run in RUNS:
        if select(cases, case, run)["final_time"].map(time.matches).any():
            return (run,)
    return RUNS[-1:] if len(select(cases, case, RUNS[-1])) else RUNS[:1]


def _observe_case(
    identifier: str, cases: pd.DataFrame, case: PrintedCase, column: str, runs: Sequence[str]
) -> Iterator[Observation]:
    # Iterations belong to the run of the document's kind alone.
    for run in RUNS[:1] if column == "iterations" else runs:
        for found in select(cases, case, run).to_dict("records"):
            yield Observation(
                identifier,
                found[column],
                run=run,
                residual=found["residual"],
                note="" if found["converged"] else f"not converged: {found['status']}",
            )


def _derived(rows: Sequence[Row], cases: pd.DataFrame) -> Iterator[Observation]:
    """Percentages that the document derives from its own results."""
    prefix, case = "transfer/section-3-", "direct-shooting-n"
    indirect = select(cases, PrintedCase("indirect", 0, 1), RUNS[0]).iloc[0]
    for degree in (2, 6):
        found = select(cases, PrintedCase("direct", degree, 1), RUNS[0])
        # A what-if run may leave a degree out.
        if found.empty:
            continue
        single = found.iloc[0]
        longer = 100 * (single["final_time"] / indirect["final_time"] - 1)
        loss = 100 * (1 - single["final_mass"] / indirect["final_mass"])
        increase = f"{prefix}5/terminal-time-increase-over-indirect/{case}-{degree}"
        note = _note(bool(single["converged"] and indirect["converged"]))
        yield Observation(increase, longer, RUNS[0], note=note)
        if degree == 6:
            difference = f"{prefix}3-1/mass-difference-from-indirect/{case}-6"
            yield Observation(difference, loss, RUNS[0], note=note)
            change = f"{prefix}5/terminal-mass-change-from-indirect/{case}-6"
            yield Observation(change, -loss, RUNS[0], note=note)

    # The bounds of the first run are lost, so its change can only be recomputed from print.
    printed = {row["id"]: row["printed"] for row in rows}
    multiple = "direct-multiple-shooting-n-5-k-16"
    before, after = (
        float(printed[f"{prefix}4/terminal-time-{word}-opening-coefficient-bounds/{multiple}"])
        for word in ("before", "after")
    )
    yield Observation(
        f"{prefix}4/terminal-time-change/{multiple}",
        100 * (before - after) / before,
        run="from the printed values",
    )

    effect = float(degree_spread(cases, RUNS[1]).max(skipna=False))
    yield Observation(
        f"{prefix}4-1/effect-of-degree-on-terminal-time/direct-multiple-shooting",
        effect,
        RUNS[1],
        note=_note(effect == effect),
    )


def _note(converged: bool) -> str:
    return "" if converged else "not converged: a case that it rests on"


def degree_spread(cases: pd.DataFrame, run: str) -> pd.Series:
    """Spread of the final time over the degrees, in percent of the shortest, for each K.

    Not a number for a K of which a case did not converge.
    """
    times = cases[(cases["method"] == "direct") & (cases["run"] == run) & (cases["intervals"] > 1)]
    groups = times.groupby("intervals")["final_time"]
    spread = 100 * (groups.max() - groups.min()) / groups.min()
    return spread.where(groups.count() == groups.size())
