"""What-if runs beside the reproduction, or its accepted results: only what differs is shown."""

import re
import shutil

import pandas as pd
import pytest

from smallsat.errors import InputError
from smallsat.results import read_table, write_json, write_table
from smallsat.site.comparison import CHANGES, write_comparison

TABLES = ("verdicts.csv", "claims.csv", "errata.csv")
VALUE = "mars/table-8/sigma-b-n-at-t-3400-s/full-mission/1"


@pytest.fixture
def project(root, tested_run, tmp_path):
    """The project with the Mars results of the tests' run as its reproduction, and one figure."""
    for name in ("data/published", "data/accepted", "report"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).symlink_to(root / name)
    for name in TABLES:
        target = tmp_path / "data/results/mars" / name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(tested_run / "data/results/mars" / name, target)
    draw(tmp_path, "x\n1\n")
    return tmp_path


def draw(folder, data):
    for suffix, text in (("csv", data), ("svg", "<svg/>")):
        path = folder / f"figures/mars/fig-10.{suffix}"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


@pytest.fixture
def made(project):
    """Makes a run that changes one value, one claim and a figure, or nothing."""

    def make(name, factor=1.0, data="x\n1\n"):
        run = project / "runs" / name
        shutil.copytree(project / "data/results", run / "data/results")
        table = read_table(run / "data/results/mars/verdicts.csv")
        table.loc[table["id"] == VALUE, "computed"] *= factor
        write_table(table, run / "data/results/mars/verdicts.csv")
        claims = read_table(run / "data/results/mars/claims.csv")
        claims.loc[claims["id"] == "velocity", "outcome"] = "holds" if factor == 1.0 else "fails"
        write_table(claims, run / "data/results/mars/claims.csv")
        draw(run, data)
        change = {"key": "mars.visibility_deg", "value": "40.0", "default": "35.0"}
        write_json([change] if factor != 1.0 else [], run / CHANGES)
        return run

    return make


def test_only_what_differs_is_shown(project, made):
    """One setting, one value with its change, one claim, one figure; and nothing of a run alike."""
    runs = {"narrow": made("narrow", 1.25, "x\n2\n"), "alike": made("alike")}
    page = project / "runs/comparison.html"
    (found,) = write_comparison(project, runs, "", page)
    assert (found["study"], found["built"]) == ("mars", True)
    assert found["settings"] == [
        {"key": "mars.visibility_deg", "before": "35.0", "now": ["40.0", "35.0"]}
    ]
    (value,) = found["values"]
    assert value["name"] == VALUE
    assert [one["change"] for one in value["now"]] == ["+25 %", ""]
    (outcome,) = found["outcomes"]
    assert outcome["before"] == "holds" and outcome["now"] == ["fails", "holds"]
    (figure,) = found["figures"]
    assert [name for name, _ in figure["drawn"]] == ["reproduction", "narrow", "alike"]
    text = page.read_text()
    links = re.findall(r'(?:src|href)="([^"#:]+)"', text)
    assert links and all((page.parent / link).exists() for link in links)
    assert not re.search(r'="https?:', text)


def test_without_a_reproduction_the_accepted_results_stand_in(project, made):
    """The tests' run is not the reproduction; of the Mars study what is not random is the same."""
    run = made("narrow", 1.25)
    shutil.rmtree(project / "data/results")
    (found,) = write_comparison(project, {"narrow": run}, "mars", project / "page.html")
    assert not found["built"] and found["figures"] == []
    assert VALUE in [one["name"] for one in found["values"]]
    assert "accepted results stand in its place" in (project / "page.html").read_text()


def test_cases_without_a_solution_are_named(project, made):
    run = made("narrow")
    row = {"case": "a <b> case", "status": "diverged", "residual": 1.0, "tried": "all"}
    write_table(pd.DataFrame([row]), run / "data/results/mars/not-converged.csv")
    write_comparison(project, {"narrow": run}, "", project / "page.html")
    assert "1 cases did not converge: a &lt;b&gt; case" in (project / "page.html").read_text()


def test_a_folder_without_results_is_refused(project):
    (project / "runs/none").mkdir(parents=True)
    with pytest.raises(InputError, match=r"runs/none: no what-if run with results; make one"):
        write_comparison(project, {"none": project / "runs/none"}, "", project / "page.html")
