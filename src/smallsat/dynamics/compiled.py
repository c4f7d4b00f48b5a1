"""Compilation of inner loops: ``@compiled`` is Numba's ``njit`` with a cache that only ever helps.

Numba keeps a compiled function as long as its own file is unchanged, even when a function that it
calls or a constant that it uses, in another file, has changed. The cache therefore lives in a
folder that is named after the content of every file with compiled functions and of all that they
import, and in it after the package's own folders, so that a copied package brings it along. What is
damaged, half written or not writable is passed over: the function is compiled anew.
"""

import contextlib
import hashlib
import os
import re
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba
from numba.core.caching import (
    CompileResultCacheImpl,
    FunctionCache,
    UserProvidedCacheLocator,
)

Function = TypeVar("Function", bound=Callable[..., Any])

_PACKAGE = Path(__file__).parents[1]
_IMPORT = re.compile(
    rb"^(?:from|import) smallsat\.?([\w.]*)(?: import (\([^)]*\)|.*))?", re.MULTILINE
)


def cache_folder(package: Path = _PACKAGE) -> Path:
    """Folder of the compiled functions of a package's source as it stands, made if need be.

    It lies inside the package, or, where that is not writable, in a folder of the user's own.
    """
    name = f"numba-{_digest(package)}"
    folder = package / "__pycache__" / name
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if os.access(folder, os.W_OK):
            return folder
    except OSError:
        pass
    # What is loaded from the cache is run, so nobody else may have written it.
    own = Path(tempfile.gettempdir()) / f"smallsat-{os.getuid()}"
    own.mkdir(mode=0o700, exist_ok=True)
    if own.stat().st_uid != os.getuid() or own.stat().st_mode & 0o022:
        own = Path(tempfile.mkdtemp(prefix="smallsat-"))
    (own / name).mkdir(exist_ok=True)
    return own / name


def _digest(package: Path) -> str:
    contents = {path: path.read_bytes() for path in sorted(package.rglob("*.py"))}
    closure: set[Path] = set()
    found = {path for path, content in contents.items() if b"@compiled" in content}
    while found:
        closure |= found
        found = {
            imported for path in found for imported in _imports(package, contents[path])
        } & contents.keys() - closure
    digest = hashlib.sha256(numba.__version__.encode())
    for path in sorted(closure):
        digest.update(contents[path])
    return digest.hexdigest()[:12]


def _imports(package: Path, content: bytes) -> set[Path]:
    """Files of the package that a module may import: as a module, or as a name in a package."""
    found = set()
    for module, names in _IMPORT.findall(content):
        place = package.joinpath(*module.decode().split("."))
        found |= {place.with_suffix(".py"), place / "__init__.py"}
        found |= {place / f"{name}.py" for name in re.findall(r"\w+", names.decode())}
    return found


class _Locator(UserProvidedCacheLocator):
    """Numba's folder of a file, named after its place in the package in place of the whole path."""

    @classmethod
    def get_suitable_cache_subpath(cls, py_file: str) -> str:
        """The folder, such as ``smallsat.dynamics.orbits``."""
        folder = Path(py_file).absolute().parent
        if not folder.is_relative_to(_PACKAGE):
            return super().get_suitable_cache_subpath(py_file)
        return ".".join(folder.relative_to(_PACKAGE.parent).parts)


class _Implementation(CompileResultCacheImpl):
    _locator_classes = [_Locator]  # noqa: RUF012


class _PassableCache(FunctionCache):
    """Numba's cache, except that no state of its files stops a run."""

    _impl_class = _Implementation

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The compiled function, or None to have it compiled."""
        try:
            return super().load_overload(sig, target_context)
        except Exception:
            # Whatever a damaged file makes of itself when it is read.
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the compiled function if that is possible."""
        try:
            super().save_overload(sig, data)
        except OSError:
            # A full disk, or a folder that is not writable.
            pass
        except Exception:
            # The index is read before it is written; a damaged one is begun anew, by the next run.
            with contextlib.suppress(OSError):
                self.flush()


numba.config.CACHE_DIR = str(cache_folder())  # type: ignore[attr-defined]


def compiled(function: Function) -> Function:
    """Compile a function on its first call with arguments of each type."""
    return _cached(numba.njit(function))


def compiled_arithmetic(function: Function) -> Function:
    """Compile a function that makes and returns no array and whose divisions need no check.

    A division by zero gives an infinity, as in NumPy, and no branch stands in the way of vector
    instructions. References to arrays are not counted, which takes a tenth of the time of short
    loops over many arrays: the caller holds them. To make an array is an error here; what returns
    one, even a part of an argument, has to be `compiled`. Multiplications are not fused into
    additions: which ones would be depends on what is inlined, and that differs between a process
    that compiles and one that loads the cache.
    """
    # An option that Numba documents and its type stubs leave out.
    without_references: dict[str, Any] = {"_nrt": False}
    return _cached(numba.njit(error_model="numpy", **without_references)(function))


def _cached(dispatcher: Any) -> Any:
    dispatcher._cache = _PassableCache(dispatcher.py_func)
    return dispatcher
