"""Five published studies of small-satellite guidance and control, rerun and judged."""

import os
from pathlib import Path

if folder := os.environ.get("SMALLSAT_OPENED"):
    from smallsat.opened import record

    record(Path(folder))
