"""Each figure and table has its line and its row; an invented one stops the build."""

import pytest
from built_site import parsed
from docutils import nodes
from docutils.core import publish_doctree
from myst_parser.parsers.docutils_ import Parser
from tiny_book import LAB_FRONT, WRITE_BUNDLE, cell, make_book, notebook

from robo_genesis.build.built_pages import BuiltPages
from robo_genesis.build.execute import execute_pages
from robo_genesis.build.page_store import places
from robo_genesis.build.site.render import RenderError, render
from robo_genesis.evidence.status import Status
from robo_genesis.lessons.book_pages import find_pages
from robo_genesis.site.evidence.measured import badge_node
from robo_genesis.site.evidence.refusals import problems

IMPORTS = """\
from IPython.display import HTML, SVG, Markdown
from myst_nb import glue
def drawn(name):
    size = "xmlns='http://www.w3.org/2000/svg' viewBox='0 0 3 2'"
    return SVG(f"<svg {size}><title>{name}</title></svg>")
def table(name):
    return Markdown(f"| {name} |\\n| --- |\\n| 7 |")
"""
GLUE = """\
glue("captioned", drawn("captioned"), display=False)
glue("bare", drawn("bare"), display=False)
glue("inline", drawn("inline"), display=False)
glue("any table", table("any"), display=False)
glue("md table", table("md"), display=False)"""
GLUED = """

```{glue:figure} captioned
:alt: A glued picture.

Its caption.
```

```{glue} bare
```

Here it stands in a sentence, {glue}`inline`.

```{glue} any table
```

```{glue:md} md table
:format: gfm
```

| typed |
| --- |
| 7 |
"""
PRINTED = "Printed by its cell, not compared with the bundle. ledger"
OF_RUN = "No accepted evidence: cpu-refused. ledger"
CHOSEN = "Chosen, not measured. ledger"


def book_of(folder, *cells, text="", front=LAB_FRONT, **pages):
    """Execute a book of one lab and a ledger."""
    (folder / "book" / "evidence").mkdir(parents=True)
    lab = notebook(cell(WRITE_BUNDLE), cell(IMPORTS), *cells, front=front) + text
    ledger = "# Ledger\n\n```{ledger} items\n```\n"
    book = make_book(folder, lab=lab, **pages, **{"evidence/ledger": ledger})
    pages = find_pages(book)
    results = execute_pages(pages, places(pages, folder / "store"))
    assert [result.status for result in results] == ["executed"]
    return folder, BuiltPages.of(results)


def build(executed):
    folder, built = executed
    return render(folder / "book", folder / "staging", built, folder / "render.log")


SHOW = """\
from IPython.display import display
of = {"function": "robo_genesis.lessons.l04.text.metric_table", "arguments": []}
def show(name):
    data = {"text/markdown": f"| {name} |\\n| --- |\\n| 7 |"}
    display(data, metadata={"robo_genesis": of}, raw=True)
def show_drawn(name):
    data = {"image/svg+xml": drawn(name).data}
    display(data, metadata={"robo_genesis": of}, raw=True)"""


def test_an_output_without_the_name_of_its_function_is_not_called_measured(tmp_path):
    inputs = ":tags: [inputs]\n"
    shown = (
        cell("table('chosen')", inputs), cell("show('measured')"), cell("table('printed')"),
        cell("show('one')\ntable('of both')"), cell("drawn('printed, too')"),
        cell("show_drawn('measured, too')"),
    )  # fmt: skip
    glued = cell("glue('md table', table('md'), display=False)", ":tags: [remove-cell]\n")
    text = "\n```{glue:md} md table\n:format: gfm\n```\n"
    html = build(book_of(tmp_path, cell(SHOW), glued, *shown, text=text))
    lines = [line.get_text() for line in parsed(html, "lab").select("article .provenance")]
    assert lines == [CHOSEN, OF_RUN, *[PRINTED] * 4, OF_RUN, PRINTED]
    rows = parsed(html, "evidence/ledger").select("tbody tr")
    kinds = ["settings", "table", *["printed"] * 4, "figure", "printed"]
    assert [row.select("td")[1].text for row in rows] == kinds


