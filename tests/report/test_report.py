"""The report of a small run: content, PDF and page, for the reproduction and a what-if run."""

import json
import shutil
from html.parser import HTMLParser
from pathlib import Path

import matplotlib.pyplot as plt
import pandas as pd
import pytest
import yaml

from smallsat.drawing.figure import save_figure
from smallsat.drawing.style import apply_style
from smallsat.errors import InputError
from smallsat.evidence.claims import CLAIM_COLUMNS
from smallsat.evidence.errata import ERRATA_COLUMNS
from smallsat.evidence.ledger import ARTEFACT_COLUMNS, VALUE_COLUMNS, read_ledger
from smallsat.evidence.not_converged import NotConverged, not_converged_table
from smallsat.evidence.verdicts import VERDICT_COLUMNS
from smallsat.report.content import collect
from smallsat.report.typesetting import compile_part, compile_report
from smallsat.results import write_json, write_table

PROJECT = Path(__file__).parents[2]
CONFIG = {"run": "", "transfer": {"radius": 1.5, "degrees": [2, 3]}}
VALUES = """\
transfer/a,Table 1,terminal time,Direct N=2,,3.24694,s,result,
transfer/b,Table 1,terminal mass,Direct N=2,,-0.7555,,result,
transfer/c,Section 3,elapsed time,Direct N=2,,0.156,s,timing,
transfer/d,Listing 4,radius,,,1.5,,input,
"""
ARTEFACTS = """\
Table 1,table,Performance,computed,data/results/transfer/tables/table-1.csv
Figure 1,figure,Angle \\beta,computed,figures/transfer/fig-01.svg
Animation 1,animation,A film,computed,figures/transfer/animation-1.mp4
"""
OUTCOMES = {
    "transfer/a": (3.2469412, 1.2e-6, "reproduced", "equal to the printed digits"),
    "transfer/b": (-0.7444, 0.0111, "mismatch", "not explained"),
    "transfer/c": (float("nan"), float("nan"), "context", "depends on the machine"),
    "transfer/d": (1.5, 0.0, "reproduced", "feeds transfer.radius"),
}


