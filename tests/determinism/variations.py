"""Two builds as reprotest varies them: the same project under other circumstances."""

import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from smallsat.workflow.isolation import KERNEL
from tests.project_copy import Project, copy_project

NOBODY = 65534


@dataclass(frozen=True)
class Circumstances:
    """What a result must not depend on.

    Attributes
    ----------
    path
        Folder of the project, below the folder of the builds.
    cores
        Jobs at once.
    home, locale, time_zone
        Values of the variables HOME, LC_ALL and TZ.
    user
        Number of the user who builds.
    umask
        What new files are not allowed.
    shuffled
        Whether each listing of a folder comes in another order (disorderfs).
    compiled
        Whether inner loops come from Numba's cache; else they are compiled anew.
    kernel
        OpenBLAS's kernel; that of every build if empty.
    """

    path: str
    cores: int
    home: str
    locale: str
    time_zone: str
    user: int
    umask: int
    shuffled: bool = False
    compiled: bool = True
    kernel: str = ""

    def words(self) -> dict[str, str]:
        """Each of them in words, for a table."""
        return {
            "path": self.path,
            "cores": str(self.cores),
            "home": self.home,
            "locale": self.locale,
            "time zone": self.time_zone,
            "user": str(self.user),
            "umask": f"{self.umask:04o}",
            "hash seed": "random in each build",
            "file order": "shuffled by disorderfs" if self.shuffled else "the disk's",
            "compiled loops": "from the cache" if self.compiled else "compiled anew",
            "OpenBLAS kernel": self.kernel or KERNEL,
        }


ONE = Circumstances(
    path="one",
    cores=1,
    home="/root",
    locale="C.UTF-8",
    time_zone="Etc/GMT+12",
    user=0,
    umask=0o022,
)
# A language with a decimal comma, and an i without a dot.
OTHER = Circumstances(
    path="another/and-longer/place",
    cores=2,
    home="/nonexistent",
    locale="tr_TR.UTF-8",
    time_zone="Etc/GMT-14",
    user=NOBODY,
    umask=0o002,
    shuffled=True,
    compiled=False,
)


@contextmanager
def copied(root: Path, builds: Path, how: Circumstances) -> Iterator[Project]:
    """A copy of the project below a folder, under its circumstances."""
    folder = builds / how.path
    folder.mkdir(parents=True)
    if how.shuffled:
        disk = builds / "disk"
        disk.mkdir()
        options = ["--quiet", "--multi-user=yes", "--shuffle-dirents=yes", "--reverse-dirents=no"]
        subprocess.run(["disorderfs", *options, str(disk), str(folder)], check=True)
    try:
        copy_project(root, folder)
        if not how.compiled:
            for cache in (folder / "src").rglob("__pycache__"):
                shutil.rmtree(cache)
        for path in (folder, *folder.rglob("*")):
            os.chown(path, how.user, how.user, follow_symlinks=False)
        # Few variables, none of whoever calls.
        environment = {
            "PATH": f"{folder / '.venv/bin'}:/usr/local/bin:/usr/bin:/bin",
            "HOME": how.home,
            "LC_ALL": how.locale,
            "LOCPATH": str(builds),
            "TZ": how.time_zone,
        }
        if how.kernel:
            environment["SMALLSAT_KERNEL"] = how.kernel
        yield Project(folder, environment)
    finally:
        if how.shuffled:
            subprocess.run(["umount", str(folder)], check=True)


def build(project: Project, how: Circumstances, words: list[str]) -> None:
    """Build targets under the circumstances; the output is shown if the build fails."""
    # Reads what root may read: Python itself may lie in root's home.
    reads = [f"--{kind}-caps=+dac_read_search" for kind in ("inh", "ambient")]
    user = ["setpriv", f"--reuid={how.user}", f"--regid={how.user}", "--clear-groups", *reads]
    call = [str(project.folder / ".venv/bin/snakemake"), f"--cores={how.cores}", *words]
    done = subprocess.run(
        [*user, *call],
        cwd=project.folder,
        env=project.environment,
        umask=how.umask,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    if done.returncode:
        raise SystemExit(f"determinism: the build in {project.folder} failed\n{done.stdout}")


def make_locale(builds: Path, name: str) -> None:
    """Compile a locale into the folder of the builds."""
    language, _, encoding = name.partition(".")
    subprocess.run(
        ["localedef", "-i", language, "-f", encoding, str(builds / name)],
        check=True,
        capture_output=True,
    )
