"""Compilation of inner loops: ``@compiled`` is Numba's ``njit`` with a cache that cannot go stale.

Numba keeps a compiled function as long as its own file is unchanged, even when a function that it
calls, in another file, has changed. The cache therefore lives in a folder that is named after the
content of every file with compiled functions.
"""

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba

Function = TypeVar("Function", bound=Callable[..., Any])

_PACKAGE = Path(__file__).parents[1]


def _digest() -> str:
    digest = hashlib.sha256(numba.__version__.encode())
    for path in sorted(_PACKAGE.rglob("*.py")):
        content = path.read_bytes()
        if b"@compiled" in content:
            digest.update(content)
    return digest.hexdigest()[:12]


numba.config.CACHE_DIR = str(_PACKAGE / "__pycache__" / f"numba-{_digest()}")  # type: ignore[attr-defined]


def compiled(function: Function) -> Function:
    """Compile a function on its first call with arguments of each type."""
    return numba.njit(cache=True)(function)  # type: ignore[return-value]


def compiled_arithmetic(function: Function) -> Function:
    """Compile a function whose divisions need no check.

    A division by zero gives an infinity, as in NumPy, and no branch stands in the way of vector
    instructions. Multiplications are not fused into additions: which ones would be depends on what
    is inlined, and that differs between a process that compiles and one that loads the cache.
    """
    return numba.njit(cache=True, error_model="numpy")(function)  # type: ignore[return-value]
