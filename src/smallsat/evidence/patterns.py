"""Matching ledger ids to the entries of the YAML files that speak of them."""

from collections.abc import Iterable, Mapping, Sequence
from fnmatch import fnmatchcase
from typing import Any

from smallsat.errors import InputError


def names(entry: Mapping[str, Any], identifier: str) -> bool:
    """Whether the ``ids`` patterns of an entry name an id."""
    return any(fnmatchcase(identifier, pattern) for pattern in entry.get("ids") or ())


def match_entries(
    entries: Sequence[dict[str, Any]], ids: Iterable[str], path: str
) -> dict[str, dict[str, Any]]:
    """Map each id to the one entry whose ``ids`` patterns name it.

    Patterns are shell-style, and ``*`` also matches ``/``.

    Raises
    ------
    InputError
        If two entries name the same id, or a pattern names no id at all.
    """
    ids = list(ids)
    matched: dict[str, dict[str, Any]] = {}
    for entry in entries:
        for pattern in entry["ids"]:
            hits = [identifier for identifier in ids if fnmatchcase(identifier, pattern)]
            if not hits:
                raise InputError(f"{path}: '{pattern}' matches no id of values.csv; correct it")
            for hit in hits:
                if hit in matched and matched[hit] is not entry:
                    raise InputError(
                        f"{path}: '{hit}' is matched by two entries; narrow one of the patterns"
                    )
                matched[hit] = entry
    return matched
