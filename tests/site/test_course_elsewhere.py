"""The course rendered once more: with made-up runs of accelerators, for another address, and
without solutions.

The runs show what lab and lecture say of each state. The address is below a server's root: it
decides links, sitemap, cards and the page for lost readers.
"""

import re
import shutil
import zipfile
from contextlib import suppress
from functools import cache
from pathlib import Path

import nbformat
import pytest
from bs4 import BeautifulSoup
from built_site import executed_pages, parsed
from PIL import Image
from spoilers import TORCH, edit, measured_elsewhere, own_run_id, part, predicate, seal

from robo_genesis.core.project import BOOK, ROOT
from robo_genesis.evidence import bundle
from robo_genesis.pipeline.html.checks import check_site
from robo_genesis.pipeline.html.render import render
from robo_genesis.pipeline.html.sphinx_process import SphinxProcess
from robo_genesis.pipeline.pages.book import find_pages

pytestmark = pytest.mark.engine  # waits for the site

DEVICE = "Made-up GPU"
ADDRESS = "https://example.org/robot/course/"


def on(backend, folder):
    """Say in the files of a CPU's bundle that an accelerator computed it, and seal them."""
    found = bundle.read_manifest(folder).predicate.backend
    torch = {"torch_device": "cuda", **TORCH[backend]}
    part("backend", actual=backend, actual_at_end=backend, arch=backend, **torch)(folder)
    part("backend", requested="auto", driver="6.16", device_name=DEVICE)(folder)
    part("render", vendor="AMD", renderer="AMD Radeon (radeonsi)", software=False)(folder)
    log = (folder / "log.txt").read_text("utf8")
    log = log.replace(
        f"[{found.device_name}] with backend gs.cpu", f"[{DEVICE}] with backend gs.{backend}"
    )
    lines = [line for line in log.splitlines(keepends=True) if "Software rendering" not in line]
    (folder / "log.txt").write_text("".join(lines), "utf8")
    seal(folder)


def wrong_count(folder):
    """Count one entity more, in the readings and in the value that the check found."""
    edit(folder, "metrics.json", lambda m: m["model"]["entities"].update(value=3))

    def change(manifest):
        (structure,) = [c for c in manifest["predicate"]["checks"] if c["name"] == "structure"]
        structure["found"] = {
            label: 3 if label.endswith("entities") else value
            for label, value in structure["found"].items()
        }

    edit(folder, "manifest.json", change)


def damaged(folder):
    (folder / "log.txt").write_text("")


def older(folder):
    predicate(seed=7)(folder)
    log = (folder / "log.txt").read_text("utf8")
    (folder / "log.txt").write_text(log.replace("seed: 0", "seed: 7"), "utf8")


RUNS = {
    ("l04", "amdgpu"): ("verified", measured_elsewhere),
    ("l04", "cuda"): ("stale", older),
    ("l03", "amdgpu"): ("failed", wrong_count),
    ("l03", "cuda"): ("refused", damaged),
    ("l02", "amdgpu"): ("refused", own_run_id),  # a run on the CPU with another label
}
OTHERS = [run for run, (state, _) in RUNS.items() if state != "verified"]


@pytest.fixture(scope="module")
def html(site, tmp_path_factory):
    """The course for this address without solutions, with the runs of `RUNS` as its evidence."""
    folder, built = tmp_path_factory.mktemp("runs"), executed_pages()
    (folder / "robo_genesis").symlink_to(ROOT / "robo_genesis")  # pages include parts of files
    book = shutil.copytree(BOOK, folder / "book", ignore=shutil.ignore_patterns("_build*"))
    for (lesson, backend), (state, spoil) in RUNS.items():
        cpu = built.outputs[f"{lesson}/lab"] / "cpu"
        there = shutil.copytree(cpu, book / "evidence" / lesson / backend)
        if state == "refused":
            on(backend, there)
        spoil(there)
        if state != "refused" or spoil is own_run_id:
            on(backend, there)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SITE_URL", ADDRESS.rstrip("/"))
        patch.setenv("SOLUTIONS", "0")
        sphinx = SphinxProcess(book, folder / "render.log")
        draft = render(sphinx, folder / "staging", built)
    draft.pack()
    return draft.html


def test_a_render_leaves_no_process(html):
    book = f"{html.parent.parent / 'book'}\0".encode()
    commands = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        with suppress(OSError):  # it has ended
            commands.append(path.read_bytes())
    assert [command for command in commands if book in command] == []


def panels(html, lesson, page):
    """Return the panels of a page by their first sentence."""
    (path,) = (html / "lessons").glob(f"{lesson}-*/{page}.html")
    soup = parsed(html, path.relative_to(html).with_suffix("").as_posix())
    return soup.select(".evidence-panel")


def test_the_lab_shows_a_verified_run_with_its_figures_frames_metrics_and_backend(html):
    panel = panels(html, "l04", "lab")[0]
    text = panel.get_text(" ", strip=True)
    assert text.startswith("Reference run.")
    assert DEVICE in text
    assert "cpu, this build" in text
    assert "amdgpu, recorded" in text
    figures = [figure["id"] for figure in panel.select("figure")]
    pictures = [f"l04-amdgpu-{name}" for name in ("response", "initial", "final")]
    assert figures == [*pictures, "replay-l04-lab-amdgpu-recorded-model"]
    assert panel.select(".replay-block")


