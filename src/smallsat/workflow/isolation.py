"""The user's own settings, kept out: what is built depends on the project alone.

A matplotlibrc, an IPython start-up file, a kernel of another Python, a PYTHONPATH: each would
change results or stop the build, and none of them is in the project. What these tools must write
goes to a folder of the project, so that no home folder is needed either.

Nor does the processor decide: OpenBLAS has a kernel for each kind, whose sums differ in their last
bits, and a solve that does not converge ends elsewhere by them. One kernel is taken wherever the
processor has its instructions, which is nearly every one for personal computers since 2013;
`SMALLSAT_KERNEL` names another, for comparison.
"""

import os
import sys
from collections.abc import Mapping
from pathlib import Path

# Variables that point tools at files of the user, or tune the linear algebra.
_FOREIGN = (
    "PYTHON", "JUPYTER", "IPYTHON", "MPL", "MATPLOTLIB", "NUMBA", "PAPERMILL", "OPENBLAS", "GOTO",
)  # fmt: skip
# Libraries that have a number of threads; Snakemake sets all of them for its jobs.
_THREADED = ("OMP_NUM", "OPENBLAS_NUM", "GOTO_NUM", "MKL_NUM", "NUMEXPR_NUM", "VECLIB_MAXIMUM")
# OpenBLAS's name of the kernel, the instructions that it needs, and where Linux lists those.
KERNEL, _NEEDED, _PROCESSOR = "Haswell", {"avx2", "fma"}, Path("/proc/cpuinfo")


def isolated(environment: Mapping[str, str], cache: Path) -> dict[str, str]:
    """The environment without what would let the user's settings in.

    Parameters
    ----------
    environment
        Variables as found.
    cache
        Folder in which Jupyter, IPython, matplotlib and Snakemake may keep what they need.

    Returns
    -------
    dict
        Variables for every process of a build. The programs of this Python's environment come
        first on the path, so that `python` is the interpreter that runs now.
    """
    kept = {name: value for name, value in environment.items() if not name.startswith(_FOREIGN)}
    cache = cache.absolute()
    kernel = kept.get("SMALLSAT_KERNEL") or (KERNEL if has_instructions(_PROCESSOR) else "")
    programs = str(Path(sys.executable).parent)
    path = [part for part in kept.get("PATH", os.defpath).split(os.pathsep) if part != programs]
    return kept | {
        "PATH": os.pathsep.join([programs, *path]),
        "PYTHONNOUSERSITE": "1",
        # A file in the folder of the run must not pass for a module of the same name.
        "PYTHONSAFEPATH": "1",
        "JUPYTER_PREFER_ENV_PATH": "1",
        "JUPYTER_CONFIG_DIR": str(cache / "jupyter/config"),
        "JUPYTER_DATA_DIR": str(cache / "jupyter/data"),
        "JUPYTER_RUNTIME_DIR": str(cache / "jupyter/runtime"),
        "IPYTHONDIR": str(cache / "ipython"),
        "MPLCONFIGDIR": str(cache / "matplotlib"),
        "XDG_CACHE_HOME": str(cache),
        # One process a core, each on one thread: results do not depend on the number of cores.
        **{f"{name}_THREADS": "1" for name in _THREADED},
        # Nor a thread of Arrow's allocator: a process is forked from one that has no other.
        "JE_ARROW_MALLOC_CONF": "background_thread:false",
        **({"OPENBLAS_CORETYPE": kernel} if kernel else {}),
    }


def has_instructions(processor: Path) -> bool:
    """Whether a list of the processor's flags, as Linux has it, names those that `KERNEL` needs."""
    try:
        return set(processor.read_text().split()) >= _NEEDED
    except OSError:
        return False


def isolate(cache: Path) -> None:
    """Apply `isolated` to this process and to those that it starts."""
    environment = isolated(os.environ, cache)
    os.environ.clear()
    os.environ.update(environment)
