"""The document's own literals, as the ledger has them."""

from functools import cache
from pathlib import Path

from smallsat.evidence.ledger import read_ledger

LEDGER = Path(__file__).parents[5] / "data/published/mars/values.csv"


@cache
def _literals() -> dict[str, str]:
    return {row["id"]: row["printed"] for row in read_ledger(LEDGER)}


def literal(identifier: str) -> str:
    """A printed literal by its id, without the document's name."""
    return _literals()[f"mars/{identifier}"]
