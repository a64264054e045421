"""The printed course: tags and bookmarks, opened folds, provenance, nothing cut."""

import os
import re
import subprocess
import sys
from collections.abc import Iterator

import pytest
from bs4 import BeautifulSoup
from pypdf import PdfReader
from pypdf.generic import Destination

from robo_genesis.pages import docnames
from robo_genesis.pdf import ADDRESS, COURSE, documents, open_document
from robo_genesis.project import BOOK, ROOT

pytestmark = [pytest.mark.engine, pytest.mark.browser]

PRINTED = documents(docnames(BOOK / "_toc.yml"))
PAPER = 210 - 2 * 16
"""Width of the text on A4 inside the margins of print.css [mm]."""

PIXEL = 25.4 / 96
POINT = 25.4 / 72


@pytest.fixture(scope="module")
def pdfs(site) -> dict[str, PdfReader]:
    command = [sys.executable, str(ROOT / "build_scripts" / "pdf.py")]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    print(done.stdout)
    return {path.stem: PdfReader(path) for path in (site.parent / "pdf").iterdir()}


def bookmarks(outline) -> Iterator[Destination]:
    for entry in outline:
        yield from bookmarks(entry) if isinstance(entry, list) else [entry]


def words(text: str) -> str:
    """Return a text without blanks, which a PDF sets by place."""
    return re.sub(r"\s+", "", text)


def article(site, name: str) -> BeautifulSoup:
    page = BeautifulSoup((site / f"{name}.html").read_text(), "html.parser")
    for link in page.select(".headerlink"):
        link.decompose()
    return page.select_one("article")


@pytest.fixture(scope="module")
def texts(pdfs) -> dict[str, str]:
    return {
        name: words("".join(page.extract_text() for page in pdf.pages))
        for name, pdf in pdfs.items()
    }


def test_there_is_one_for_each_lesson_and_one_of_the_course(pdfs):
    assert set(pdfs) == set(PRINTED)
    assert len(pdfs) > 1


@pytest.mark.parametrize("name", PRINTED)
def test_it_is_tagged_and_says_language_and_title(pdfs, name):
    root = pdfs[name].trailer["/Root"]
    assert root["/MarkInfo"]["/Marked"]
    assert len(root["/StructTreeRoot"]["/K"]) > 0
    assert len(root["/StructTreeRoot"]["/ParentTree"]) > 0
    assert root["/Lang"] == "en"
    assert pdfs[name].metadata.title


@pytest.mark.parametrize("name", PRINTED)
def test_its_bookmarks_are_the_headings_of_its_pages_and_lead_to_them(pdfs, site, name):
    headings = [
        " ".join(heading.get_text().split())
        for page in PRINTED[name]
        for heading in article(site, page).find_all(re.compile(r"^h\d$"))
    ]
    found = list(bookmarks(pdfs[name].outline))
    assert [entry.title for entry in found] == headings
    places = [pdfs[name].get_destination_page_number(entry) for entry in found]
    assert places == sorted(places)
    assert places[0] == 0


@pytest.mark.parametrize("name", PRINTED)
def test_folded_answers_and_lines_of_provenance_are_printed(texts, site, name):
    for page in PRINTED[name]:
        folds = article(site, page).select("details p:not(.replay-block details p)")
        lines = article(site, page).select("p.provenance, figcaption .provenance")
        shown = [tag for tag in (*folds, *lines) if not (tag.math or tag.find_parent("summary"))]
        wanted = [words(tag.get_text()) for tag in shown]
        assert [text for text in wanted if text not in texts[name]] == []
    lecture = article(site, "lessons/l04-joint-control/lecture")
    assert len(lecture.select("details p")) > 20
    assert len(lecture.select(".provenance")) > 20


