"""From phone to 4K only boxes of their own scroll sideways, and lines stay readable."""

import pytest
from built_site import PAGES
from watching import drawn

pytestmark = [pytest.mark.engine, pytest.mark.browser]

WIDTHS = (320, 390, 768, 1280, 1920, 3840)
MEASURE = 40
"""Longest line of running text, in letter heights; one holds about two letters."""
OPEN_FOLDS = "document.querySelectorAll('details').forEach(fold => { fold.open = true; })"
LOOK = """() => {
  const width = document.documentElement.clientWidth;
  const scrolls = (node) => ["auto", "scroll"].includes(getComputedStyle(node).overflowX);
  const boxed = (node) => {
    for (let up = node.parentElement; up && up.tagName !== "MAIN"; up = up.parentElement) {
      if (scrolls(up) && up.getBoundingClientRect().right <= width + 1) return true;
    }
    return false;
  };
  const out = [...document.querySelectorAll("article *")].filter((node) => {
    const { right, width: own } = node.getBoundingClientRect();
    return own > 1 && right > width + 1 && !boxed(node);
  });
  const lines = [...document.querySelectorAll("article p:not(.admonition-title), article li")]
    .filter((node) => !node.closest("table, figure") && node.offsetParent)
    .map((node) => node.clientWidth / parseFloat(getComputedStyle(node).fontSize));
  return {
    width,
    document: document.documentElement.scrollWidth,
    out: out.map((node) => node.outerHTML.slice(0, 120)),
    longest: Math.max(0, ...lines),
  };
}"""


@pytest.mark.parametrize("name", [*PAGES, "search", "404"])
def test_no_page_scrolls_sideways_at_any_width(browser, address, name):
    page = browser.new_page()
    page.goto(f"{address}/{name}.html")
    page.evaluate(OPEN_FOLDS)
    for width in WIDTHS:
        page.set_viewport_size({"width": width, "height": 900})
        drawn(page)
        found = page.evaluate(LOOK)
        assert found["document"] <= found["width"] <= width, (width, found)
        assert found["out"] == [], width
        assert found["longest"] <= MEASURE, width
    page.close()


def test_what_sticks_out_or_runs_long_would_be_found(browser, address):
    page = browser.new_page(viewport={"width": 1920, "height": 900})
    page.goto(f"{address}/index.html")
    page.evaluate("""() => {
      const box = document.createElement("div");
      box.id = "box";
      box.innerHTML = "<p id=wide style='width: 3000px; max-width: none'>wide</p>";
      document.querySelector("article").append(box);
    }""")
    found = page.evaluate(LOOK)
    assert found["longest"] > MEASURE
    assert [text for text in found["out"] if 'id="wide"' in text]
    page.evaluate("document.querySelector('#box').style.overflowX = 'auto'")
    assert page.evaluate(LOOK)["out"] == []
    page.close()
