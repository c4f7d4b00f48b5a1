"""Build twice as reprotest varies builds, then on another kernel of OpenBLAS: `make determinism`.

The first two builds have to agree in every byte of every data file, figure, PDF and page, apart
from what is listed with its reason; the third in every verdict, and the digits that move are
listed.
"""

import argparse
import os
import shutil
import sys
import tempfile
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import asdict, dataclass, fields, replace
from fnmatch import fnmatch
from pathlib import Path

import pandas as pd

from smallsat.catalogue import read_catalogue
from smallsat.strict_yaml import read_yaml
from smallsat.workflow.isolation import KERNEL
from tests.determinism.bytes_compared import Compared, Moved, compared, moved_digits, outcomes
from tests.determinism.variations import ONE, OTHER, build, copied, make_locale
from tests.project_copy import Project
from tests.provenance import provenance

ROOT = Path(__file__).parents[2]
TABLES = ROOT / "data/accepted/pipeline"
# What two builds do not have in common, to be looked at.
DIFFERING = ROOT / "logs/determinism"
# A series without a configuration.
FULL = "the documents' own"
COLUMNS = ("kind", "files", "identical", "excepted", "reason")
# What may differ, in numbers alone, and why.
SECONDS = "measured seconds"
EXCEPTIONS = {
    "data/results/*/*seconds*.csv": SECONDS,
    "data/results/*/timings.csv": SECONDS,
}
# These show the seconds of a study that has any; the whole report counts as one.
SHOWING = (
    "report/build/{study}.*",
    "report/build/{study}-site/*",
    "report/build/site/{study}.html",
)


def targets(studies: list[str]) -> list[str]:
    """What is built: each study with its report, or the whole."""
    return [word for study in studies for word in (study, f"{study}_report")] or ["all"]


def run_folder(project: Project, configuration: str) -> Path:
    """Folder of the run: that of the reproduction if no configuration is given."""
    if not configuration:
        return project.folder
    name = read_yaml(ROOT / configuration)["run"]
    return project.folder / "runs" / name


def reason(file: Compared, timed: set[str]) -> str:
    """Why a file may differ; empty if it may not, or differs in more than numbers."""
    if not file.words:
        return ""
    listed = EXCEPTIONS | {
        pattern.format(study=study): f"prints {SECONDS}"
        for study in (*timed, *["report"] * bool(timed))
        for pattern in SHOWING
    }
    if timed:
        listed["report/build/site/values.html"] = f"prints {SECONDS}"
    return next((why for pattern, why in listed.items() if fnmatch(file.name, pattern)), "")


def summary(found: list[Compared], timed: set[str]) -> list[dict[str, object]]:
    """A row for each kind of file: how many, how many the same, which exceptions and why."""
    rows = []
    for kind in sorted({file.kind for file in found}):
        ofs = [file for file in found if file.kind == kind]
        excused = Counter(why for file in ofs if not file.same and (why := reason(file, timed)))
        rows.append(
            {
                "kind": kind,
                "files": len(ofs),
                "identical": sum(file.same for file in ofs),
                "excepted": sum(excused.values()),
                "reason": "; ".join(excused),
            }
        )
    return rows


@dataclass(frozen=True)
class Series:
    """Builds that are compared: of which configuration, and which studies by a space."""

    configuration: str
    studies: str

    def covers(self, other: "Series") -> bool:
        """Whether the other is this, or a part of it."""
        same = self.configuration == other.configuration
        return same and set(other.studies.split()) <= set(self.studies.split())


def kept(path: Path, columns: Sequence[str], series: Series, rows: list[dict[str, object]]) -> None:
    """Exchange the rows of a series, and of any part of it, in a tracked table."""
    key = [field.name for field in fields(Series)]
    others = pd.DataFrame(columns=[*key, *columns])
    if path.exists():
        old = pd.read_csv(path, dtype=str, keep_default_na=False)
        others = old[[not series.covers(Series(*row)) for row in old[key].to_numpy()]]
    new = pd.DataFrame([asdict(series) | row for row in rows], columns=others.columns)
    pd.concat([others, new]).to_csv(path, index=False, lineterminator="\n")


