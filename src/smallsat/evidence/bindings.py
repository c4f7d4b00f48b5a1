"""Inputs: what each printed parameter feeds in our configuration or code, and whether it agrees."""

import re
from collections.abc import Mapping
from math import nan
from typing import Any

import numpy as np

from smallsat.config import lookup
from smallsat.errors import InputError
from smallsat.evidence.printed import parse_printed
from smallsat.evidence.reference import resolve
from smallsat.quantities import Part


def bound_value(row: Mapping[str, str], binding: Mapping[str, Any], section: Part) -> float:
    """The value of ours that a printed input feeds, in the printed unit.

    A binding names a ``config`` key, a ``constant`` of the code, or a function that derives the
    value from the study's section (``derived``). Where that is a list, ``entry`` or else the row's
    component picks one: ``item 3``, ``min``/``max``, ``x``, ``2``, ``23`` (row 2, column 3).
    """
    if "config" in binding:
        value: Any = _configured(binding["config"], {row["id"].partition("/")[0]: section})
    elif "derived" in binding:
        value = resolve(binding["derived"], "bindings.yaml")(section)
    else:
        value = resolve(binding["constant"], "bindings.yaml")
    if "entry" in binding:
        value = value[binding["entry"]]
    if isinstance(value, list | tuple | np.ndarray):
        value = _component(np.asarray(value), row["component"] or row["case"], row["id"])
    return float(value)


def _configured(key: str, config: Mapping[str, Part]) -> Any:
    """The value of a key; of an entry beyond the end of a list, not a number.

    A what-if run may have a shorter list: then the printed entry feeds nothing.
    """
    above, _, place = key.rpartition(".")
    if place.isdecimal():
        entries = lookup(config, above)
        if isinstance(entries, tuple) and int(place) >= len(entries):
            return nan
    return lookup(config, key)


def binding_name(binding: Mapping[str, Any]) -> str:
    """The name of what an input feeds, for a reader."""
    if "config" in binding:
        return binding["config"]
    name = binding.get("derived") or binding["constant"]
    return name.removeprefix("smallsat.").removeprefix("studies.").replace(":", ".")


def agrees(row: Mapping[str, str], binding: Mapping[str, Any], value: float) -> bool:
    """Whether a printed input equals the value it feeds.

    ``reading`` in the binding says how a literal with symbols or words is read as a number.
    """
    printed = parse_printed(str(binding.get("reading", row["printed"])))
    if printed is None:
        raise InputError(
            f"bindings.yaml: '{row['id']}': {row['printed']!r} is no number; add a 'reading'"
        )
    return bool(np.isclose(printed.value, value, rtol=1e-12, atol=0.0))


def _component(value: np.ndarray, component: str, identifier: str) -> Any:
    axes = {"x": 0, "y": 1, "z": 2, "min": 0, "max": -1}
    if match := re.fullmatch(r"item ([1-9]\d*)", component):
        index: tuple[int, ...] = (int(match[1]) - 1,)
    elif component in axes:
        index = (axes[component],)
    elif re.fullmatch(r"[1-9]+", component) and len(component) == value.ndim:
        index = tuple(int(digit) - 1 for digit in component)
    else:
        raise InputError(f"bindings.yaml: '{identifier}': component {component!r} picks no entry")
    try:
        return value[index]
    except IndexError:
        # A what-if run may have a shorter list: then the printed entry feeds nothing.
        return nan
