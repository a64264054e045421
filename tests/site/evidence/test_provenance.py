"""Each figure and table has its line; an invented one stops the build."""

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
CHOSEN = "Settings, not measured."


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
        folder, **pages, **{"evidence/ledger": "# Ledger\n\n```{ledger}\n```\n"}
    )
    return rendered(folder, executed(find_pages(book), folder))


def lines_of(html, name):
    """Return a page and its lines of provenance."""
    page = parsed(html, name)
    return page, [line.get_text() for line in page.select("article .provenance")]


def test_an_output_without_the_name_of_its_function_is_not_called_measured(html):
    page, lines = lines_of(html, "lab")
    assert lines == [OF_RUN, CHOSEN, *[OF_RUN] * 7]
    text = page.select_one("[id^=printed]:has(.traceback)")
    (line,) = text.select(".stream ~ .provenance")
    assert line.get_text() == OF_RUN
    assert line.a["href"].endswith("ledger.html#run-l04-lab-cpu")


def test_what_a_cell_puts_out_has_its_line_wherever_it_is_shown(html):
    page, lines = lines_of(html, "lecture")
    assert lines == [OF_RUN, CHOSEN, OF_RUN, OF_RUN]
    for kind, shown in (("printed", "div"), ("table", "table"), ("picture", "svg")):
        assert page.select_one(f"[id^={kind}]").name == shown
