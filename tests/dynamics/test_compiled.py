"""The compiled functions' cache: never stale, and never in the way."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numba
import numpy as np
import pytest

from smallsat.dynamics import compiled

# A package that adds a constant of another file in a compiled loop, and prints how it got there.
LOOP = """\
from smallsat.dynamics.compiled import compiled
from smallsat.numbers import STEP

@compiled
def f(x):
    return x + STEP
"""
CALL = """\
from smallsat.loop import f
print(f(1.0), sum(f.stats.cache_hits.values()))
"""


def test_the_folder_is_named_after_the_sources(tmp_path):
    """Another folder after a change in a compiled file or in what it imports, and only then."""
    (tmp_path / "loop.py").write_text("from smallsat import (\n    numbers,\n)\n@compiled\n")
    (tmp_path / "numbers.py").write_text("STEP = 1.0")
    first = compiled.cache_folder(tmp_path)
    (tmp_path / "plot.py").write_text("colour = 1")
    assert compiled.cache_folder(tmp_path) == first
    (tmp_path / "numbers.py").write_text("STEP = 2.0")
    second = compiled.cache_folder(tmp_path)
    assert second != first
    (tmp_path / "loop.py").write_text("@compiled\ndef f(x): return 2 * x")
    assert compiled.cache_folder(tmp_path) not in (first, second)


def test_compiled_functions_are_kept_there():
    """Numba uses the folder of the sources as they stand."""
    assert str(compiled.cache_folder()) == numba.config.CACHE_DIR


@pytest.fixture
def package(tmp_path):
    """A small package with a compiled function in its cache; calling it gives value and hits."""
    source = tmp_path / "smallsat"
    (source / "dynamics").mkdir(parents=True)
    for folder in (source, source / "dynamics"):
        (folder / "__init__.py").write_text("")
    (source / "dynamics/compiled.py").write_text(Path(compiled.__file__).read_text())
    (source / "numbers.py").write_text("STEP = 1.0")
    (source / "loop.py").write_text(LOOP)
    assert call(tmp_path) == "2.0 0"
    assert call(tmp_path) == "2.0 1"
    return tmp_path


def call(folder):
    done = subprocess.run(
        [sys.executable, "-c", CALL],
        env=os.environ | {"PYTHONPATH": str(folder)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def cache_files(folder, suffix):
    files = list((folder / "smallsat/__pycache__").rglob(f"*.{suffix}"))
    assert files
    return files


def test_a_copied_package_brings_its_functions_along(package, tmp_path_factory):
    """What is compiled does not depend on where the package lies."""
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    shutil.copytree(package, elsewhere, dirs_exist_ok=True)
    shutil.rmtree(package / "smallsat")
    assert call(elsewhere) == "2.0 1"


def test_a_damaged_file_is_compiled_anew(package):
    """Emptied or cut index and data files: the right value, and a sound cache soon after."""
    for suffix in ("nbi", "nbc"):
        for kept in (0, 60):
            for path in cache_files(package, suffix):
                path.write_bytes(path.read_bytes()[:kept])
            assert call(package) == "2.0 0"
            # A damaged index is begun anew by the first call and filled by the second.
            assert [call(package), call(package)][-1] == "2.0 1"


def test_a_changed_constant_is_compiled_in(package):
    """A number of another file that a compiled loop uses is no part of its own file."""
    (package / "smallsat/numbers.py").write_text("STEP = 5.0")
    assert call(package) == "6.0 0"


def test_without_a_writable_package_the_cache_is_the_users_own(package, monkeypatch):
    """Whoever owns the checkout: functions are compiled and kept elsewhere."""
    (cache,) = (package / "smallsat/__pycache__").glob("numba-*")
    for path in cache.rglob("*"):
        if path.is_file():
            path.unlink()
    for path in sorted(cache.rglob("*"), reverse=True):
        path.rmdir()
    cache.rmdir()
    # A file in the folder's place is as good as a lack of rights, also for root.
    cache.write_text("")
    monkeypatch.setenv("TMPDIR", str(package))
    assert call(package) == "2.0 0"
    assert call(package) == "2.0 1"
    assert list(package.glob("smallsat-*/numba-*"))


@pytest.mark.parametrize(
    "function",
    [lambda a: np.zeros(3)[0] + a[0], lambda a: a[1:], lambda a: a.copy()],
    ids=["makes an array", "returns a part of one", "returns a copy"],
)
def test_arithmetic_makes_no_array(function):
    """Numba refuses what would need references counted, which arithmetic goes without."""
    with pytest.raises(numba.errors.TypingError):
        compiled.compiled_arithmetic(function)(np.ones(3))
