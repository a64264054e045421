"""What a first visit costs, as the browser measured it over a compressing server."""

import gzip
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

import pytest
from built_site import QuietHandler, served
from playwright.sync_api import Page, expect
from watching import page_names

pytestmark = [pytest.mark.engine, pytest.mark.browser]

LECTURE = "lessons/l04-joint-control/lecture.html"
BUDGET = 450_000  # bytes, compressed, before the reader asks for the viewer
STILL = 0.001  # cumulative layout shift: a hundredth of the 0.1 that browsers call good
TEXT = {".html", ".css", ".js", ".json", ".svg", ".txt"}

WATCH_SHIFTS = """
window.shifts = [];
const note = entries => {
  for (const entry of entries) shifts.push({
    value: entry.value,
    moved: entry.sources.map(source => source.node?.outerHTML?.slice(0, 80)),
  });
};
const observer = new PerformanceObserver(list => note(list.getEntries()));
observer.observe({ type: "layout-shift", buffered: true });
window.allShifts = () => {
  note(observer.takeRecords()); // those of which it has not been told yet
  return shifts;
};
"""
SEEN = """() => [...document.images].every(image => {
  const { top, bottom } = image.getBoundingClientRect();
  return image.complete || !image.checkVisibility() || bottom < 0 || top > innerHeight;
})"""
"""The images in sight have come."""
DRAWN = "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
"""Waits for the second frame from now, by which the first is drawn and its shifts are known."""
LOADED = """() => [
  ...performance.getEntriesByType("navigation"), ...performance.getEntriesByType("resource"),
].map(entry => ({
  name: new URL(entry.name).pathname,
  bytes: entry.encodedBodySize,
  blocking: entry.renderBlockingStatus === "blocking",
}))"""


class CompressingHandler(QuietHandler):
    """Serves files as a web server does: text compressed."""

    def do_GET(self) -> None:  # noqa: N802 - the name in http.server
        path = Path(self.translate_path(self.path))
        if not path.is_file() or path.suffix not in TEXT:
            return super().do_GET()
        data = gzip.compress(path.read_bytes(), compresslevel=6)
        self.send_response(200)
        self.send_header("Content-Type", self.guess_type(path))
        self.send_header("Content-Encoding", "gzip")
        self.send_header("Content-Length", str(len(data)))
        self.end_headers()
        self.wfile.write(data)


@pytest.fixture(scope="module")
def compressed(site) -> Iterator[str]:
    with served(site, CompressingHandler) as address:
        yield address


@pytest.fixture(scope="module", params=[(1280, 900), (320, 640)], ids=["desktop", "phone"])
def first_visit(request, browser, compressed) -> Callable[[str], AbstractContextManager[Page]]:
    """Open a page of the site for the first time."""

    @contextmanager
    def opened(name: str) -> Iterator[Page]:
        width, height = request.param
        page = browser.new_page(viewport={"width": width, "height": height})
        page.add_init_script(WATCH_SHIFTS)
        page.goto(f"{compressed}/{name}", wait_until="networkidle")
        yield page
        page.close()

    return opened


@pytest.fixture(scope="module")
def visited(first_visit) -> Iterator[Page]:
    with first_visit(LECTURE) as page:
        yield page


def test_a_first_visit_is_light(visited):
    weights = {entry["name"]: entry["bytes"] for entry in visited.evaluate(LOADED)}
    assert len([weight for weight in weights.values() if weight > 0]) > 6
    assert sum(weights.values()) <= BUDGET, weights


@pytest.fixture(scope="module")
def read(first_visit, site) -> dict[str, tuple[list[dict], list[dict]]]:
    """Each page, visited for the first time and read to its end: what it loaded, what moved."""
    found = {}
    for name in page_names(site):
        with first_visit(name) as page:
            half = page.viewport_size["height"] // 2
            for top in range(0, page.evaluate("document.body.scrollHeight"), half):
                page.evaluate(f"scrollTo({{ top: {top}, behavior: 'instant' }})")
                page.wait_for_function(SEEN)
                page.evaluate(DRAWN)
            page.wait_for_load_state("networkidle")
            page.evaluate(DRAWN)
            found[name] = (page.evaluate(LOADED), page.evaluate("allShifts()"))
    return found


def test_no_script_blocks_a_page(read):
    for name, (loaded, _) in read.items():
        blocking = [entry["name"] for entry in loaded if entry["blocking"]]
        assert [file for file in blocking if not file.endswith(".css")] == [], name
        assert blocking, name  # the style sheets: the browser does tell


def test_nothing_moves_while_a_page_comes_and_is_read(read):
    moved = {name: shifts for name, (_, shifts) in read.items() if sum_of(shifts) > STILL}
    assert moved == {}
    assert LECTURE in read


def sum_of(shifts) -> float:
    return sum(shift["value"] for shift in shifts)


def test_a_shift_would_be_noticed(visited):
    visited.evaluate("scrollTo({ top: 0, behavior: 'instant' })")
    visited.evaluate("shifts.length = 0")
    visited.evaluate("document.querySelector('article').style.marginTop = '300px'")
    visited.wait_for_function("shifts.length > 0")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_light_or_dark_waits_for_no_script_file(browser, address, scheme):
    page = browser.new_page(color_scheme=scheme)
    page.route("**/*.js*", lambda route: route.abort())
    page.goto(f"{address}/{LECTURE}")
    assert page.evaluate("document.documentElement.dataset.theme") == scheme
    page.close()


def test_without_scripts_a_page_has_its_colours(browser, address):
    page = browser.new_page(java_script_enabled=False)
    page.goto(f"{address}/{LECTURE}")
    expect(page.locator("article h2").first).to_have_css("border-top-width", "1px")
    page.close()


def test_images_keep_their_shape(visited):
    visited.evaluate("for (const image of document.images) image.loading = 'eager'")
    visited.wait_for_function("[...document.images].every(image => image.complete)")
    changed = visited.evaluate("""() => [...document.images].filter(image => {
      const { width, height } = image.getBoundingClientRect();
      const said = image.getAttribute("width") / image.getAttribute("height");
      const is = image.naturalWidth / image.naturalHeight;
      return Math.abs(width / height / is - 1) > 0.02 || Math.abs(said / is - 1) > 0.02;
    }).map(image => image.src)""")
    assert changed == []
