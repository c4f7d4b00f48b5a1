"""The web site of the tests' run, with empty pictures and tables where notebooks make them."""

import json
import os
import shutil

import pandas as pd
import pytest

from smallsat.catalogue import read_catalogue
from smallsat.config import as_json
from smallsat.evidence.ledger import read_artefacts
from smallsat.report.content import collect
from smallsat.results import write_json
from smallsat.site.pages import write_site
from smallsat.strict_yaml import read_yaml
from smallsat.workflow.run import read_run

PICTURE = '<svg xmlns="http://www.w3.org/2000/svg" width="300pt" height="200pt"></svg>\n'


def undrawn(root):
    """What a report shows and notebooks make, which no test runs: file and text of each."""
    for study in read_catalogue(root / "data/published"):
        folder = root / "data/published" / study.name
        for row in read_artefacts(folder / "artefacts.csv"):
            if row["kind"] == "figure" and row["target"]:
                yield row["target"], PICTURE
            if row["kind"] == "table" and row["target"]:
                yield row["target"], "empty\n"
        path = folder / "extras.yaml"
        for extra in (read_yaml(path) or []) if path.exists() else []:
            yield from ((f"{stem}.svg", PICTURE) for stem in extra.get("figures") or [])
            if extra.get("table"):
                header = pd.DataFrame(columns=list(extra.get("columns") or ["empty"]))
                yield extra["table"], header.to_csv(index=False)


def written(root, tested_run, name, change, studies):
    """The site of a run with the tests' results: all studies, or those that are named."""
    # Tests on several cores build one each.
    run = root / f"runs/{name}-{os.environ.get('PYTEST_XDIST_WORKER', 'alone')}"
    shutil.rmtree(run, ignore_errors=True)
    shutil.copytree(tested_run / "data", run / "data")
    for file, text in undrawn(root):
        (run / file).parent.mkdir(parents=True, exist_ok=True)
        if not (run / file).exists():
            (run / file).write_text(text)
    made = read_run(root, [root / "config/tests.yaml"], change)
    config, default = (json.loads(as_json(one)) for one in (made.config, made.default))
    report, folder = (
        (f"{studies[0]}.json", f"{studies[0]}-site") if studies else ("report.json", "site")
    )
    content = run / "report/build" / report
    write_json(collect(root, run, config, default, studies=studies), content)
    write_site(content, root, content.parent / folder)
    # What the pages link beside them.
    content.with_suffix(".pdf").touch()
    for study in read_catalogue(root / "data/published"):
        (content.parent / f"{study.name}-comparison.html").touch()
    yield content.parent / folder
    shutil.rmtree(run)


@pytest.fixture(scope="session")
def site(root, tested_run):
    """Folder of the site."""
    yield from written(root, tested_run, "site-of-tests", [], [])


@pytest.fixture(scope="session")
def what_if_site(root, tested_run):
    """Folder of the site of a what-if of one study."""
    change = ['mars={"visibility_deg": 40}']
    yield from written(root, tested_run, "what-if-of-tests", change, ["mars"])
