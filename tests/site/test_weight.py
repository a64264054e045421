"""What a first visit costs, as the browser measured it over a compressing server."""

import gzip
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread

import pytest
from bs4 import BeautifulSoup
from playwright.sync_api import Page, expect
from watching import page_names

pytestmark = [pytest.mark.engine, pytest.mark.browser]

LECTURE = "lessons/l04-joint-control/lecture.html"
BUDGET = 450_000  # bytes, compressed, before the reader asks for the viewer
STILL = 0.001  # cumulative layout shift: a hundredth of the 0.1 that browsers call good
TEXT = {".html", ".css", ".js", ".json", ".svg", ".txt"}
VIEWS = {"desktop": (1280, 900), "phone": (320, 640)}

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


class CompressingHandler(SimpleHTTPRequestHandler):
    """Serves files as a web server does: text compressed."""

    def log_message(self, *args) -> None:
        pass

    def do_GET(self) -> None:
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
    handler = partial(CompressingHandler, directory=str(site))
    server = ThreadingHTTPServer(("127.0.0.1", 0), handler)
    Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()


@pytest.fixture(scope="module", params=VIEWS)
def view(request) -> tuple[str, dict[str, int]]:
    width, height = VIEWS[request.param]
    return request.param, {"width": width, "height": height}


@pytest.fixture(scope="module")
def visited(browser, compressed, view) -> Iterator[Page]:
    context = browser.new_context(viewport=view[1])
    page = context.new_page()
    page.add_init_script(WATCH_SHIFTS)
    page.goto(f"{compressed}/{LECTURE}", wait_until="networkidle")
    yield page
    context.close()


def test_a_first_visit_is_light(visited, view, capsys):
    loaded = visited.evaluate(LOADED)
    total = sum(entry["bytes"] for entry in loaded)
    heavy = sorted(loaded, key=lambda entry: -entry["bytes"])[:6]
    with capsys.disabled():
        print(f"\nFirst load of the lecture, {view[0]}: {total / 1000:.0f} kB compressed")
        for entry in heavy:
            print(f"  {entry['bytes'] / 1000:6.1f} kB  {entry['name'].rpartition('/')[2]}")
    assert heavy[-1]["bytes"] > 0
    assert total <= BUDGET


@pytest.fixture(scope="module")
def read(browser, compressed, view, site) -> dict[str, tuple[list[dict], list[dict]]]:
    """Each page, visited for the first time and read to its end: what it loaded, what moved."""
    found = {}
    for name in page_names(site):
        context = browser.new_context(viewport=view[1])
        page = context.new_page()
        page.add_init_script(WATCH_SHIFTS)
        page.goto(f"{compressed}/{name}", wait_until="networkidle")
        for top in range(0, page.evaluate("document.body.scrollHeight"), view[1]["height"] // 2):
            page.evaluate(f"scrollTo({{ top: {top}, behavior: 'instant' }})")
            page.wait_for_function(SEEN)
            page.evaluate(DRAWN)
        page.wait_for_load_state("networkidle")
        page.evaluate(DRAWN)
        found[name] = (page.evaluate(LOADED), page.evaluate("allShifts()"))
        context.close()
    return found


def test_no_script_blocks_a_page(read):
    for name, (loaded, _) in read.items():
        blocking = [entry["name"] for entry in loaded if entry["blocking"]]
        assert [file for file in blocking if not file.endswith(".css")] == [], name
        assert blocking, name  # the style sheets: the browser does tell


def test_nothing_moves_while_a_page_comes_and_is_read(read, view, capsys):
    totals = {name: sum(s["value"] for s in shifts) for name, (_, shifts) in read.items()}
    most = max(totals, key=totals.__getitem__)
    with capsys.disabled():
        print(f"\nMost layout shift, {view[0]}: {totals[most]:.5f} ({most})")
    moved = {name: read[name][1] for name, total in totals.items() if total > STILL}
    assert moved == {}
    assert LECTURE in totals


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
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(f"{address}/{LECTURE}")
    expect(page.locator("article h2").first).to_have_css("border-top-width", "1px")
    context.close()


def test_images_keep_their_shape(visited):
    visited.evaluate("for (const image of document.images) image.loading = 'eager'")
    visited.wait_for_function("[...document.images].every(image => image.complete)")
    assert (
        visited.evaluate("""() => [...document.images].filter(image => {
      const { width, height } = image.getBoundingClientRect();
      const said = image.getAttribute("width") / image.getAttribute("height");
      const is = image.naturalWidth / image.naturalHeight;
      return Math.abs(width / height / is - 1) > 0.02 || Math.abs(said / is - 1) > 0.02;
    }).map(image => image.src)""")
        == []
    )


def test_every_image_has_its_size_and_those_below_come_late(site):
    wrong, late = [], 0
    for name in page_names(site):
        page = BeautifulSoup((site / name).read_text(), "html.parser")
        for number, image in enumerate(page.select("article img")):
            late += number > 0
            sized = str(image.get("width", "")).isdigit() and str(image.get("height", "")).isdigit()
            if not sized or (number and image.get("loading") != "lazy"):
                wrong.append(f"{name}: {image['src']}")
    assert wrong == []
    assert late
