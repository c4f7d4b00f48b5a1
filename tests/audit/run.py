"""Look for known vulnerabilities of the locked packages: ``make audit``.

``pip-audit`` passes over a package that it can look up nowhere, as behind a mirror of the index or
without a network, and says all the same that it has found none. Here that is said, and is no
success: exits with 1 where there is a vulnerability, with 3 where a package was not looked up.
"""

import csv
import datetime
import json
import re
import subprocess
import sys
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

LOCK = Path("requirements.lock")
TABLE = Path("data/accepted/pipeline/audit.csv")
COLUMNS = ("date", "tool", "packages", "looked_up", "vulnerabilities", "outcome", "command")


@dataclass(frozen=True)
class Audit:
    """What was found.

    Attributes
    ----------
    packages, looked_up
        How many the lock names, and of how many it is known whether they are vulnerable.
    found
        A line for each vulnerability.
    """

    packages: int
    looked_up: int
    found: list[str]

    @property
    def outcome(self) -> str:
        """In words."""
        if self.found:
            return f"{len(self.found)} known vulnerabilities"
        if self.looked_up == 0:
            return "nothing could be looked up"
        if self.looked_up < self.packages:
            return f"{self.packages - self.looked_up} packages could not be looked up"
        return "no known vulnerability"

    @property
    def status(self) -> int:
        """Exit status of the command."""
        return 1 if self.found else 3 if self.looked_up < self.packages else 0


def audited(packages: int, report: dict[str, Any]) -> Audit:
    """What a report of ``pip-audit``, as JSON, says about so many packages."""
    known = [one for one in report.get("dependencies", []) if "skip_reason" not in one]
    found = [
        f"{one['name']} {one['version']}: {flaw['id']}, mended in "
        + (", ".join(flaw["fix_versions"]) or "no version")
        for one in known
        for flaw in one["vulns"]
    ]
    return Audit(packages, len(known), found)


def main() -> None:
    """Ask, keep the outcome in the table of the report, and say it."""
    packages = len(re.findall(r"^[\w.-]+==", LOCK.read_text(), re.MULTILINE))
    words = ["--disable-pip", "--require-hashes", "--progress-spinner=off", "--format=json"]
    done = subprocess.run(
        [sys.executable, "-m", "pip_audit", "-r", LOCK, *words], capture_output=True, text=True
    )
    # Without a network it says nothing but why.
    report = json.loads(done.stdout) if done.stdout.startswith("{") else {}
    audit = audited(packages, report)
    with TABLE.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        table.writerow(
            (
                datetime.date.today().isoformat(),
                f"pip-audit {version('pip-audit')}",
                audit.packages,
                audit.looked_up,
                len(audit.found),
                audit.outcome,
                "make audit",
            )
        )
    print(*audit.found, sep="\n", end="\n" * bool(audit.found))
    print(f"{packages} packages, {audit.looked_up} looked up: {audit.outcome}")
    if not report:
        print(f"pip-audit: {(done.stderr.strip().splitlines() or ['no answer'])[-1]}")
    raise SystemExit(audit.status)


if __name__ == "__main__":
    main()
