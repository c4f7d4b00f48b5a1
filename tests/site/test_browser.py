"""The web site in a real Chromium; `make .venv/browser` installs the driver, else it is skipped."""

import shutil
from pathlib import Path

import pytest

pytest.importorskip("playwright", reason="needs playwright: make .venv/browser")
pytest.importorskip(
    "axe_playwright_python", reason="needs axe-playwright-python: make .venv/browser"
)

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import sync_playwright

CHROMIUM = shutil.which("chromium")
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="needs chromium: apt-get install chromium")
# A phone, a tablet, a screen.
WIDTHS = (390, 768, 1440)
STUDIES = ("transfer", "mars", "slew", "racing", "rendezvous")
PAGES = ("index", "values", "errata", "mars-details", *STUDIES)
OVERLAPS = (Path(__file__).parent / "overlaps.js").read_text()
# One row and one entry of each look, for what depends on looks alone.
ONE_OF_EACH_LOOK = """() => {
  const seen = new Set();
  for (const one of document.querySelectorAll("main tbody tr, main article")) {
    const parts = [one, ...one.querySelectorAll("*")];
    const look = parts.map((part) => part.tagName + part.className).join(" ");
    if (seen.has(look)) one.remove();
    seen.add(look);
  }
}"""


@pytest.fixture(scope="session")
def context():
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        opened = browser.new_context()
        # A busy machine is no failure.
        opened.set_default_timeout(180_000)
        yield opened
        browser.close()


@pytest.fixture
def page(context):
    """A page that fails the test if it meets an error or asks another machine for anything."""
    opened = context.new_page()
    wrong: list[str] = []
    opened.on("console", lambda said: wrong.append(said.text) if said.type == "error" else None)
    opened.on("pageerror", lambda error: wrong.append(str(error)))
    opened.on("request", lambda asked: None if local(asked.url) else wrong.append(asked.url))
    yield opened
    opened.close()
    assert wrong == []


def local(address):
    """Whether nobody else is asked."""
    return address.startswith(("file:", "data:", "blob:"))


def violations(page, **options):
    """What axe finds: the rule and the first element that breaks it."""
    # Style sheets of a page on disk cannot be asked for again.
    options |= {"preload": False, "resultTypes": ["violations"]}
    found = Axe().run(page, options=options).response["violations"]
    return [(one["id"], one["nodes"][0]["html"]) for one in found]


def active(page, what):
    """A property of the element that has the keyboard."""
    return page.evaluate(f"document.activeElement.{what}")


@pytest.mark.parametrize("name", PAGES)
def test_a_page_fits_its_screen(page, site, name):
    """Nothing sticks out sideways or lies upon another; wide tables scroll by themselves."""
    page.goto(f"file://{site}/{name}.html")
    too_wide = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
    for width in WIDTHS:
        page.set_viewport_size({"width": width, "height": 900})
        assert (width, page.evaluate(too_wide), page.evaluate(OVERLAPS)) == (width, 0, [])


def test_an_overlap_is_seen(page, site):
    """A paragraph that is moved upon the one before it."""
    page.goto(f"file://{site}/index.html")
    page.add_style_tag(content="h1 + p { margin-top: -2rem; }")
    assert len(page.evaluate(OVERLAPS)) == 1


@pytest.mark.parametrize("name", PAGES)
def test_no_barrier(page, site, name):
    """By axe's rules; contrast, which takes long, once for each look, in light and in dark."""
    page.goto(f"file://{site}/{name}.html")
    assert violations(page, rules={"color-contrast": {"enabled": False}}) == []
    page.evaluate(ONE_OF_EACH_LOOK)
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        assert (scheme, violations(page, runOnly=["color-contrast"])) == (scheme, [])


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


def test_the_first_stop_skips_to_the_content(page, site):
    page.goto(f"file://{site}/index.html")
    page.keyboard.press("Tab")
    assert active(page, "className") == "skip"
    page.keyboard.press("Enter")
    assert active(page, "id") == "content"


@pytest.mark.parametrize(
    ("width", "columns"),
    [
        (390, "Quantity Printed Computed Verdict"),
        (1200, "Document Place Quantity Printed Computed Unit Verdict"),
    ],
)
def test_the_values_fit_their_screen(page, site, width, columns):
    """Nothing has to be scrolled sideways; a phone leaves columns out."""
    page.set_viewport_size({"width": width, "height": 900})
    page.goto(f"file://{site}/values.html")
    assert page.locator("#values thead th:visible").all_inner_texts() == columns.split()
    table = page.locator(".scroll.values")
    assert table.evaluate("one => one.scrollWidth - one.clientWidth") == 0


def test_a_wide_table_is_scrolled_by_keyboard(page, site):
    """On a phone a grid of results is wider than the screen; the keyboard reaches and moves it."""
    page.set_viewport_size({"width": 390, "height": 900})
    page.goto(f"file://{site}/transfer.html")
    wide = page.evaluate_handle(
        "[...document.querySelectorAll('.scroll')].find(one => one.scrollWidth > one.clientWidth)"
    ).as_element()
    assert wide.get_attribute("tabindex") == "0"
    wide.focus()
    page.keyboard.press("ArrowRight")
    page.wait_for_function("document.activeElement.scrollLeft > 0")


@pytest.mark.parametrize("name", ["mars", "racing", "rendezvous", "slew"])
def test_a_scene_is_drawn_when_asked_for(page, site, name):
    """Until then there is the figure, then a canvas that plays; all by keyboard."""
    page.goto(f"file://{site}/{name}.html")
    scene = page.locator("figure.scene").first
    assert scene.locator("img").count() == 1
    scene.locator("> button").focus()
    page.keyboard.press("Enter")
    scene.locator("> button", has_text="Play").wait_for()
    assert scene.locator(".stage canvas").count() > 0
    assert scene.locator("img").count() == 0
    # The place of what moves, before and while it plays.
    moved = "document.querySelector('.stage').data.at(-1).x[0]"
    start = page.evaluate(moved)
    assert active(page, "textContent") == "Play"
    page.keyboard.press("Enter")
    page.wait_for_function(f"{moved} !== {start}")
    assert active(page, "textContent") == "Pause"
    page.keyboard.press("Enter")
    assert active(page, "textContent") == "Play"


def test_a_scene_is_turned_by_keyboard(page, site):
    """There is no play where motion is to be reduced; arrows turn, and keep the distance."""
    page.emulate_media(reduced_motion="reduce")
    page.goto(f"file://{site}/mars.html")
    scene = page.locator("figure.scene").first
    scene.locator("> button").click()
    scene.locator(".stage:focus").wait_for()
    assert scene.locator("> button").count() == 0
    eye = "Object.values(document.activeElement.layout.scene.camera.eye)"
    before = page.evaluate(eye)
    page.keyboard.press("ArrowLeft")
    page.wait_for_function(f"{eye}[0] !== {before[0]}")
    after = page.evaluate(eye)
    assert sum(x * x for x in after) == pytest.approx(sum(x * x for x in before))
    assert after[2] == pytest.approx(before[2])
