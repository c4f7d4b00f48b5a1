"""Resolving a dotted name in a YAML file, ``package.module:name``, to the object it means."""

import importlib
from typing import Any

from smallsat.errors import InputError


def resolve(name: str, path: str) -> Any:
    """Import ``package.module:attribute``; a name that does not exist is an `InputError`."""
    module, _, attribute = name.partition(":")
    try:
        return getattr(importlib.import_module(module), attribute)
    except (ModuleNotFoundError, AttributeError, ValueError):
        raise InputError(f"{path}: '{name}' does not exist; write package.module:name") from None
