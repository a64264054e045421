"""The built site in a real browser: light, dark and on a narrow phone."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, sync_playwright

pytestmark = [pytest.mark.engine, pytest.mark.browser]

CHROMIUM = "/usr/bin/chromium"
PAGES = (
    "index",
    "glossary",
    "evidence/recording",
    "lessons/l04-joint-control/lecture",
    "lessons/l04-joint-control/lab",
)
VIEWS = {"light": (1280, "light"), "dark": (1280, "dark"), "phone": (320, "light")}


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


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
    assert page.evaluate("document.documentElement.dataset.theme") == scheme
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    page.evaluate("window.scrollTo(0, document.body.scrollHeight)")
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
