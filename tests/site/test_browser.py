"""The built site in a real browser: light, dark and on a narrow phone."""

import pytest
from built_site import PAGES

pytestmark = [pytest.mark.engine, pytest.mark.browser]

VIEWS = {"light": (1280, "light"), "dark": (1280, "dark"), "phone": (320, "light")}


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("name", PAGES)
def test_page_is_whole_quiet_and_fits(browser, address, name, view):
    width, scheme = VIEWS[view]
    context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme)
    page = context.new_page()
    problems: list[str] = []
    page.on("console", lambda m: problems.append(m.text) if m.type == "error" else None)
    page.on("pageerror", lambda error: problems.append(str(error)))
    page.on("response", lambda r: problems.append(r.url) if r.status >= 400 else None)
    page.on(
        "request",
        lambda r: None if r.url.startswith((address, "data:")) else problems.append(r.url),
    )
    page.goto(f"{address}/{name}.html", wait_until="networkidle")
    assert problems == []
    page.wait_for_function(f"document.documentElement.dataset.theme === {scheme!r}")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    page.evaluate("for (const image of document.images) image.loading = 'eager'")
    page.wait_for_function("[...document.images].every(image => image.complete)")
    empty = "[...document.images].filter(image => !image.naturalWidth).map(image => image.src)"
    assert page.evaluate(empty) == []
    context.close()


def test_folded_log_opens_by_keyboard(browser, address):
    page = browser.new_page()
    page.goto(f"{address}/lessons/l04-joint-control/lab.html")
    summary = page.locator("details.hide > summary").first
    summary.focus()
    page.keyboard.press("Enter")
    assert page.locator("details.hide").first.evaluate("fold => fold.open")
    page.close()


STATES = ("verified", "inconclusive", "missing", "stale", "failed", "refused")
CONTRAST = """() => {
  const light = text => text.match(/[\\d.]+/g).slice(0, 3)
    .map(v => v / 255).map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
    .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
  const badge = document.querySelector(".evidence-badge");
  return STATES.map(state => {
    badge.className = `evidence-badge state-${state}`;
    const style = getComputedStyle(badge);
    const pair = [light(style.color), light(style.backgroundColor)].sort((a, b) => b - a);
    return (pair[0] + 0.05) / (pair[1] + 0.05);
  });
}"""


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_word_of_each_badge_can_be_read(browser, address, scheme):
    page = browser.new_page(color_scheme=scheme)
    page.goto(f"{address}/index.html")
    contrasts = page.evaluate(CONTRAST.replace("STATES", str(list(STATES))))
    assert len(contrasts) == len(STATES)
    assert min(contrasts) >= 4.5, dict(zip(STATES, contrasts, strict=True))
    page.close()


def test_the_ledger_scrolls_by_keyboard_on_a_phone(browser, address):
    page = browser.new_page(viewport={"width": 320, "height": 700})
    page.goto(f"{address}/evidence/ledger.html")
    box = page.locator("#figures-and-tables .scroll-box")
    assert box.evaluate("box => box.scrollWidth > box.clientWidth")
    box.focus()
    page.keyboard.press("ArrowRight")
    page.wait_for_function("document.activeElement.scrollLeft > 0")
    page.close()


SHOWN = """selectors => selectors.map(selector =>
  [...document.querySelectorAll(selector)].filter(one => one.checkVisibility()).length)"""
FOLDS = "article .sd-summary-content > p"


def test_on_paper_the_menus_are_gone_and_folds_can_be_read(browser, address):
    page = browser.new_page(viewport={"width": 1280, "height": 900}, color_scheme="dark")
    page.goto(f"{address}/lessons/l04-joint-control/lecture.html", wait_until="networkidle")
    sidebars = ["#pst-primary-sidebar", "#pst-secondary-sidebar"]
    menus = [".bd-header-article", *sidebars, ".prev-next-footer"]
    assert min(page.evaluate(SHOWN, menus)) > 0
    folded = page.locator(FOLDS).count()
    assert page.evaluate(SHOWN, [FOLDS])[0] < folded
    page.emulate_media(media="print")
    assert page.evaluate(SHOWN, menus) == [0] * len(menus)
    assert page.evaluate(SHOWN, [FOLDS]) == [folded]
    page.close()
