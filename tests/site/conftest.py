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


@pytest.fixture(scope="session")
def site(root, tested_run):
    """Folder of the site."""
    # Tests on several cores build one each.
    run = root / f"runs/site-of-tests-{os.environ.get('PYTEST_XDIST_WORKER', 'alone')}"
    shutil.rmtree(run, ignore_errors=True)
    shutil.copytree(tested_run / "data", run / "data")
    for name, text in undrawn(root):
        (run / name).parent.mkdir(parents=True, exist_ok=True)
        if not (run / name).exists():
            (run / name).write_text(text)
    made = read_run(root, [root / "config/tests.yaml"], [])
    config, default = (json.loads(as_json(one)) for one in (made.config, made.default))
    content = run / "report/build/report.json"
    write_json(collect(root, run, config, default), content)
    write_site(content, root, run / "report/build/site")
    (run / "report/build/report.pdf").touch()
    yield run / "report/build/site"
    shutil.rmtree(run)