def write_run(run: Path, published: Path) -> None:
    """Results of a study."""
    results = run / "data/results"
    rows = read_ledger(published / "transfer/values.csv")
    columns = ("computed", "difference", "verdict", "reason")
    judged = [row | dict(zip(columns, OUTCOMES[row["id"]], strict=True)) for row in rows]
    verdicts = pd.DataFrame(judged, columns=list(VERDICT_COLUMNS))
    write_table(verdicts, results / "verdicts.csv")
    erratum = dict.fromkeys(ERRATA_COLUMNS, "two mass rows are copies") | {"holds": True}
    claim = dict.fromkeys(CLAIM_COLUMNS, "the time falls") | {"outcome": "fails"}
    tables = {
        "errata": pd.DataFrame([erratum | {"key": "copied-row"}]),
        "claims": pd.DataFrame([claim]),
        "timings": pd.DataFrame({"id": ["transfer/c"], "seconds": [0.01234567]}),
        "not-converged": not_converged_table(
            [NotConverged("indirect, K = 4", "residual 2.0e-03", 2e-3, "guess; continuation")]
        ),
        "beyond": pd.DataFrame({"solver": ["ours"], "time": [3.246812345]}),
        "tables/table-1": verdicts.head(2),
    }
    for name, table in tables.items():
        write_table(table, results / f"transfer/{name}.csv")
    apply_style()
    for name, width in (("fig-01", 3.0), ("beyond", 6.3)):
        figure, axes = plt.subplots(figsize=(width, 2.0))
        axes.plot([0, 1])
        save_figure(figure, run / f"figures/transfer/{name}", pd.DataFrame({"y": [0, 1]}))
        plt.close(figure)


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """The project's own templates around a small ledger."""
    folder = tmp_path_factory.mktemp("project")
    shutil.copytree(PROJECT / "report", folder / "report", ignore=shutil.ignore_patterns("build"))
    # Chapters and summaries quote values of the whole ledger.
    for part in ("chapters", "summaries"):
        shutil.rmtree(folder / "report" / part)
        (folder / "report" / part).mkdir()
    (folder / "report/summaries/transfer.typ").write_text(
        '#import "/report/parts/content.typ": printed, number-of, claims-with\n'
        '#let picture = ("figures/transfer/fig-01", "A line that rises.")\n'
        "#let figures = ()\n"
        '#let holds = [Half of it: #printed("transfer/a") s comes out; results reproduced: '
        '#number-of("transfer", "reproduced"), claims that fail: '
        '#claims-with("transfer", "fails").]'
    )
    (folder / "report/chapters/transfer.typ").write_text(
        '#import "/report/parts/content.typ": setting, printed, computed\n'
        '$ dot(r) = v $ with radius #setting("transfer.radius"), degrees '
        '#setting("transfer.degrees"), time #printed("transfer/a") or #computed("transfer/a").'
    )
    # What the last chapter shows.
    shutil.copytree(PROJECT / "data/accepted/pipeline", folder / "data/accepted/pipeline")
    shutil.copy(PROJECT / "data/accepted/seconds.csv", folder / "data/accepted")
    # Title page and packages.
    for name in ("CITATION.cff", "requirements.lock"):
        shutil.copy(PROJECT / name, folder)
    published = folder / "data/published"
    (published / "transfer").mkdir(parents=True)
    own = published / "transfer"
    (own / "study.yaml").write_text(
        "{order: 1, title: A paper, subject: Transfers, values: 4, artefacts: 3}"
    )
    (own / "values.csv").write_text(",".join(VALUE_COLUMNS) + "\n" + VALUES)
    (own / "artefacts.csv").write_text(",".join(ARTEFACT_COLUMNS) + "\n" + ARTEFACTS)
    extra = {
        "title": "Other solvers",
        "text": "The same problem, solved otherwise.",
        "table": "data/results/transfer/beyond.csv",
        "figures": ["figures/transfer/beyond"],
    }
    (published / "transfer/extras.yaml").write_text(yaml.safe_dump([extra]))
    return folder


def build(project: Path, folder: str, config: dict) -> Path:
    run = project / folder
    write_run(run, project / "data/published")
    content = run / "report/build/content.json"
    write_json(collect(project, run, config, CONFIG), content)
    compile_report(content, project, content.with_name("report.pdf"))
    content.with_name("report.html").write_text(pages(content, project))
    return content.parent


def pages(content: Path, project: Path) -> str:
    """Both pages of the report, as beside its content."""
    parts = ("front", "transfer")
    return "".join(compile_part(content, project, part, "../../") for part in parts)


@pytest.fixture(scope="module")
def reproduction(project):
    return build(project, ".", CONFIG)


def test_the_chapter_on_the_pipeline_is_typeset_so_that_it_can_be_read_aloud(project, reproduction):
    """Only the whole report has it; PDF/UA refuses what has no alternative text."""
    template = project / "report/report.typ"
    source = template.read_text()
    assert "content.documents.len() > 1" in source
    template.write_text(source.replace("content.documents.len() > 1", "true"))
    try:
        compile_report(reproduction / "content.json", project, reproduction / "whole.pdf")
    finally:
        template.write_text(source)
    whole, alone = (reproduction / name for name in ("whole.pdf", "report.pdf"))
    assert whole.stat().st_size > alone.stat().st_size


class Page(HTMLParser):
    """Text and links of a page."""

    def __init__(self, path: Path):
        super().__init__()
        self.links: list[str] = []
        self.ids: set[str] = set()
        self.pieces: list[str] = []
        self.feed(path.read_text())
        # Keys may break at a space of no width.
        self.text = " ".join("".join(self.pieces).replace("\u200b", "").split())

    def handle_starttag(self, tag, attrs):
        """Note where an element leads, and its name."""
        named = dict(attrs)
        self.links += [named[key] for key in ("src", "href") if named.get(key)]
        self.ids.add(named.get("id"))
        if tag not in ("span", "code", "a", "sup", "em", "strong"):
            self.pieces.append(" ")

    def handle_data(self, data):
        """Note text."""
        self.pieces.append(data)


