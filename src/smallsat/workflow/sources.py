"""Which source files a command runs: the import closure that a rule declares as its input."""

import ast
import json
from functools import cache
from pathlib import Path

import grimp

from smallsat.strict_yaml import read_yaml

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
        Names such as ``smallsat.evidence.judge``.
    """
    graph = _graph()
    closure = set(modules)
    for module in modules:
        closure |= graph.find_upstream_modules(module)
    # Importing a.b.c also runs the packages a and a.b.
    closure |= {name.rsplit(".", n)[0] for name in closure for n in range(1, name.count(".") + 1)}
    return sorted(str(_file(module)) for module in closure)


@cache
def notebook_modules(notebook: Path) -> list[str]:
    """Modules of `smallsat` that the cells of a notebook import, sorted."""
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    code = "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
    found = set()
    for node in ast.walk(ast.parse(code)):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("smallsat"):
            names = {f"{node.module}.{alias.name}" for alias in node.names}
            found |= {name for name in names if name in _graph().modules} or {str(node.module)}
    return sorted(found)


def named_modules(published: Path) -> list[str]:
    """Modules that the bindings, errata and claims of a study name, sorted."""
    keys = {"bindings": ("derived", "constant"), "errata": ("proof",), "claims": ("predicate",)}
    found = {
        entry[key].partition(":")[0]
        for name, names in keys.items()
        for entry in read_yaml(published / f"{name}.yaml") or []
        for key in names
        if key in entry
    }
    return sorted(module for module in found if module in _graph().modules)


def _file(module: str) -> Path:
    path = PACKAGE.joinpath(*module.split(".")[1:])
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
