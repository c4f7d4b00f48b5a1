"""Run the what-ifs of this folder as a user would, a line each: `make what-ifs`.

Each file ``<study>.yaml`` has ``small``, sizes for all of its what-ifs, and ``cases``: by name, the
``change`` of the study's section, what is expected of it, and ``words`` that a refusal must have.
A what-if is done when the study's observations, figures and its own report are there.
"""

import argparse
import json
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from smallsat.config import merged
from smallsat.errors import InputError, report_input_errors
from smallsat.results import read_table
from smallsat.strict_yaml import read_yaml

HERE = Path(__file__).parent
OUTCOMES = ("done", "refused", "not converged")


@dataclass(frozen=True)
class WhatIf:
    """One change of one study and what is expected of it."""

    study: str
    name: str
    change: dict[str, Any]
    expect: str
    words: tuple[str, ...] = ()
    quick: bool = False

    @property
    def run(self) -> str:
        """Name of its run."""
        return f"what-if-{self.study}-{self.name}"


@dataclass(frozen=True)
class Outcome:
    """How a what-if ended: one of `OUTCOMES` or ``failed``, and the reason or the cases."""

    word: str
    detail: str = ""


def read_what_ifs(folder: Path = HERE) -> list[WhatIf]:
    """All what-ifs of a folder, study by study."""
    found = []
    for path in sorted(folder.glob("*.yaml")):
        content = read_yaml(path)
        for name, case in content["cases"].items():
            if case["expect"] not in OUTCOMES:
                raise InputError(f"{path}: '{name}' expects {case['expect']!r}; one of {OUTCOMES}")
            found.append(
                WhatIf(
                    path.stem,
                    name,
                    merged(content.get("small", {}), case["change"]),
                    case["expect"],
                    tuple(case.get("words", ())),
                    case.get("quick", False),
                )
            )
    return found


def run(what_if: WhatIf, command: list[str], project: Path, **options: Any) -> Outcome:
    """Run one what-if with a Snakemake command in a project, from nothing."""
    folder = project / "runs" / what_if.run
    shutil.rmtree(folder, ignore_errors=True)
    setting = f"{what_if.study}={json.dumps(what_if.change)}"
    words = [f"{what_if.study}_site", "--config", f"run={what_if.run}", setting]
    done = subprocess.run(
        [*command, *words], cwd=project, capture_output=True, text=True, check=False, **options
    )
    output = done.stdout + done.stderr
    if "Traceback" in output:
        return Outcome("failed", f"traceback: {output.strip().splitlines()[-1]}")
    if done.returncode:
        lines = [line for line in output.splitlines() if line.startswith("smallsat: ")]
        if len(lines) == 1 and not folder.exists():
            return Outcome("refused", lines[0].removeprefix("smallsat: "))
        return Outcome("failed", " / ".join(lines) or output.strip()[-300:])
    missing = [
        path
        for path in (
            f"data/results/{what_if.study}/observations.csv",
            f"report/build/{what_if.study}.pdf",
            f"report/build/{what_if.study}-site/index.html",
        )
        if not (folder / path).exists()
    ]
    if missing or not list((folder / "figures" / what_if.study).glob("*.svg")):
        return Outcome("failed", f"missing: {', '.join(missing) or 'figures'}")
    unsolved = read_table(folder / f"data/results/{what_if.study}/not-converged.csv", ("case",))
    if len(unsolved):
        return Outcome("not converged", "; ".join(unsolved["case"]))
    return Outcome("done")


def met(what_if: WhatIf, outcome: Outcome) -> bool:
    """Whether a what-if ended as expected, with the words that its refusal must have."""
    return outcome.word == what_if.expect and all(word in outcome.detail for word in what_if.words)


def lines(what_ifs: list[WhatIf], keep: bool) -> Iterator[tuple[bool, str]]:
    """Run all and say of each, as it ends, whether it ended as expected and how."""
    project = HERE.parents[1]
    for what_if in what_ifs:
        began = time.monotonic()
        outcome = run(what_if, [str(Path(sys.executable).parent / "snakemake")], project)
        good = met(what_if, outcome)
        seconds = f"{time.monotonic() - began:.0f} s"
        wanted = "" if good else f"  EXPECTED {what_if.expect} {' '.join(what_if.words)}"
        detail = f": {outcome.detail}" if outcome.detail else ""
        yield good, f"{what_if.study} {what_if.name}: {outcome.word}{detail} ({seconds}){wanted}"
        if good and not keep:
            shutil.rmtree(project / "runs" / what_if.run, ignore_errors=True)


def main() -> None:
    """Run the what-ifs that are asked for; exit with 1 if one did not end as expected."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("only", nargs="*", help="studies or names; all if none is given")
    parser.add_argument("--keep", action="store_true", help="keep the folders of the runs")
    arguments = parser.parse_args()
    chosen = [
        what_if
        for what_if in read_what_ifs()
        if not arguments.only or {what_if.study, what_if.name} & set(arguments.only)
    ]
    results = []
    for good, line in lines(chosen, arguments.keep):
        results.append(good)
        print(line, flush=True)
    print(f"{sum(results)} of {len(results)} what-ifs ended as expected.")
    if not all(results) or not results:
        raise SystemExit(1)


if __name__ == "__main__":
    report_input_errors(main)
