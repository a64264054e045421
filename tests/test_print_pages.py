import os
import subprocess
import sys

import pytest
from bs4 import BeautifulSoup

from robo_genesis import pdf
from robo_genesis.pdf import COURSE, PdfError, documents, name_bookmarks, print_site
from robo_genesis.print_pages import document
from robo_genesis.project import ROOT

HEAD = '<link rel="stylesheet" href="{up}_static/a.css?v=1"><script src="x.js"></script>'
FIRST = """<h1 id="top">First &amp; best</h1><p id="here">
<a class="headerlink" href="#top">#</a> <a href="#here">here</a> <a href="second.html">second</a>
<a href="second.html#end">end</a> <a href="../other.html#x">other</a> <a href="data.csv">data</a>
<a href="https://x.org/">out</a> <img src="../_images/a.svg" loading="lazy" alt="A drawing"></p>
<details><summary>Answer</summary>because</details><script>go()</script>"""
SECOND = """<h1 id="top">Second</h1><p id="end"><a href="../lessons/first.html#here">back</a></p>
<label for="choice">one</label><input type="radio" name="n" id="choice">
<noscript>shown without scripts</noscript>"""


@pytest.fixture
def printed(tmp_path):
    (tmp_path / "lessons").mkdir()
    for name, body in (("first", FIRST), ("second", SECOND)):
        text = f"<head>{HEAD.format(up='../')}</head><nav>menu</nav>"
        text += f'<article class="bd-article">{body}</article><footer>end</footer>'
        (tmp_path / "lessons" / f"{name}.html").write_text(text)
    text = document(tmp_path, ["lessons/first", "lessons/second"])
    return BeautifulSoup(text, "html.parser")


def test_pages_follow_each_other_under_the_first_one_s_title(printed):
    assert [h.get_text() for h in printed.find_all("h1")] == ["First & best", "Second"]
    assert printed.title.get_text() == "First & best"
    assert not printed.select("nav, footer, script, .headerlink")


def test_ids_are_unlike_and_links_lead_to_them(printed):
    ids = [tag["id"] for tag in printed.find_all(id=True)]
    assert len(ids) == len(set(ids))
    links = {a.get_text(): a.get("href") for a in printed.find_all("a")}
    assert {href[1:] for href in links.values() if href and href[0] == "#"} <= set(ids)
    assert links == {
        "here": "#lessons-first--here",
        "second": "#lessons-second",
        "end": "#lessons-second--end",
        "back": "#lessons-first--here",
        "out": "https://x.org/",
        "other": None,
        "data": None,
    }
    assert printed.label["for"] == printed.input["id"]


def test_files_are_found_from_the_root_and_loaded_at_once(printed):
    assert printed.link["href"] == "_static/a.css?v=1"
    assert printed.img["src"] == "_images/a.svg"
    assert not printed.find_all(loading=True)


def test_folds_are_open_and_words_for_readers_without_scripts_stand(printed):
    assert printed.details.has_attr("open")
    assert not printed.find_all("noscript")
    assert "shown without scripts" in printed.get_text()


def test_a_lesson_s_pages_are_one_document_and_the_course_is_all():
    names = ["index", "lessons/l04-x/lecture", "lessons/l04-x/lab", "lessons/l05-y/lecture.md"]
    assert documents(names) == {
        "l04-x": ["lessons/l04-x/lecture", "lessons/l04-x/lab"],
        "l05-y": ["lessons/l05-y/lecture"],
        COURSE: [*names[:3], "lessons/l05-y/lecture"],
    }


@pytest.fixture
def book(tmp_path):
    (tmp_path / "_toc.yml").write_text("format: jb-book\nroot: index\n")
    html = tmp_path / "_build" / "html"
    html.mkdir(parents=True)
    (html / "index.html").write_text('<article class="bd-article"><h1>Home</h1></article>')
    (tmp_path / "_build" / "pdf").mkdir()
    (tmp_path / "_build" / "pdf" / "old.pdf").write_text("earlier")
    return tmp_path


def left(book):
    return sorted(p.relative_to(book / "_build").as_posix() for p in book.rglob("*.pdf"))


def test_without_a_site_the_message_says_how_to_build_one(book):
    (book / "_build" / "html" / "index.html").unlink()
    with pytest.raises(PdfError, match="`make book` builds it"):
        print_site(book)


def test_the_check_before_the_build_says_that_chromium_is_missing(tmp_path):
    command = [sys.executable, str(ROOT / "build_scripts" / "pdf.py"), "--check"]
    environment = os.environ | {"PATH": str(tmp_path), "PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (1, "")
    assert "apt install chromium" in done.stderr


def test_without_chromium_the_message_names_the_package_and_earlier_pdfs_stay(book, monkeypatch):
    monkeypatch.setenv("PATH", str(book))
    with pytest.raises(PdfError, match="apt install chromium"):
        print_site(book)
    assert left(book) == ["pdf/old.pdf"]


@pytest.mark.browser
def test_what_the_site_lacks_stops_the_printing_and_earlier_pdfs_stay(book):
    (book / "_build" / "html" / "index.html").write_text(
        '<article class="bd-article"><h1>Home</h1><img src="gone.svg" alt="x"></article>'
    )
    with pytest.raises(PdfError, match=r"the site has no gone\.svg"):
        print_site(book)
    assert left(book) == ["pdf/old.pdf"]


@pytest.mark.browser
def test_a_page_of_another_theme_is_named_and_earlier_pdfs_stay(book):
    (book / "_build" / "html" / "index.html").write_text("<p>no article</p>")
    with pytest.raises(PdfError, match=r"index\.html has no article"):
        print_site(book)
    assert left(book) == ["pdf/old.pdf"]


@pytest.mark.browser
def test_what_is_no_pdf_is_reported_and_earlier_pdfs_stay(book, monkeypatch):
    def prints_nonsense(page, html, names, file, title=""):
        file.write_text("no PDF")
        name_bookmarks(file, ["Home"])

    monkeypatch.setattr(pdf, "print_document", prints_nonsense)
    with pytest.raises(PdfError, match="no PDF that can be read"):
        print_site(book)
    assert left(book) == ["pdf/old.pdf"]


@pytest.mark.browser
def test_killed_between_the_renames_the_earlier_pdfs_come_back(book, monkeypatch):
    (book / "_build" / "pdf").rename(book / "_build" / "pdf.old")
    (book / "_build" / "pdf.next").mkdir()

    def stops(*args):
        raise KeyboardInterrupt

    monkeypatch.setattr(pdf, "print_document", stops)
    with pytest.raises(KeyboardInterrupt):
        print_site(book)
    assert left(book) == ["pdf/old.pdf"]


@pytest.mark.browser
def test_new_pdfs_take_the_place_of_earlier_ones(book):
    said: list[str] = []
    (path,) = print_site(book, said.append)
    assert left(book) == [f"pdf/{COURSE}.pdf"]
    assert said == [f"{COURSE}.pdf  1 pages of the site"]
    with pytest.raises(PdfError, match="1 bookmarks for 2 headings"):
        name_bookmarks(path, ["Home", "More"])