def test_the_page_shows_printed_computed_difference_and_verdict(reproduction):
    text = Page(reproduction / "report.html").text
    assert "terminal time s 3.24694 3.2469412 +1.2×10-6 reproduced" in text
    assert "terminal mass -0.7555 -0.744400 +0.011 mismatch a" in text
    assert "a not explained" in text
    assert "0.156 0.0123 — context" in text


def test_the_page_has_every_part_of_a_study(reproduction):
    page = Page(reproduction / "report.html")
    for part in (
        "Method", "Tables", "Figures", "Animations", "Values printed in the text", "Errata",
        "Claims", "Beyond the document", "Inputs",
    ):  # fmt: skip
        assert part in page.text
    assert "with radius 1.5, degrees 2, 3, time 3.24694 or 3.2469412" in page.text
    assert "Angle β" in page.text
    assert "ours 3.246812" in page.text
    assert "transfer.radius 1.5 reproduced Listing 4" in page.text
    assert "transfer-figure-1" in page.ids


def test_the_page_links_figures_as_files_and_every_link_leads_somewhere(reproduction):
    page = Page(reproduction / "report.html")
    assert "../../figures/transfer/fig-01.svg" in page.links
    assert "base64" not in (reproduction / "report.html").read_text()
    for link in page.links:
        if link.startswith("#"):
            assert link[1:] in page.ids
        # Films are made only when asked for, and articles lie elsewhere.
        elif not link.endswith(".mp4") and not link.startswith("https://doi.org/"):
            assert (reproduction / link).exists(), link


def test_the_front_says_what_was_found(reproduction):
    """Two sentences with numbers of the results, a described picture, the shares, what fails."""
    page = Page(reproduction / "report.html")
    front = page.text.split("How to read this report")[0]
    for words in (
        "Half of it: 3.24694 s comes out; results reproduced: 1, claims that fail: 1.",
        "2 results: 1 reproduced, 1 mismatch",
        "1 claims: 1 fails",
        "What fails",
        "mismatch transfer/b: printed -0.7555",
    ):
        assert words in front
    text = (reproduction / "report.html").read_text()
    assert 'alt="A line that rises."' in text
    assert 'aria-label="2 results: 1 reproduced, 1 mismatch"' in text


def test_what_did_not_hold_ends_a_chapter(reproduction):
    """Mismatches, errata and claims, each with its reason."""
    last = Page(reproduction / "report.html").text.rpartition("What did not hold")[2]
    for finding in ("transfer/b", "two mass rows are copies", "the time falls"):
        assert finding in last


def test_both_formats_are_byte_identical_when_built_again(project, reproduction):
    report = reproduction / "report.pdf"
    before = report.read_bytes()
    compile_report(reproduction / "content.json", project, report)
    assert report.read_bytes() == before
    page = (reproduction / "report.html").read_text()
    assert pages(reproduction / "content.json", project) == page


def test_the_pdf_is_tagged_titled_and_kept(reproduction):
    """As it says itself: PDF/UA, whose rules the compiler checks, and PDF/A."""
    said = (reproduction / "report.pdf").read_bytes()
    for mark in (
        b"/MarkInfo<</Marked true",
        b"<pdfuaid:part>1<",
        b"<pdfaid:part>2<",
        b"/Lang(en-GB)",
        b"/DisplayDocTitle true",
        b"/Alt(A line that rises.)",
        b"/Alt(Other solvers. The same problem",
        b"/Alt(r dot = v)",
    ):
        assert mark in said, mark


def test_a_what_if_run_says_so_and_what_it_changes(project, reproduction):
    config = {"run": "wide", "transfer": {"radius": 2.5, "degrees": [2, 3]}}
    what_if = build(project, "runs/wide", config)
    page = Page(what_if / "report.html")
    assert "what-if run" in page.text
    assert "2.5 1.5" in page.text
    assert "../../figures/transfer/fig-01.svg" in page.links
    assert "This is the reproduction" in Page(reproduction / "report.html").text
    digests = [
        json.loads((build / "content.json").read_text())["run"]["digest"]
        for build in (what_if, reproduction)
    ]
    assert digests[0] != digests[1]


