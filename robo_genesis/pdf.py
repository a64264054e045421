"""Print the built site with Chromium: one tagged, bookmarked PDF a lesson, and one of all pages."""

import os
import shutil
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

from playwright.sync_api import Error, Page, sync_playwright
from pypdf import PdfWriter
from pypdf.errors import PyPdfError
from pypdf.generic import NameObject, TextStringObject

from robo_genesis.pages import docnames
from robo_genesis.print_pages import ForeignPageError, document
from robo_genesis.publish import NEXT, PUBLISHED, beside, settle, swap

COURSE = "robo-genesis"
LESSONS = "lessons"
HEADINGS = "h1, h2, h3, h4, h5, h6"
ADDRESS = "http://site.invalid/"
"""No server stands there: each request is answered from the site's folder, or refused."""


class PdfError(Exception):
    """Nothing was printed; the message says why and what to do. Earlier PDFs still stand."""


def print_site(book: Path, say: Callable[[str], None] = print) -> list[Path]:
    """Print each lesson and the whole course of a published site.

    Args:
        book: the folder with `_toc.yml` and the published site.
        say: prints a line for each document.

    Returns:
        The PDFs, all in one folder beside the site. They take the place of earlier ones together.

    Raises:
        PdfError: there is no site or no Chromium, or a page could not be printed.
    """
    html = book / PUBLISHED / "html"
    if not (html / "index.html").is_file():
        raise PdfError(f"No site in {html}. `make book` builds it.")
    planned = documents(docnames(book / "_toc.yml"))
    folder = book / PUBLISHED / "pdf"
    settle(folder)
    following = beside(folder, NEXT)
    following.mkdir()
    try:
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=chromium(), args=_arguments())
            for name, pages in planned.items():
                title = "RoboGenesis" if name == COURSE else ""
                print_document(browser.new_page(), html, pages, following / f"{name}.pdf", title)
                say(f"{name}.pdf  {len(pages)} pages of the site")
            browser.close()
        swap(folder)
    except Error as error:
        raise PdfError(f"Chromium failed: {error}") from error
    except PyPdfError as error:
        raise PdfError(f"What Chromium printed is no PDF that can be read: {error}") from error
    except ForeignPageError as error:
        raise PdfError(str(error)) from error
    finally:
        settle(folder)
    return sorted(folder.iterdir())


def documents(names: Iterable[str]) -> dict[str, list[str]]:
    """Return the documents to print: name of the PDF to its pages.

    Args:
        names: all pages in the order of the table of contents. A lesson's stand in one folder,
            `lessons/l04-joint-control/`, which gives its PDF the name.
    """
    found: dict[str, list[str]] = {}
    every = [name.removesuffix(".md") for name in names]
    for name in every:
        parts = name.split("/")
        if parts[0] == LESSONS and len(parts) > 2:
            found.setdefault(parts[1], []).append(name)
    return found | {COURSE: every}


def chromium() -> str:
    """Return the path of Chromium.

    Raises:
        PdfError: it is not installed.
    """
    path = shutil.which("chromium")
    if path is None:
        raise PdfError(
            "Chromium is missing, which prints the PDFs. On Debian: apt install chromium"
        )
    return path


def _arguments() -> list[str]:
    """Chromium refuses its sandbox to the superuser; it sees nothing here but our own pages."""
    return ["--no-sandbox"] if os.geteuid() == 0 else []


def open_document(page: Page, html: Path, names: Sequence[str], title: str = "") -> None:
    """Open some pages of the site as one document in a browser that sees this site alone.

    Raises:
        PdfError: the document asks for something that the site does not have.
        ForeignPageError: one of the pages has no article.
    """
    text = document(html, names, title)  # not in `answer`: the browser would wait for its error
    lacking: list[str] = []

    def answer(route: Any) -> None:
        path = unquote(urlsplit(route.request.url).path).lstrip("/")
        if not route.request.url.startswith(ADDRESS):
            lacking.append(route.request.url)
            route.abort()
        elif not path:
            route.fulfill(body=text, content_type="text/html")
        elif (html / path).is_file():
            route.fulfill(path=html / path)
        else:
            lacking.append(path)
            route.fulfill(status=404)

    page.route("**/*", answer)
    page.goto(ADDRESS, wait_until="networkidle")
    if lacking:
        raise PdfError(f"{', '.join(names)}: the site has no {', '.join(lacking)}.")


def print_document(
    page: Page, html: Path, names: Sequence[str], file: Path, title: str = ""
) -> None:
    """Print some pages of the site as one PDF with tags for readers and an outline of headings.

    Args:
        page: an empty page of a browser; it is closed.
        html: the folder of the site.
        names: the pages in their order.
        file: to write.
        title: of the PDF; by default the first page's heading.
    """
    open_document(page, html, names, title)
    headings = page.eval_on_selector_all(HEADINGS, "all => all.map(one => one.textContent)")
    page.pdf(path=file, tagged=True, outline=True, prefer_css_page_size=True, print_background=True)
    page.close()
    name_bookmarks(file, [" ".join(text.split()) for text in headings])


def name_bookmarks(file: Path, headings: Sequence[str]) -> None:
    """Write the headings' own words into a PDF's outline; all else stays as it is.

    Chromium collects them from what it drew: it loses the space where a heading is wrapped, and
    has a heading twice that it moved to the next sheet.

    Args:
        file: the PDF, which is written anew.
        headings: in the order of the document.

    Raises:
        PdfError: the outline has another number of entries.
    """
    pdf = PdfWriter(clone_from=file)
    entries = list(bookmarks(pdf.root_object.get("/Outlines", {})))
    if len(entries) != len(headings):
        raise PdfError(
            f"{file.name} has {len(entries)} bookmarks for {len(headings)} headings. "
            "A heading that is hidden on paper has none: hide none in print.css."
        )
    for entry, heading in zip(entries, headings, strict=True):
        entry[NameObject("/Title")] = TextStringObject(heading)
    pdf.write(file)


def bookmarks(parent: Any) -> Iterator[Any]:
    """Yield the entries of a PDF's outline below one, in the order of the document."""
    entry = parent.get("/First")
    while entry is not None:
        entry = entry.get_object()
        yield entry
        yield from bookmarks(entry)
        entry = entry.get("/Next")
