"""The web site in a real Chromium; `make test-site` installs what it needs, else it is skipped."""

import shutil

import pytest

pytest.importorskip("playwright", reason="needs playwright: make test-site")
pytest.importorskip("axe_playwright_python", reason="needs axe-playwright-python: make test-site")

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import sync_playwright

CHROMIUM = shutil.which("chromium")
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="needs chromium: apt-get install chromium")
# A phone, a tablet, a screen.
WIDTHS = (390, 768, 1440)
PAGES = ("index", "values", "errata", "racing", "mars-details")


@pytest.fixture(scope="module")
def browser():
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield started
        started.close()


@pytest.fixture
def page(browser, site):
    """A page that fails the test if it meets an error or asks another machine for anything."""
    context = browser.new_context()
    opened = context.new_page()
    wrong: list[str] = []
    opened.on("console", lambda said: wrong.append(said.text) if said.type == "error" else None)
    opened.on("pageerror", lambda error: wrong.append(str(error)))
    opened.on("request", lambda asked: None if local(asked.url) else wrong.append(asked.url))
    yield opened
    context.close()
    assert wrong == []


def local(address):
    """Whether nobody else is asked."""
    return address.startswith(("file:", "data:", "blob:"))


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("name", PAGES)
def test_a_page_fits_its_screen(page, site, name, width):
    """Nothing sticks out sideways; wide tables scroll by themselves."""
    page.set_viewport_size({"width": width, "height": 900})
    page.goto(f"file://{site}/{name}.html")
    too_wide = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
    assert page.evaluate(too_wide) == 0


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("name", PAGES)
def test_no_barrier(page, site, name, scheme):
    """By axe's rules, contrast included, in light and in dark."""
    page.emulate_media(color_scheme=scheme)
    page.goto(f"file://{site}/{name}.html")
    # Style sheets of a page on disk cannot be asked for again.
    options = {"preload": False, "resultTypes": ["violations"]}
    found = Axe().run(page, options=options).response["violations"]
    assert [(one["id"], one["nodes"][0]["html"]) for one in found] == []


def test_filters_filter(page, site):
    """Text, document, kind and verdict together; the count says how many are left."""
    page.goto(f"file://{site}/values.html")
    page.fill("input[name=text]", "table 8")
    page.select_option("select[name=study]", "mars")
    page.select_option("select[name=verdict]", "erratum")
    shown = page.locator("#values tbody tr:visible")
    assert shown.count() == 1
    assert "-0.443" in shown.inner_text()
    assert page.locator("output[name=count]").inner_text().startswith("1 of ")
    shown.locator("a").click()
    assert page.locator("article:target dl").inner_text().count("-0.443") >= 1


def test_by_keyboard(page, site):
    """The first stop is the link that skips to the content, the next the pages."""
    page.goto(f"file://{site}/index.html")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.className") == "skip"
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.id") == "content"


@pytest.mark.parametrize("name", ["mars", "racing", "rendezvous", "slew"])
def test_a_scene_is_drawn_when_asked_for(page, site, name):
    """Until then there is the figure, then a canvas that plays."""
    page.goto(f"file://{site}/{name}.html")
    scene = page.locator("figure.scene").first
    assert scene.locator("img").count() == 1
    scene.locator("button").click()
    scene.locator(".stage canvas").first.wait_for(timeout=120_000)
    assert scene.locator("text=Play").count() == 1
    assert scene.locator("img").count() == 0


def test_reduced_motion(page, site):
    """There is no play."""
    page.emulate_media(reduced_motion="reduce")
    page.goto(f"file://{site}/mars.html")
    scene = page.locator("figure.scene").first
    scene.locator("button").click()
    scene.locator(".stage canvas").first.wait_for(timeout=120_000)
    assert scene.locator("text=Play").count() == 0