def test_a_missing_figure_or_table_names_the_command_that_makes_it(project, tmp_path):
    run = project / "runs/damaged"
    write_run(run, project / "data/published")
    (run / "figures/transfer/fig-01.svg").unlink()
    with pytest.raises(InputError, match=r"no such figure; run `snakemake figures/transfer/fig-01"):
        collect(project, run, CONFIG, CONFIG)
    (run / "data/results/transfer/claims.csv").unlink()
    with pytest.raises(InputError, match=r"claims.csv: no such results file; run `snakemake"):
        collect(project, run, CONFIG, CONFIG)


def test_a_broken_template_is_named_and_the_old_report_stays(project, reproduction):
    chapter = project / "report/chapters/transfer.typ"
    good, report = chapter.read_text(), reproduction / "report.pdf"
    before = report.read_bytes()
    chapter.write_text("#no-such-function()")
    try:
        with pytest.raises(InputError, match=r"not typeset: unknown variable.*transfer.typ:1:1"):
            compile_report(reproduction / "content.json", project, report)
    finally:
        chapter.write_text(good)
    assert report.read_bytes() == before


def test_an_erratum_gives_printed_and_correct(reproduction):
    front = Page(reproduction / "report.html").text
    copies = "two mass rows are copies"
    assert f"erratum {copies}: printed: {copies}; correct: {copies}." in front


def test_a_case_without_a_solution_is_listed_with_what_was_tried(reproduction):
    text = Page(reproduction / "report.html").text
    for words in ("not converged", "indirect, K = 4", "residual 2.0e-03", "guess; continuation"):
        assert words in text


def test_the_report_of_one_study_is_about_that_study_alone(project, reproduction):
    """From its own verdicts; no other study's results are needed."""
    results = project / "data/results"
    shutil.copy(results / "verdicts.csv", results / "transfer/verdicts.csv")
    content = collect(project, project, CONFIG, CONFIG, studies=["transfer"])
    assert [document["key"] for document in content["documents"]] == ["transfer"]


# Each means something to Typst, to a browser or to a shell.
HOSTILE = (
    '<script>alert(1)</script> #panic("run") #read("/CITATION.cff") $x^2$ *bold* _it_ `raw` '
    "@cited <label> = no heading // no remark \\ $(touch pwned) '\" & </main>"
)


def hostile(data, keys):
    """Content with the hostile text at the end of every text under one of the keys."""
    if isinstance(data, list):
        return [hostile(one, keys) for one in data]
    if isinstance(data, dict):
        return {
            key: f"{value} {HOSTILE}"
            if key in keys and isinstance(value, str)
            else hostile(value, keys)
            for key, value in data.items()
        }
    return data


def test_texts_of_the_results_are_no_code_and_no_markup(project, reproduction):
    """Captions, reasons, cases, settings: page and PDF show them to the letter and run nothing."""
    content = json.loads((reproduction / "content.json").read_text())
    keys = ("caption", "reason", "case", "status", "tried", "locator", "explanation", "evidence")
    keys += ("claim", "subject", "title", "text", "printed", "unit")
    documents = hostile(content["documents"], keys)
    run = content["run"] | {
        "what_if": True,
        "folder": HOSTILE,
        "changes": [{"key": HOSTILE, "value": HOSTILE, "default": HOSTILE}],
    }
    path = reproduction / "hostile.json"
    write_json(content | {"documents": documents, "run": run}, path)
    compile_report(path, project, reproduction / "hostile.pdf")
    page = "".join(compile_part(path, project, part, "") for part in ("front", "transfer"))
    tags = []
    parser = HTMLParser()
    parser.handle_starttag = lambda tag, attributes: tags.append(tag)
    parser.feed(page)
    assert "main" in tags and "script" not in tags
    assert page.count("&lt;script>alert(1)&lt;/script> #panic(") > 10
    assert "cff-version" not in page
    assert not list(project.rglob("pwned"))
