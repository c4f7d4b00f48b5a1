"""What the tables of chapter 6 rest on: the flight program's sources and the configuration."""

import hashlib
from pathlib import Path

from smallsat.studies.rendezvous.configuration import Configuration

FOLDER = Path(__file__).parents[5] / "flight"
# What is counted; the client over a socket is not.
COUNTED = ("*.c", "*.h", "*.S", "*.py", "plugin/*.c", "port/*", "requirements.lock")


def counted_sources() -> list[Path]:
    """Files that decide what is counted, sorted."""
    return sorted(path for pattern in COUNTED for path in FOLDER.glob(pattern))


def fingerprint(section: Configuration) -> dict[str, str]:
    """Digests of those files and of what the programs depend on of the configuration."""
    text = b"".join(path.read_bytes() for path in counted_sources())
    parts = section.model_dump_json(include={"flight_computer", "phases", "inferred", "plane_rate"})
    return {
        "sources": hashlib.sha256(text).hexdigest()[:16],
        "configuration": hashlib.sha256(parts.encode()).hexdigest()[:16],
    }