def test_what_a_cell_puts_out_has_its_line_wherever_it_is_shown(tmp_path):
    inputs = ":tags: [inputs]\n"
    shown = (cell("table('chosen')", inputs), cell("table('read')"), cell("drawn('alone')"))
    html = build(book_of(tmp_path, cell(GLUE, ":tags: [remove-cell]\n"), *shown, text=GLUED))
    page = parsed(html, "lab")
    lines = [line.get_text() for line in page.select("article .provenance")]
    assert lines == [CHOSEN] + [PRINTED] * 7
    assert "Its caption." in page.select_one("figcaption:has(.provenance)").get_text()

    ledger = parsed(html, "evidence/ledger")
    rows = ledger.select("#ledger tbody tr")
    kinds = ["settings", *["printed"] * 7]
    assert [row.select("td")[1].get_text() for row in rows] == kinds
    assert [row.select("td")[3].get_text() for row in rows] == ["no run"] * 8
    anchors = [row.a["href"].split("#")[1] for row in rows]
    assert [page.find(id=anchor).name for anchor in anchors] == [
        "table", "table", "img", "figure", "img", "img", "table", "table",
    ]  # fmt: skip


def test_what_has_no_line_or_follows_from_no_run_stops_the_build(tmp_path):
    html = """display(HTML("<table><tr><td>7</td></tr></table>"))"""
    wrong = (
        cell(html),
        cell("Markdown('<img src=\"x.png\">')"),
        cell("drawn('chosen')", ":tags: [inputs]\n"),
    )
    text = (
        "\n[amdgpu-verified]{.evidence-badge .state-verified}\n"
        "\n```{figure} ../book/evidence/l04/amdgpu/frames/final.svg\n:alt: x\n\nFree words.\n```\n"
        "\n```{figure} innocent.svg\n:alt: x\n\nFree words.\n```\n"
    )
    page = "# Text\n\n{glue}`lab.md::bare`\n"
    folder, built = book_of(tmp_path, *wrong, text=text, text_page=page)
    frames = folder / "book/evidence/l04/amdgpu/frames"
    frames.mkdir(parents=True)
    (frames / "final.svg").write_text("<svg xmlns='http://www.w3.org/2000/svg'/>")
    (folder / "book/innocent.svg").symlink_to(frames / "final.svg")
    with pytest.raises(RenderError) as caught:
        build((folder, built))
    said = [line for line in str(caught.value).splitlines() if "WARNING" in line]
    for part in (
        "a cell outputs <table> as raw HTML, which would have no line in the ledger. "
        "Display Markdown (robo_genesis.core.tables) or a figure.",
        "a cell outputs <img> as raw HTML",
        "a cell tagged inputs shows a picture",
        "a page may not set the class evidence-badge",
        "evidence/l04/amdgpu/frames/final.svg lies below evidence/",
        "the picture innocent.svg lies below evidence/",
        "bare is glued from the page lab, and its origin would not be shown.",
    ):
        assert [line for line in said if part in line], f"{part!r} is not in {said}"


def test_a_cell_s_table_needs_a_bundle_unless_it_was_chosen(tmp_path):
    shown = (cell("table('chosen')", ":tags: [inputs]\n"), cell("table('read')"))
    with pytest.raises(RenderError) as caught:
        build(book_of(tmp_path, *shown, front=""))
    problem = "a cell shows a table, but the page declares no bundle"
    assert str(caught.value).count(problem) == 1


def read(text):
    settings = {"myst_enable_extensions": ["attrs_inline", "attrs_block"]}
    return publish_doctree(text, parser=Parser(), settings_overrides=settings)


def found(document, book):
    return [problem for _, problem in problems(document, book)]


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ('A <span class="evidence-badge state-verified">amdgpu-verified</span>.', "evidence-badge"),
        ("<div\n  class='x evidence&#45;badge'>cpu-verified</div>", "evidence-badge"),
        ("[amdgpu-verified]{.evidence-badge}", "evidence-badge"),
        ("{.evidence-badge}\namdgpu-verified", "evidence-badge"),
        ("```{container} evidence-badge\namdgpu-verified\n```", "evidence-badge"),
        ("```{raw} html\n<b class='evidence-badge'>x</b>\n```", "evidence-badge"),
        ("[7 rad]{.measured}", "measured"),
        ("[7 rad]{.provenance}", "provenance"),
    ],
)
def test_an_imitated_class_is_recognized_however_it_is_written(text, name, tmp_path):
    (problem,) = found(read(text), tmp_path)
    assert problem.startswith(f"a page may not set the class {name}: only the build sets it.")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('<img src="a.svg">', "the page has <img> as raw HTML"),
        ("![x](lessons/../evidence/l04/cpu/a.png) ![y](b.svg)", "Use the {evidence} directive"),
    ],
)
def test_a_picture_that_avoids_the_directives_is_refused(text, message, tmp_path):
    (problem,) = found(read(text), tmp_path)
    assert message in problem


def test_the_site_s_own_badges_and_harmless_html_pass(tmp_path):
    document = read("Two<br>lines, `evidence-badge` in code, <b class='x'>bold</b>.")
    document += nodes.paragraph("", "", badge_node(Status("verified", "cpu", "", None)))
    assert found(document, tmp_path) == []
