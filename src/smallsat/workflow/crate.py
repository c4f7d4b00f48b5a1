"""Write down how a build came about: a Workflow Run RO-Crate of the whole project.

The crate follows the profile Provenance Run Crate 0.5 (https://w3id.org/ro/wfrun/provenance):
version of the code, lock, configuration, every file read and made with its SHA-256, every job with
its command and its times. It lies at the top of the project, so that its files are those of the
build.
"""

import argparse
import hashlib
import mimetypes
import platform
import subprocess
from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path
from typing import Any

from rocrate.model.contextentity import ContextEntity
from rocrate.rocrate import ROCrate

from smallsat.results import write_json
from smallsat.strict_yaml import read_yaml
from smallsat.workflow.job_records import JobRecord, files_of, jobs_behind
from smallsat.workflow.seconds import machine

_PROFILES = (
    "https://w3id.org/ro/wfrun/process/0.5",
    "https://w3id.org/ro/wfrun/workflow/0.5",
    "https://w3id.org/ro/wfrun/provenance/0.5",
    "https://w3id.org/workflowhub/workflow-ro-crate/1.0",
)
_TERMS = "https://w3id.org/ro/terms/workflow-run/context"
_PARAMETER = "https://bioschemas.org/profiles/FormalParameter/1.0-RELEASE"
# What the workflow as a whole takes and gives, and the files of each.
_TAKES = {
    "configuration": "config/default/",
    "environment": "requirements.lock",
    "published": "data/published/",
    "accepted": "data/accepted/",
}
_GIVES = {"results": "data/results/", "figures": "figures/", "report": "report/build/"}


