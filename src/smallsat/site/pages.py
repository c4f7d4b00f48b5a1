"""The web site of a run: what was found, a page a study, all values, errata, what is known.

Everything lies in one folder and is opened from disk; nothing is fetched from elsewhere. Prose and
tables of the report come from its own Typst source, so that page and PDF cannot disagree.
"""

import argparse
import json
import os
import re
import shutil
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from smallsat.catalogue import study_module
from smallsat.config import Config, model_of, validate
from smallsat.drawing.interactive import Scene, figure
from smallsat.errors import InputError
from smallsat.report.typesetting import compile_part
from smallsat.report.values import Content
from smallsat.workflow.explain import Subject, known_of, subjects

# From the site's folder, report/build/site, to that of the run.
UP = "../../../"
SORTS = {
    "value": "Values",
    "erratum": "Errata",
    "claim": "Claims",
    "artefact": "Tables and figures",
}


def write_site(content: Path, project: Path, output: Path) -> None:
    """Write all pages.

    Parameters
    ----------
    content
        JSON of `smallsat.report.content.collect`, in ``report/build`` of the run, of all studies
        or of one; beside it the PDF, and of a what-if the comparison of each study.
    project
        Folder of the project, with ``report`` and ``data/published``.
    output
        Folder of the site, in ``report/build`` of the run; what lies there is replaced.
    """
    said, run = json.loads(content.read_text("utf-8")), output.resolve().parents[2]
    config = validate(said["config"], model_of(project))
    partial = output.with_name(f".{output.name}.partial")
    shutil.rmtree(partial, ignore_errors=True)
    (partial / "scenes").mkdir(parents=True)
    templates = project / "report/site"
    for asset in (project / "report/style.css", templates / "site.css", templates / "site.js"):
        shutil.copyfile(asset, partial / asset.name)
    with resources.as_file(resources.files("plotly") / "package_data/plotly.min.js") as library:
        shutil.copyfile(library, partial / "plotly.min.js")
    pages = Environment(
        loader=FileSystemLoader(templates), autoescape=True, undefined=StrictUndefined
    )
    pages.globals |= {
        "studies": said["documents"],
        "whole": len(said["documents"]) > 1,
        "what_if": said["run"]["what_if"],
        "pdf": content.with_suffix(".pdf").name,
        "up": UP,
        "home": UP + os.path.relpath(project.resolve(), run) + "/",
    }
    known = subjects(project / "data/published")

    def write(name: str, template: str, **given: Any) -> None:
        text = pages.get_template(template).render(page=name, **given)
        (partial / name).write_text(text, "utf-8")

    def write_prose(name: str, part: str, title: str, **given: Any) -> None:
        write(name, "prose.html.j2", title=title, body=_part(content, project, part), **given)

    title = "Small-satellite guidance and control, rerun"
    write_prose("index.html", "front", title, compared=said["documents"])
    for document in said["documents"]:
        study = document["key"]
        scenes = _scenes(study, config, run)
        for scene in scenes:
            name = f"{study}-{scene.name}"
            script = f'smallsatScenes["{name}"] = {figure(scene).to_json()};\n'
            (partial / f"scenes/{name}.js").write_text(script, "utf-8")
        title = f"{document['subject']}, rerun"
        given = {"study": document, "scenes": scenes, "compared": [document]}
        write_prose(f"{study}.html", study, title, **given)
        own = [subject for subject in known if subject.study.name == study]
        sorts = _known(own, project, run)
        write(f"{study}-details.html", "details.html.j2", study=document, sorts=sorts)
    if pages.globals["whole"]:
        write_prose("pipeline.html", "pipeline", "The pipeline itself")
    write("values.html", "values.html.j2", rows=_rows(said["values"], known))
    write("errata.html", "errata.html.j2")
    shutil.rmtree(output, ignore_errors=True)
    partial.rename(output)


def _part(content: Path, project: Path, part: str) -> Markup:
    """A part of the report as Typst writes it for a page; headings begin at the first level."""
    html = compile_part(content, project, part, UP)
    found = re.search(r"<main>(.*)</main>", html, re.DOTALL)
    if found is None:
        raise InputError(f"report/report.typ: the part '{part}' has no <main>; restore it")
    # The front has a title, and under it headings of the second level; Typst counts them on.
    shifted = r"<(/?)h([3-6])\b" if part == "front" else r"<(/?)h([2-6])\b"
    return Markup(re.sub(shifted, lambda it: f"<{it[1]}h{int(it[2]) - 1}", found[1]))


def _scenes(study: str, config: Config, run: Path) -> list[Scene]:
    """The scenes of a study that has any, but for those whose figure a what-if leaves out."""
    module = study_module(study, "figures.interactive")
    found = module.scenes(config[study], run / "data/results" / study) if module else []
    return [scene for scene in found if (run / f"{scene.fallback}.svg").exists()]


def _known(own: list[Subject], project: Path, run: Path) -> list[Content]:
    """What is known of the subjects of a study, by sort."""
    return [
        {
            "title": title,
            "subjects": [
                {"name": one.name, "lines": known_of(one, project, run)}
                for one in own
                if one.sort == sort
            ],
        }
        for sort, title in SORTS.items()
    ]


def _rows(values: Mapping[str, Mapping[str, str]], known: list[Subject]) -> list[Content]:
    """All printed values, with what a filter asks for."""
    return [
        {**values[one.name], **{key: one.row[key] for key in ("locator", "quantity", "kind")}}
        | {"id": one.name, "study": one.study.name}
        for one in known
        if one.sort == "value" and one.name in values
    ]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``site``."""
    parser.add_argument("content", type=Path, help="what the report says, JSON")
    parser.add_argument("--project", required=True, type=Path, help="folder of the project")
    parser.add_argument("--output", required=True, type=Path, help="folder of the site")


def main(arguments: argparse.Namespace) -> None:
    """Write all pages."""
    write_site(arguments.content, arguments.project, arguments.output)