def test_the_lecture_shows_the_metrics_of_a_verified_run_alone(html):
    panel = panels(html, "l04", "lecture")[0]
    assert "amdgpu, recorded" in panel.get_text()
    assert DEVICE not in panel.get_text()
    assert not panel.select("figure, img, svg, .replay-block")


@pytest.mark.parametrize("page", ["lab", "lecture"])
@pytest.mark.parametrize(("lesson", "backend"), OTHERS)
def test_another_run_shows_its_state_and_nothing_else(html, lesson, backend, page):
    state, _ = RUNS[lesson, backend]
    found = [p for p in panels(html, lesson, page) if f"{backend}-{state}" in p.get_text()]
    assert len(found) == 1
    assert found[0].get_text().strip().startswith(f"No figures from {backend}")
    assert not found[0].select("figure, img, svg, table, details, .replay-block")
    (path,) = (html / "lessons").glob(f"{lesson}-*/{page}.html")
    assert (DEVICE in path.read_text("utf8")) == (lesson == "l04" and page == "lab")


def test_every_page_names_its_own_address(html):
    names = [path.relative_to(html).as_posix() for path in html.rglob("*.html")]
    found = {
        name: link["href"]
        for name in names
        for link in parsed(html, name.removesuffix(".html")).select('link[rel="canonical"]')
    }
    assert "lessons/l04-joint-control/lecture.html" in found
    assert found == {name: ADDRESS + name for name in found}


def test_the_sitemap_lists_the_pages_and_no_tool(html):
    listed = re.findall(r"<loc>(.*?)</loc>", (html / "sitemap.xml").read_text())
    names = [path.relative_to(html).as_posix() for path in html.rglob("*.html")]
    tools = {"404.html", "search.html", "genindex.html"}
    expected = {name for name in names if name not in tools and not name.startswith("_static/")}
    assert sorted(listed) == sorted(ADDRESS + name for name in expected)


def test_a_link_to_a_lesson_shows_a_card(html):
    page = parsed(html, "lessons/l04-joint-control/lecture")
    tags = {tag["property"]: tag["content"] for tag in page.select('meta[property^="og:"]')}
    assert tags["og:title"].startswith("L04: Robot models")
    assert tags["og:url"] == f"{ADDRESS}lessons/l04-joint-control/lecture.html"
    assert "joint4" in tags["og:description"]
    card = Image.open(html / tags["og:image"].removeprefix(ADDRESS))
    assert (card.format, card.size) == ("PNG", (1146, 600))


def test_the_site_passes_its_checks_there(html):
    assert [line for check in check_site(html, "/robot/course/") for line in check.problems] == []


def test_links_of_the_404_page_begin_at_the_site_s_root(html):
    page = parsed(html, "404")
    inside = [tag["href"] for tag in page.select("a[href], link[href]") if tag["href"][0] != "#"]
    assert len(inside) > 10
    assert [href for href in inside if not href.startswith(("/robot/course/", ADDRESS))] == []


def words(path):
    """Return the text of each file of the site that is one, of those in archives too."""
    if path.suffix in (".zip", ".whl"):
        with zipfile.ZipFile(path) as archive:
            for name in archive.namelist():
                yield f"{path.name}/{name}", text_of(Path(name).suffix, archive.read(name))
    else:
        yield path.name, text_of(path.suffix, path.read_bytes())


@cache  # the archives repeat the files of the site
def text_of(suffix, content):
    """Return a text without the marks of its format, so that lines of code are in it as written."""
    text = content.decode("utf8", "ignore")
    if suffix == ".html":
        return BeautifulSoup(text, "html.parser").get_text()
    if suffix == ".ipynb":
        return "\n".join(cell["source"] for cell in nbformat.reads(text, 4).cells)
    return text


def test_no_page_has_a_solution_or_an_answer(site, html):
    folds = ".solution, .tag_solution"
    for lesson in ("l02-life-cycle", "l03-rigid-bodies", "l04-joint-control"):
        for page in ("lecture", "lab"):
            name = f"lessons/{lesson}/{page}"
            assert len(parsed(site, name).select(folds)) > 3
            assert parsed(html, name).select(folds) == []


def test_no_file_has_a_line_of_a_solution(site, html):
    """Lines that pages also have outside of solutions, or that the package has, are no secret."""
    cells = [cell for page in find_pages(BOOK) for cell in page.notebook.cells]
    code, public = [], ""
    for cell in cells:
        is_solution = "solution" in cell.metadata.get("tags", [])
        if is_solution:
            code += [line.strip() for line in cell.source.splitlines()]
        else:
            public += cell.source
    public += "".join(path.read_text("utf8") for path in (ROOT / "robo_genesis").rglob("*.py"))
    secret = [line for line in code if len(line) > 30 and line not in public]
    assert len(secret) > 20

    def leaks(folder):
        files = (path for path in folder.rglob("*") if path.is_file())
        return {
            name
            for path in files
            for name, text in words(path)
            if any(line in text for line in secret)
        }

    assert leaks(html) == set()
    found = set().union(*(leaks(site / name) for name in ("lessons", "_sources", "takeaways")))
    assert found >= {"lab.html", "lab.md", "l04-lab-executed.ipynb"}
