"""Which notebook draws which figure: read from each study's ``figures.yaml``."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from smallsat.catalogue import study_module
from smallsat.errors import InputError
from smallsat.quantities import Part
from smallsat.strict_yaml import read_yaml

NOTEBOOK_KEYS = ("section", "published", "reads", "makes", "runs")
RUN_KEYS = ("figures", "film", "reads", "parameters")


@dataclass(frozen=True)
class NotebookRun:
    """One run of a notebook: what it reads, what it draws and with which parameters.

    Attributes
    ----------
    study, name
        Name of the run among those of its study.
    notebook
        Name of the notebook, without suffix.
    figures
        What each figure shows, by name, as the notebook takes it; empty for a film.
    film
        Name of a film, made only when asked for; else empty.
    reads, makes
        Files of the study's results that it reads, and that it makes beside the figures.
    section
        What it takes of the study's section: a type of its module ``configuration``, or keys; none
        if it needs none.
    published
        Whether it reads the published values.
    parameters
        Further parameters.
    """

    study: str
    name: str
    notebook: str
    figures: Mapping[str, Any] = field(default_factory=dict)
    film: str = ""
    reads: tuple[str, ...] = ()
    makes: tuple[str, ...] = ()
    section: str | tuple[str, ...] = ()
    published: bool = False
    parameters: Mapping[str, Any] = field(default_factory=dict)

    @property
    def stems(self) -> list[str]:
        """Paths of its figures without a suffix."""
        return [f"figures/{self.study}/{figure}" for figure in self.figures]

    def given(self, section: Part, results: str, published: str) -> dict[str, Any]:
        """The parameters of the notebook.

        Parameters
        ----------
        section
            The study's section of the configuration.
        results, published
            Folders of the study's results and of its published values.
        """
        given: dict[str, Any] = {"results": results, **self.parameters}
        if self.film:
            given["film"] = f"figures/{self.study}/{self.film}.mp4"
        else:
            given |= {"folder": f"figures/{self.study}", "figures": dict(self.figures)}
        if self.makes:
            given["made"] = results
        if isinstance(self.section, str):
            kind = getattr(study_module(self.study, "configuration"), self.section)
            given["section"] = section.only(kind)
        elif self.section:
            given["section"] = {key: section[key] for key in self.section}
        if self.published:
            given["published"] = published
        return given


def read_runs(folder: Path) -> list[NotebookRun]:
    """The runs of a study's notebooks, from ``figures.yaml`` in their folder.

    Parameters
    ----------
    folder
        Folder of the notebooks, named like the study.

    Raises
    ------
    InputError
        Naming the file, the notebook or run, and what is wrong.
    """
    path = folder / "figures.yaml"
    runs = []
    for notebook, entry in read_yaml(path).items():
        _require(path, notebook, entry, NOTEBOOK_KEYS)
        if not (folder / f"{notebook}.ipynb").exists():
            raise InputError(f"{path}: '{notebook}': there is no {notebook}.ipynb beside it")
        for name, run in entry["runs"].items():
            _require(path, f"{notebook}.{name}", run, RUN_KEYS)
            figures = run.get("figures") or {}
            if not isinstance(figures, dict):
                figures = dict.fromkeys(figures)
            section = entry.get("section") or ()
            runs.append(
                NotebookRun(
                    folder.name,
                    name,
                    notebook,
                    figures,
                    run.get("film", ""),
                    (*entry.get("reads", ()), *run.get("reads", ())),
                    tuple(entry.get("makes", ())),
                    section if isinstance(section, str) else tuple(section),
                    entry.get("published", False),
                    run.get("parameters", {}),
                )
            )
    return runs


def drawn(run: NotebookRun, section: Part) -> NotebookRun:
    """The run without the figures of cases that the configuration leaves out.

    A study whose configuration can leave out any has a module ``figures.selection``.
    """
    module = study_module(run.study, "figures.selection")
    if module is None:
        return run
    figures = {
        figure: what
        for figure, what in run.figures.items()
        if module.is_drawn(section, run.notebook, what, run.parameters)
    }
    return replace(run, figures=figures)


def _require(path: Path, place: str, entry: Any, allowed: Collection[str]) -> None:
    if not isinstance(entry, dict) or set(entry) - set(allowed):
        raise InputError(f"{path}: '{place}': allowed are the keys {', '.join(allowed)}")
