"""Where a harness's table comes from: the command, the date, the machine, the versions."""

import os
import platform
import subprocess
from datetime import date
from importlib.metadata import version
from pathlib import Path

ROOT = Path(__file__).parents[1]


def provenance(command: str, *packages: str) -> dict[str, str]:
    """Facts by name; ``packages`` are those whose versions matter."""
    # A commit keeps its name, whatever is tagged.
    describe = ["git", "describe", "--always", "--dirty", "--exclude=*"]
    commit = subprocess.run(describe, cwd=ROOT, capture_output=True, text=True, check=True)
    versions = [f"Python {platform.python_version()}"]
    return {
        "command": command,
        "date": date.today().isoformat(),
        "commit": commit.stdout.strip(),
        "machine": f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
        "versions": ", ".join(versions + [f"{name} {version(name)}" for name in packages]),
    }
