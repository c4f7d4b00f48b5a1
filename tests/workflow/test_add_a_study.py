"""The page on adding a study, followed to the letter in a copy of the project."""

import re
import subprocess
from pathlib import Path

import pandas as pd
import pytest

PAGE = (Path(__file__).parents[2] / "docs/add-a-study.md").read_text()
FILES = dict(re.findall(r"^`([^`\n]+)`\n\n```\w+\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL))
COMMANDS = re.findall(r"^```sh\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


@pytest.fixture(scope="module")
def built(make_project):
    """A project in which everything on the page was written and typed."""
    project = make_project()
    for name, content in FILES.items():
        path = project.folder / name
        assert not path.exists(), f"{name} is a shared file"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content)
    for command in COMMANDS:
        done = subprocess.run(
            command, shell=True, cwd=project.folder, env=project.environment,
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stdout + done.stderr
    return project


def results(project, name):
    return pd.read_csv(project.folder / f"data/results/period/{name}.csv", dtype=str)


def test_the_page_is_short():
    """Less than a hundred lines of files, the JSON of the notebook apart."""
    lines = sum(text.count("\n") for name, text in FILES.items() if not name.endswith(".ipynb"))
    assert lines < 100, lines


def test_every_value_has_the_verdict_that_the_page_says(built):
    verdicts = results(built, "verdicts").set_index("id")["verdict"].to_dict()
    assert verdicts == {
        "period/section-1/radius": "reproduced",
        "period/section-1/period": "reproduced",
        "period/section-2/period": "erratum",
    }


def test_claim_and_erratum_are_as_the_page_pins_them(built):
    assert results(built, "claims")["outcome"].tolist() == ["holds"]
    assert results(built, "errata")["holds"].tolist() == ["True"]


def test_the_report_shows_chapter_figure_and_erratum(built):
    page = (built.folder / "report/build/period-site/period.html").read_text()
    for word in ("The period of a circular orbit", "5828.5", "figures/period/fig-1.svg", "97.41"):
        assert word in page, word
    assert (built.folder / "report/build/period.pdf").exists()


def test_the_other_studies_are_as_before(built):
    """The whole report is planned with what is there of the new study."""
    plan = built.jobs("report")
    assert "rendezvous_verdicts" in plan and "period_verdicts" not in plan
