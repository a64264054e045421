"""Each figure and table has its line and its row; an invented one stops the build."""

import pytest
from built_site import parsed
from small_book import executed, rendered
from tiny_book import (
    LAB_FRONT,
    WRITE_BUNDLE,
    cell,
    make_book,
    notebook,
    paragraphs,
    raising,
)

from robo_genesis.pipeline.pages.book import find_pages

IMPORTS = """\
from IPython.display import HTML, SVG, Markdown
def drawn(name):
    size = "xmlns='http://www.w3.org/2000/svg' width='3' height='2'"
    return SVG(f"<svg {size}><title>{name}</title></svg>")
def table(name):
    return Markdown(f"| {name} |\\n| --- |\\n| 7 |")
"""
INPUTS = ":tags: [inputs]\n"
FIGURE = ":tags: [figure]\n:mystnb: {image: {alt: A drawing}}\n"
OF_RUN = "No accepted evidence: cpu-stale. ledger"
CHOSEN = "Chosen, not measured. ledger"


SHOW = """\
from IPython.display import display
of = {"function": "robo_genesis.lessons.l04.tables.metric_table", "arguments": []}
def show(name):
    data = {"text/markdown": f"| {name} |\\n| --- |\\n| 7 |"}
    display(data, metadata={"robo_genesis": of}, raw=True)
def show_drawn(name):
    data = {"image/svg+xml": drawn(name).data}
    display(data, metadata={"robo_genesis": of}, raw=True)"""
AS_MEASURED = (
    cell(SHOW),
    cell("table('chosen')", INPUTS),
    cell("show('measured')"),
    cell("table('printed')"),
    cell("show('one')\ntable('of both')"),
    cell("drawn('printed, too')", FIGURE),
    raising("print('2.5 mm')\n1 / 0", "ZeroDivisionError: division"),
    cell("show_drawn('measured, too')", FIGURE),
)
AS_PRINTED = (
    cell("table('chosen')", INPUTS),
    cell("table('read')"),
    cell("drawn('alone')", FIGURE),
    paragraphs("| typed |\n| --- |\n| 7 |"),
)


@pytest.fixture(scope="module")
def html(tmp_path_factory):
    """A book of two executed pages and a ledger."""
    folder = tmp_path_factory.mktemp("provenance")
    (folder / "book" / "evidence").mkdir(parents=True)
    pages = {
        name: notebook(
            cell(WRITE_BUNDLE.replace("lab", name)),
            cell(IMPORTS),
            *cells,
            front=LAB_FRONT.replace("lab", name),
            title=title,
        )
        for name, title, cells in (
            ("lab", "A", AS_MEASURED),
            ("lecture", "B", AS_PRINTED),
        )
    }
    book = make_book(
        folder, **pages, **{"evidence/ledger": "# Ledger\n\n```{ledger} items\n```\n"}
    )
    return rendered(folder, executed(find_pages(book), folder))


def lines_and_rows(html, name):
    """Return a page, its lines of provenance, and the rows of the ledger that lead to it."""
    page = parsed(html, name)
    lines = [line.get_text() for line in page.select("article .provenance")]
    rows = parsed(html, "evidence/ledger").select("#ledger tbody tr")
    return page, lines, [row for row in rows if f"/{name}.html#" in row.a["href"]]


def kinds(rows):
    return [row.select("td")[1].get_text() for row in rows]


def test_an_output_without_the_name_of_its_function_is_not_called_measured(html):
    page, lines, rows = lines_and_rows(html, "lab")
    assert lines == [OF_RUN, CHOSEN, *[OF_RUN] * 7]
    assert kinds(rows) == ["printed", "settings", "table", *["printed"] * 5, "figure"]
    text = page.select_one("[id^=printed]:has(.traceback)")
    assert [line.get_text() for line in text.select(".stream ~ .provenance")] == [
        OF_RUN
    ]
    (row,) = (row for row in rows if row.a["href"].endswith(f"#{text['id']}"))
    assert "2.5 mm" in (html / "evidence" / row.select("td")[-1].a["href"]).read_text()


def test_what_a_cell_puts_out_has_its_line_wherever_it_is_shown(html):
    page, lines, rows = lines_and_rows(html, "lecture")
    assert lines == [OF_RUN, CHOSEN, OF_RUN, OF_RUN]
    assert kinds(rows) == ["printed", "settings", "printed", "printed"]
    assert [row.select("td")[3].get_text() for row in rows][:2] == ["–", "no run"]
    anchors = [row.a["href"].split("#")[1] for row in rows]
    assert [page.find(id=anchor).name for anchor in anchors] == [
        "div",
        "table",
        "table",
        "svg",
    ]