def set_aside(one: Path, other: Path, found: list[Compared], folder: Path) -> None:
    """Copy either version of what differs to a folder, since the builds are deleted."""
    shutil.rmtree(folder, ignore_errors=True)
    for file in found:
        for place, side in ((one, "one"), (other, "other")):
            if not file.same and (place / file.name).exists():
                (folder / side / file.name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(place / file.name, folder / side / file.name)


def judge(
    one: Path, other: Path, third: Path, series: Series, facts: dict[str, str], kernel: str
) -> bool:
    """Compare two varied builds, and one on another kernel; keep the tables, print what was found.

    Returns whether nothing differs but what is excepted, and every verdict is the same.
    """
    studies = series.studies.split()
    timed = {
        study
        for study in studies
        if any(
            file.match(name)
            for file in (one / f"data/results/{study}").iterdir()
            for name in EXCEPTIONS
        )
    }
    found = list(compared(one, other))
    set_aside(one, other, found, DIFFERING)
    rows = summary(found, timed)
    unexcused = [file.name for file in found if not file.same and not reason(file, timed)]
    moved: list[Moved] = [
        move
        for file in compared(one, third)
        if not file.same and file.name.endswith((".csv", ".parquet"))
        if not reason(file, timed)
        for move in moved_digits(one, third, file.name)
    ]
    before = {key: value for study in studies for key, value in outcomes(one, study).items()}
    after = {key: value for study in studies for key, value in outcomes(third, study).items()}
    flipped = sorted(key for key in before | after if before.get(key) != after.get(key))
    kept(TABLES / "determinism.csv", COLUMNS, series, rows)
    kept(
        TABLES / "determinism-kernel.csv",
        ["kernel", *(field.name for field in fields(Moved))],
        series,
        [
            {"kernel": kernel} | asdict(move) | {"relative": f"{move.relative:.1e}"}
            for move in moved
        ],
    )
    varied = {
        f"varied: {word}": f"{value} / {OTHER.words()[word]}"
        for word, value in ONE.words().items()
        if value != OTHER.words()[word] or word == "hash seed"
    }
    facts = facts | {"judged": str(len(before)), "flipped": str(len(flipped))} | varied
    kept(
        TABLES / "determinism-provenance.csv",
        ["item", "value"],
        series,
        [{"item": item, "value": value} for item, value in facts.items()],
    )
    print(pd.DataFrame(rows).to_string(index=False))
    print(*(f"differs: {name}" for name in unexcused), sep="\n")
    print(f"Both versions of every file that differs: {DIFFERING.relative_to(ROOT)}")
    print(f"on {kernel}: {len(flipped)} of {len(before)} outcomes other, {flipped}")
    print(pd.DataFrame([asdict(move) for move in moved]).to_string(index=False))
    return not unexcused and not flipped


def main() -> None:
    """Build and judge; exit with 1 where bytes or verdicts differ unexcused."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("studies", nargs="*", help="studies to build; all if none is given")
    parser.add_argument("--configfile", default="", help="else the documents' own values")
    parser.add_argument("--kernel", default="Sandybridge", help="another kernel of OpenBLAS")
    parser.add_argument("--folder", type=Path, help="where the copies of the project go")
    arguments = parser.parse_args()
    if os.geteuid() != 0:
        sys.exit("determinism: another user and an own order of files need root")
    studies = arguments.studies or [study.name for study in read_catalogue(ROOT / "data/published")]
    given = ["--configfile", arguments.configfile] * bool(arguments.configfile)
    words = [*targets(arguments.studies), *given]
    if arguments.kernel == KERNEL:
        sys.exit(f"determinism: --kernel {KERNEL} is that of every build; name another")
    kernel = replace(ONE, path="kernel", cores=2, kernel=arguments.kernel)
    facts = provenance("make determinism", "snakemake", "numpy", "typst") | {
        "targets": " ".join(targets(arguments.studies)),
    }
    series = Series(arguments.configfile or FULL, " ".join(studies))
    with ExitStack() as stack:
        place = stack.enter_context(
            tempfile.TemporaryDirectory(dir=arguments.folder, prefix="determinism-")
        )
        builds = Path(place)
        builds.chmod(0o755)
        make_locale(builds, OTHER.locale)
        all_three = (ONE, OTHER, kernel)
        projects = [stack.enter_context(copied(ROOT, builds, how)) for how in all_three]
        with ThreadPoolExecutor() as pool:
            list(pool.map(build, projects, all_three, [words] * 3))
        runs = [run_folder(project, arguments.configfile) for project in projects]
        good = judge(*runs, series, facts, arguments.kernel)
    raise SystemExit(not good)


if __name__ == "__main__":
    main()
