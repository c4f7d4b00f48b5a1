"""The web site as files: whole, linked, safe, and without anything from elsewhere."""

import json
import re
from html.parser import HTMLParser
from urllib.parse import unquote

import pytest

from smallsat.workflow.explain import subjects

ARTICLES = ("https://doi.org/", "https://arxiv.org/")


class Page(HTMLParser):
    """Addresses and links of a page, and pictures without a description."""

    def __init__(self, path):
        super().__init__()
        self.ids: set[str] = set()
        self.links: list[str] = []
        self.headings: list[int] = []
        self.silent: list[str] = []
        self.feed(path.read_text())

    def handle_starttag(self, tag, attrs):
        """Take notes of one tag."""
        given = dict(attrs)
        self.ids |= {given["id"]} if "id" in given else set()
        self.links += [given[name] for name in ("href", "src") if name in given]
        if re.fullmatch("h[1-6]", tag):
            self.headings.append(int(tag[1]))
        if tag == "img" and not given.get("alt"):
            self.silent.append(given.get("src", ""))


@pytest.fixture(scope="module")
def pages(site):
    return {path.name: Page(path) for path in sorted(site.glob("*.html"))}


def test_a_page_for_each_question(pages, root):
    """What was found, each study and what is known of it, all values, the errata."""
    studies = [path.parent.name for path in (root / "data/published").glob("*/study.yaml")]
    wanted = {"index.html", "values.html", "errata.html", "pipeline.html"}
    wanted |= {f"{study}{end}.html" for study in studies for end in ("", "-details")}
    assert set(pages) == wanted


def test_everything_has_an_address(pages, root):
    """Every printed value, erratum, claim, table and figure, by the name `make explain` takes."""
    for subject in subjects(root / "data/published"):
        assert subject.name in pages[f"{subject.study.name}-details.html"].ids, subject.name


def test_every_link_leads_somewhere(pages, site):
    """To a file, and to an address that its page has; to another machine only for an article."""
    for name, page in pages.items():
        for link in page.links:
            if re.match(r"[a-z]+:|//", link):
                assert link == "data:," or link.startswith(ARTICLES), f"{name}: {link}"
                continue
            file, _, anchor = link.partition("#")
            # Notebooks of the project are there; those that were run, and what they draw, are not.
            ran = file.endswith(".ipynb") and "data/results" in file
            if not ran and not file.endswith((".mp4", ".pdf", ".png", ".csv")):
                assert (site / file).exists(), f"{name}: {link}"
            if anchor and (file or name) in pages:
                assert unquote(anchor) in pages[file or name].ids, f"{name}: {link}"


def test_a_citation_leads_to_the_references_of_its_page(pages, site):
    """Each page of a study cites what it rests on, and lists it with its authors."""
    text = (site / "mars.html").read_text()
    cited = re.findall(r'href="#([\w-]+)" role="doc-biblioref">\[(\d+)\]', text)
    listed = re.findall(r'<li id="([\w-]+)"><span class="prefix">.*?\[(\d+)\]', text)
    assert cited and set(cited) == set(listed)
    assert "Schaub" in text.partition("doc-bibliography")[2]


def test_a_what_if_of_one_study_has_a_site_of_its_own(what_if_site):
    """With its scenes and values, what it changes, and what differs; nothing of other studies."""
    names = {path.name for path in what_if_site.glob("*.html")}
    assert names == {"index.html", "mars.html", "mars-details.html", "values.html", "errata.html"}
    found = {name: Page(what_if_site / name) for name in names}
    test_every_link_leads_somewhere(found, what_if_site)
    assert "../mars-comparison.html" in found["index.html"].links
    assert "../mars.pdf" in found["values.html"].links
    front = (what_if_site / "index.html").read_text().replace("\u200b", "")
    assert re.search(r"mars.visibility_deg</code></td><td><code>40", front)
    assert list((what_if_site / "scenes").glob("mars-*.js"))
    rows = re.findall(r"<tr data-study=\"(\w+)\"", (what_if_site / "values.html").read_text())
    assert set(rows) == {"mars"}


def test_a_reader_without_sight_gets_along(pages):
    """Pictures are described, each page has one heading of the first level, none is skipped."""
    for name, page in pages.items():
        assert page.silent == [], name
        assert page.headings.count(1) == 1, name
        assert page.headings[0] == 1, name
        steps = zip(page.headings, page.headings[1:], strict=False)
        assert all(after <= before + 1 for before, after in steps), name
        assert "content" in page.ids, name


def test_scenes_have_frames(site, pages):
    """Each is a figure that Plotly understands, with a play; no page loads one unasked."""
    scenes = sorted((site / "scenes").glob("*.js"))
    assert {path.stem.partition("-")[0] for path in scenes} == {
        "mars", "racing", "rendezvous", "slew",
    }  # fmt: skip
    for path in scenes:
        found = re.fullmatch(r'smallsatScenes\["([\w.-]+)"\] = (.*);\n', path.read_text())
        figure = json.loads(found[2])
        assert found[1] == path.stem
        assert len(figure["frames"]) > 10
    assert not any("plotly" in link for page in pages.values() for link in page.links)


def test_the_table_has_every_value(site, root):
    """As many rows as are printed, each with what the filters ask for."""
    rows = re.findall(r"<tr data-study=\"(\w+)\"", (site / "values.html").read_text())
    values = [one for one in subjects(root / "data/published") if one.sort == "value"]
    assert len(rows) == len(values)
