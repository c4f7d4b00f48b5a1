"""Which source files a command runs: the import closure that a rule declares as its input."""

from functools import cache
from pathlib import Path

import grimp

PACKAGE = Path(__file__).parents[1]


@cache
def _graph() -> grimp.ImportGraph:
    return grimp.build_graph("smallsat", cache_dir=None)


def source_files(*modules: str) -> list[str]:
    """Files of the modules and of everything in `smallsat` that they import, sorted.

    Snakemake sees the command of a rule but not what it imports; a rule that lists these files as
    inputs reruns when one of them changes, and only then.

    Parameters
    ----------
    *modules
        Names such as ``smallsat.studies.transfer.methods.direct``.
    """
    graph = _graph()
    closure = set(modules)
    for module in modules:
        closure |= graph.find_upstream_modules(module)
    # Importing a.b.c also runs the packages a and a.b.
    closure |= {name.rsplit(".", n)[0] for name in closure for n in range(1, name.count(".") + 1)}
    return sorted(str(_file(module)) for module in closure)


def _file(module: str) -> Path:
    path = PACKAGE.joinpath(*module.split(".")[1:])
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
