"""The site is used served, and out of the archive from disk."""

import pytest
from watching import watch

pytestmark = [pytest.mark.engine, pytest.mark.browser]

LECTURE = "lessons/l04-joint-control/motion.html"
LAB = "lessons/l04-joint-control/lab.html"


@pytest.fixture(params=["served", "from disk"])
def base(request, address, unpacked) -> str:
    """What is opened from disk comes out of the archive, whose files are those of the site."""
    return address if request.param == "served" else unpacked.as_uri()


def test_search_finds_what_a_student_types_into_the_field(page, base):
    problems = watch(page)
    page.goto(f"{base}/{LAB}")
    page.wait_for_load_state(
        "networkidle"
    )  # leaving stops requests, which would be noted
    page.keyboard.press("Control+k")
    page.keyboard.type("get_dofs_control_force")
    page.keyboard.press("Enter")
    page.wait_for_url("**/search.html?q=get_dofs_control_force*")
    page.get_by_text("Search finished").first.wait_for()
    page.wait_for_load_state("networkidle")
    links = page.locator("#search-results li > a").evaluate_all(
        "all => all.map(a => a.href)"
    )
    lecture, *_ = (link for link in links if LECTURE in link)
    assert [
        name for name in (LAB, "glossary.html") if name not in " ".join(links)
    ] == []
    page.goto(lecture)
    assert page.locator("article h1").is_visible()
    assert problems == []


def test_the_theme_switches_and_stays_on_the_next_page(browser, base):
    context = browser.new_context(color_scheme="light")
    page = context.new_page()
    problems = watch(page)
    page.goto(f"{base}/index.html")
    for _ in range(3):
        if page.evaluate("document.documentElement.dataset.theme") == "dark":
            break
        page.locator("button.theme-switch-button:visible").click()
    # What a page from disk stores reaches the next page's process a little later.
    other = context.new_page()
    other.goto(f"{base}/index.html")
    other.wait_for_function("localStorage.getItem('theme') === 'dark'")
    page.goto(f"{base}/{LECTURE}")
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"
    assert problems == []
    context.close()
