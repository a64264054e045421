"""The look in a browser: the palette arrives in both themes, and everything on it can be read."""

import re
from collections.abc import Iterator

import matplotlib as mpl
import pytest
from contrast import GROUNDS, contrast
from playwright.sync_api import Page

from robo_genesis.core import plotting
from robo_genesis.core.palette import MARKS, PARTS
from robo_genesis.lessons.l04 import spec

pytestmark = [pytest.mark.engine, pytest.mark.browser]

CASES = {
    "baseline": "baseline"
} | spec.CASE_MARKS  # The mark of each case on the lecture

LECTURE = "lessons/l04-joint-control/motion.html"
TEXT = 4.5


SHOWN = """selectors => selectors.map(selector =>
  [...document.querySelectorAll(selector)].filter(one => one.checkVisibility()).length)"""
FOLDS = "article .sd-summary-content > p"


def hexadecimal(colour: str) -> str:
    """Return `rgb(r, g, b)` as `#rrggbb`."""
    return "#" + "".join(f"{int(part):02x}" for part in re.findall(r"\d+", colour)[:3])


@pytest.fixture(scope="module", params=["light", "dark"])
def theme(request) -> str:
    return request.param


@pytest.fixture(scope="module")
def page(browser, address, theme) -> Iterator[Page]:
    window = {"viewport": {"width": 1280, "height": 900}, "reduced_motion": "reduce"}
    page = browser.new_page(**window, color_scheme=theme)
    page.goto(f"{address}/{LECTURE}")
    page.wait_for_function(f"document.documentElement.dataset.theme === {theme!r}")
    yield page
    page.close()


def style(page: Page, selector: str, name: str) -> str:
    script = (
        "([selector, name]) => getComputedStyle(document.querySelector(selector))[name]"
    )
    return page.evaluate(script, [selector, name])


def test_the_page_s_ground_is_one_that_the_palette_was_held_against(page, theme):
    assert hexadecimal(style(page, "body", "backgroundColor")) in GROUNDS[theme]
    recorded = "<div class='evidence-panel'></div>"  # of a lab with a recorded run
    add = "(one, recorded) => one.insertAdjacentHTML('beforeend', recorded)"
    page.locator("article").evaluate(add, recorded)
    panel = hexadecimal(style(page, "div.evidence-panel", "backgroundColor"))
    assert panel in GROUNDS[theme]


def test_the_word_of_each_badge_can_be_read(page):
    for state in ("verified", "inconclusive", "missing", "stale", "failed", "refused"):
        badge = f"evidence-badge state-{state}"
        page.evaluate(
            f"document.querySelector('.evidence-badge').className = '{badge}'"
        )
        pair = (
            style(page, ".evidence-badge", name)
            for name in ("color", "backgroundColor")
        )
        assert contrast(*map(hexadecimal, pair)) >= TEXT, state


def test_on_paper_the_menus_are_gone_and_folds_can_be_read(page):
    sidebars = ["#pst-primary-sidebar", "#pst-secondary-sidebar"]
    menus = [".bd-header-article", *sidebars, ".prev-next-footer"]
    folded = page.locator(FOLDS).count()
    assert min(page.evaluate(SHOWN, menus)) > 0
    assert page.evaluate(SHOWN, [FOLDS])[0] < folded
    page.emulate_media(media="print")
    assert page.evaluate(SHOWN, [*menus, FOLDS]) == [*[0] * len(menus), folded]
    page.emulate_media(media="screen")


LEFT_OUT = """() => [...document.querySelectorAll("article section > h2")]
  .filter(one => !one.checkVisibility()).map(one => one.parentElement.id)"""
ANSWERS = ["article .choice details", "article .solution"]


def test_a_lecture_prints_without_answers_and_then_with_them_again(page):
    page.evaluate("""window.print = () => {
      printed = document.body.className;
      dispatchEvent(new Event("afterprint"));
    }""")
    page.get_by_label("Download this page").click()
    page.get_by_role("button", name="without answers").click()
    classes = page.evaluate("[printed, document.body.className]")
    assert classes == ["no-answers", ""]
    page.emulate_media(media="print")
    assert min(page.evaluate(SHOWN, ANSWERS)) > 0
    page.evaluate("document.body.className = 'no-answers'")
    assert page.evaluate(SHOWN, ANSWERS) == [0, 0]
    assert page.evaluate(LEFT_OUT) == ["checks"]
    page.evaluate("document.body.className = ''")
    page.emulate_media(media="screen")


def test_the_reference_prints_on_two_sheets(browser, address):
    page = browser.new_page()
    page.goto(f"{address}/reference.html")
    sheets = re.findall(rb"/Type /Page\b", page.pdf(prefer_css_page_size=True))
    page.close()
    assert len(sheets) == 2


def test_a_figure_has_the_colours_of_the_theme(page, theme):
    drawn = page.locator("#fig-l04-gains svg.drawing")
    found = drawn.evaluate(
        """svg => [...svg.querySelectorAll("*")].flatMap(part => {
          const { fill, stroke } = getComputedStyle(part);
          return [part.style.fill && fill, part.style.stroke && stroke];
        })"""
    )
    colours = {hexadecimal(colour) for colour in found if colour and colour != "none"}
    marks = [MARKS[CASES[name]] for name in ("G1", "G2", "G3")] + [MARKS["limit"]]
    assert {getattr(mark, theme) for mark in (*marks, *PARTS.values())} <= colours
    other = "dark" if theme == "light" else "light"
    assert not {getattr(mark, other) for mark in (*marks, PARTS["text"])} & colours


ALONE = "article => article.replaceChildren(...article.querySelectorAll('div.math'))"


def is_cut(page: Page, spoil: str = "") -> bool:
    """Whether formulas have more ink where their boxes cut nothing above or below."""
    page.evaluate("document.fonts.ready")
    article = page.locator("article")
    article.evaluate(ALONE)
    page.add_style_tag(content=f"x {{}} {spoil}")
    shown = article.screenshot()
    page.add_style_tag(content="div.math { overflow: clip visible !important; }")
    return article.screenshot() != shown


@pytest.mark.parametrize("width", [1280, 390])
def test_no_formula_is_cut_off(browser, address, parsed_pages, width):
    page = browser.new_page(viewport={"width": width, "height": 800})
    cut = []
    for name, parsed in parsed_pages.items():
        if parsed.select("div.math"):
            page.goto(f"{address}/{name}.html")
            cut += [name] * is_cut(page)
    assert cut == []
    page.reload()
    assert is_cut(page, "div.math { height: 1rem; }")
    page.close()


def test_on_a_phone_no_figure_is_cut_off_and_its_letters_can_be_read(browser, address):
    page = browser.new_page(viewport={"width": 390, "height": 800})
    page.goto(f"{address}/{LECTURE}")
    sizes = page.eval_on_selector_all(
        "article svg.drawing",
        """drawings => drawings.filter(one => one.checkVisibility()).map(one => {
          const { left, right, width } = one.getBoundingClientRect();
          const texts = [...one.querySelectorAll("text")];
          const letters = texts.map(text => parseFloat(getComputedStyle(text).fontSize));
          return [left, right, width / one.getAttribute("width"), letters];
        })""",
    )
    assert len(sizes) >= 3
    with plotting.course_style():  # it draws letters as paths
        drawn = mpl.rcParams["font.size"] * 96 / 72
    for left, right, scale, letters in sizes:
        assert left >= 0
        assert right <= 390
        assert scale * min(letters or [drawn]) >= 11
    page.close()