@pytest.mark.parametrize("name", PRINTED)
def test_a_sentence_stands_for_the_table_of_a_replay(texts, site, name):
    tables = [
        table
        for page in PRINTED[name]
        for table in article(site, page).select(".replay-block details table")
    ]
    assert texts[name].count(words("see this page of the site")) == len(tables) > 0
    for table in tables:
        rows = [words(row.get_text()) for row in table.select("tbody tr")]
        assert len(rows) > 20
        assert rows[-1] not in texts[name]


@pytest.mark.parametrize("name", PRINTED)
def test_links_lead_inside_or_to_the_web_but_never_to_a_file_of_the_site(pdfs, name):
    found = [note.get_object() for page in pdfs[name].pages for note in page.get("/Annots", [])]
    addresses = [str(note["/A"]["/URI"]) for note in found if "/URI" in note.get("/A", {})]
    assert addresses
    assert [url for url in addresses if not url.startswith("https://")] == []
    assert [url for url in addresses if url.startswith(ADDRESS)] == []
    inside = {str(note["/Dest"]) for note in found if "/Dest" in note}
    assert inside
    assert inside - set(pdfs[name].named_destinations) == set()


CUT = """limit => [...document.querySelectorAll("article *")].filter(one => {
  const box = one.getBoundingClientRect(), scrolls = getComputedStyle(one).overflowX !== "visible";
  const hides = scrolls && one.clientWidth && one.scrollWidth > one.clientWidth + 1;
  return box.width && (box.right > limit + 0.5 || box.left < -0.5 || hides);
}).map(one => `${one.tagName} ${one.className}: ${one.textContent.slice(0, 60)}`)"""

SPLIT = """height => [...document.images].filter(one => one.getBoundingClientRect().height > height)
  .map(one => one.src)"""


@pytest.mark.parametrize("name", PRINTED)
def test_nothing_is_wider_than_the_paper_and_no_picture_higher(browser, site, name):
    width = int(PAPER / PIXEL)
    page = browser.new_page(viewport={"width": width, "height": 1000})
    page.emulate_media(media="print")
    open_document(page, site, PRINTED[name])
    assert page.evaluate(CUT, width) == []
    assert page.evaluate(SPLIT, (297 - 18 - 20) / PIXEL) == []
    assert page.evaluate("document.images.length") > 5
    closed = "[...document.querySelectorAll('details')].filter(one => !one.open).length"
    assert page.evaluate(closed) == 0
    page.close()


@pytest.mark.parametrize("name", PRINTED)
def test_every_sheet_is_a4_and_has_text_within_its_margins(pdfs, name):
    for number, sheet in enumerate(pdfs[name].pages, 1):
        assert [round(float(v) * POINT) for v in sheet.mediabox[2:]] == [210, 297]
        placed: list[tuple[float, str]] = []

        def place(text, matrix, text_matrix, font, size, placed=placed) -> None:
            if text.strip():
                x = text_matrix[4] * matrix[0] + text_matrix[5] * matrix[2] + matrix[4]
                placed.append((x * POINT, text))

        sheet.extract_text(visitor_text=place)
        assert placed, f"sheet {number} is empty"
        assert [one for one in placed if not 15.5 <= one[0] <= 210 - 16] == [], f"sheet {number}"


@pytest.mark.parametrize("name", PRINTED)
def test_no_text_is_printed_while_it_fades_in(pdfs, name):
    for number, sheet in enumerate(pdfs[name].pages, 1):
        drawn = sheet["/Resources"].get("/ExtGState", {}).values()
        faint = [state for state in (one.get_object() for one in drawn) if state.get("/ca", 1) < 1]
        groups = [
            one.get_object()
            for one in sheet["/Resources"].get("/XObject", {}).values()
            if "/Group" in one.get_object()
        ]
        assert not (faint and groups), f"sheet {number}: {faint}"


def test_the_course_holds_every_page_in_order(pdfs, site):
    found = [entry.title for entry in bookmarks(pdfs[COURSE].outline)]
    first = [" ".join(article(site, page).h1.get_text().split()) for page in PRINTED[COURSE]]
    assert [title for title in found if title in first] == first