def sha256(path: Path) -> str:
    """SHA-256 of a file, in hexadecimal digits."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def code_version(project: Path) -> str:
    """Version of the package; in a clone, also the commit and whether there are changes."""
    released = version("smallsat")
    call = ["git", "-C", str(project), "describe", "--always", "--dirty", "--exclude=*"]
    try:
        done = subprocess.run(call, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return released
    return f"{released}+g{done.stdout.strip()}"


def build_crate(project: Path, targets: Iterable[str], besides: Iterable[Path]) -> ROCrate:
    """The crate of a finished build.

    Parameters
    ----------
    project
        Folder of the project, which is that of the run.
    targets
        Files and folders that the build was to make; what is recorded is all that they rest on.
    besides
        Files that no job declares as its input, and that belong to the build all the same.
    """
    jobs = jobs_behind(targets, project / ".snakemake/metadata")
    made = {name for job in jobs for output in job.outputs for name in files_of(project, output)}
    read = {name for job in jobs for name in job.inputs if (project / name).is_file()} - made
    root = project.resolve()
    read |= {path.resolve().relative_to(root).as_posix() for path in besides}
    crate = ROCrate(version="1.1")
    crate.metadata.extra_contexts.append(_TERMS)
    files = {
        name: _add_file(crate, project, name) for name in sorted(made | read) if name != "Snakefile"
    }
    workflow = _add_workflow(crate, project)
    files["Snakefile"] = workflow
    parameters = _add_parameters(crate, workflow, files)
    _add_root(crate, project, jobs)
    whole = _add_action(
        crate,
        "#build",
        name="The build",
        description=f"On {platform.system()}, {machine()}.",
        instrument=workflow,
        began=min(job.began for job in jobs),
        ended=max(job.ended for job in jobs),
        takes=[files[name] for name in sorted(read)],
        gives=[files[name] for name in sorted(made)],
    )
    crate.root_dataset["mentions"] = [whole]
    _add_jobs(crate, project, workflow, whole, jobs, files)
    workflow["input"] = [parameters[name] for name in _TAKES]
    workflow["output"] = [parameters[name] for name in _GIVES]
    return crate


def _add_file(crate: ROCrate, project: Path, name: str) -> Any:
    path = project / name
    properties = _file_properties(path)
    return crate.add_file(path, name, properties=properties)


def _file_properties(path: Path) -> dict[str, str]:
    kind = mimetypes.guess_type(path.name)[0]
    known = {"encodingFormat": kind} if kind else {}
    return {"sha256": sha256(path), "contentSize": str(path.stat().st_size), **known}


def _add_workflow(crate: ROCrate, project: Path) -> Any:
    path = project / "Snakefile"
    return crate.add_workflow(
        path,
        path.name,
        main=True,
        lang="snakemake",
        lang_version=version("snakemake"),
        properties={
            "@type": ["File", "SoftwareSourceCode", "ComputationalWorkflow", "HowTo"],
            "name": "smallsat",
            "version": code_version(project),
            **_file_properties(path),
        },
    )


def _add_parameters(crate: ROCrate, workflow: Any, files: dict[str, Any]) -> dict[str, Any]:
    """What the workflow takes and gives, with each of its files as an example."""
    found = {}
    for name, place in (_TAKES | _GIVES).items():
        parameter = crate.add(
            ContextEntity(
                crate,
                f"#{name}",
                properties={
                    "@type": "FormalParameter",
                    "additionalType": "File",
                    "name": name,
                    "description": f"Files of {place}",
                    "conformsTo": {"@id": _PARAMETER},
                },
            )
        )
        examples = [file for path, file in files.items() if path.startswith(place)]
        parameter["workExample"] = examples
        for file in examples:
            file["exampleOfWork"] = parameter
        found[name] = parameter
    return found


def _add_root(crate: ROCrate, project: Path, jobs: list[JobRecord]) -> None:
    citation = read_yaml(project / "CITATION.cff")
    crate.name = citation["title"]
    crate.description = f"A finished build of {citation['title']}, with all that it rests on."
    crate.license = f"https://spdx.org/licenses/{citation['license']}"
    crate.datePublished = max(job.ended for job in jobs)
    crate.root_dataset["conformsTo"] = [
        crate.add(
            ContextEntity(
                crate,
                profile,
                properties={
                    "@type": "CreativeWork",
                    "name": profile.split("/")[-2],
                    "version": profile.split("/")[-1],
                },
            )
        )
        for profile in _PROFILES
    ]


def _add_jobs(
    crate: ROCrate,
    project: Path,
    workflow: Any,
    whole: Any,
    jobs: list[JobRecord],
    files: dict[str, Any],
) -> None:
    """Each job as an action, with the step of the workflow that it carried out."""
    tool = crate.add(
        ContextEntity(
            crate,
            "#python",
            properties={
                "@type": "SoftwareApplication",
                "name": "Python, with the packages of requirements.lock",
                "softwareVersion": platform.python_version(),
                "url": "https://www.python.org",
            },
        )
    )
    engine = crate.add(
        ContextEntity(
            crate,
            "#snakemake-engine",
            properties={
                "@type": "SoftwareApplication",
                "name": "Snakemake",
                "softwareVersion": version("snakemake"),
                "url": "https://snakemake.github.io",
            },
        )
    )
    steps, controls = [], []
    for job in jobs:
        step = crate.add(
            ContextEntity(
                crate, f"#step-{job.rule}", properties={"@type": "HowToStep", "name": job.rule}
            )
        )
        step["workExample"] = tool
        action = _add_action(
            crate,
            f"#job-{job.rule}",
            name=job.rule,
            description=job.command,
            instrument=tool,
            began=job.began,
            ended=job.ended,
            takes=[
                files[name]
                for path in job.inputs
                for name in sorted(files_of(project, path))
                if name in files
            ],
            gives=[files[name] for path in job.outputs for name in sorted(files_of(project, path))],
        )
        control = crate.add(
            ContextEntity(
                crate,
                f"#control-{job.rule}",
                properties={"@type": "ControlAction", "name": f"Run {job.rule}"},
            )
        )
        control["instrument"] = step
        control["object"] = action
        steps.append(step)
        controls.append(control)
    organised = crate.add(
        ContextEntity(
            crate,
            "#organisation",
            properties={"@type": "OrganizeAction", "name": "Snakemake runs the jobs"},
        )
    )
    organised["instrument"] = engine
    organised["object"] = controls
    organised["result"] = whole
    workflow["step"] = steps
    workflow["hasPart"] = [tool]


def _add_action(
    crate: ROCrate,
    identifier: str,
    *,
    name: str,
    description: str,
    instrument: Any,
    began: Any,
    ended: Any,
    takes: list[Any],
    gives: list[Any],
) -> Any:
    return crate.add_action(
        instrument,
        identifier,
        object=takes,
        result=gives,
        properties={
            "@type": "CreateAction",
            "name": name,
            "description": description,
            "startTime": began.isoformat(),
            "endTime": ended.isoformat(),
            "actionStatus": {"@id": "http://schema.org/CompletedActionStatus"},
        },
    )


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``crate``."""
    parser.add_argument("targets", nargs="+", help="what the build was to make")
    parser.add_argument(
        "--besides", nargs="*", type=Path, default=[], help="files that no job declares"
    )
    parser.add_argument("--output", type=Path, required=True)


def main(arguments: argparse.Namespace) -> None:
    """Write the crate of the build in this folder."""
    crate = build_crate(Path(), arguments.targets, arguments.besides)
    write_json(crate.metadata.generate(), arguments.output)
