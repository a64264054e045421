"""A made-up lab as notebooks: what travels to a student, and what never does."""

from importlib.metadata import PackageNotFoundError

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_notebook, new_output
from tiny_book import LAB_FRONT, cell, make_book, notebook, paragraphs

from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.site.takeaways import notebooks
from robo_genesis.site.takeaways.plain_markdown import Writer

FOLD = "\n:::{dropdown} Answer\n:class-container: solution\nSECRET prose\n:::\n"
PROSE = "\nIt was {measured}`l04/lab G1.rise_time`.\n" + FOLD
FIGURE = "{image: {alt: A plot}, figure: {caption: 'Drawn by {term}`plot`.'}}"
CELLS = (
    cell("x = 1"),
    PROSE,
    cell("print('SECRET code')", ":tags: [hide-cell, solution]\n"),
    cell("log()", ":tags: [hide-output]\n"),
    cell("show(text)", ":tags: [hide-cell, after-yours]\n"),
    cell("plot()", f":tags: [figure]\n:mystnb: {FIGURE}\n"),
    '\n+++ {"tags": ["site-only"]}\n\nOnly on the site.\n',
)
PINNED = {"genesis-world": "1.2.3", "robo-genesis": "0.1.0"}
CHECK = notebooks.CHECK.format(needed=PINNED, wheel="robo.whl")


def student_of(page):
    writer = Writer(page.path.parent, lambda _: "(yours)")
    return notebooks.student_notebook(page, "The origin.", CHECK, writer)


@pytest.fixture
def page(tmp_path):
    (found,) = find_pages(make_book(tmp_path, lab=notebook(*CELLS, front=LAB_FRONT)))
    return found


def test_the_student_s_notebook_is_clean(page):
    student = student_of(page)
    text = nbformat.writes(student)
    assert not [
        words for words in ("SECRET", "Only on the site", "{measured}") if words in text
    ]
    assert "It was (yours)." in text
    assert student.metadata.kernelspec.name == "python3"
    sources = [cell.source for cell in student.cells]
    assert (sources[0], sources[-1]) == ("The origin.", "*Drawn by plot.*")
    code = [c for c in student.cells if c.cell_type == "code"]
    waits = f"{notebooks.WAITS}# show(text)"
    assert [c.source for c in code] == [CHECK, "x = 1", "log()", waits, "plot()"]
    hidden = {c.source: c.metadata.jupyter for c in code if "jupyter" in c.metadata}
    assert hidden == {}  # a student sees what a cell printed
    assert all(c.outputs == [] and c.execution_count is None for c in code)


SHEET = paragraphs(
    "# Work sheet: fall",
    "## 1. Predictions, before the run\n\nEarlier or later?",
    "## 2. The scene\n\nIts mass:",
    "## 3. Results",
    "## 4. Measured\n\n```python\n## no heading\n```",
)
SECTIONS = (
    "\n## 2. The scene\n\nA box.\n",
    cell("y = 2"),
    "\n## 3. Run\n\nWrite parts 3 to\n3 of the work\nsheet now.\n",
    cell("z = 3"),
)


def sheet_of(folder, sheet, *cells):
    """The cells of a student's notebook of a lab with a work sheet."""
    (found,) = find_pages(make_book(folder, lab=notebook(*cells, front=LAB_FRONT)))
    found.path.with_name("worksheet.md").write_text(sheet)
    return [cell.source for cell in student_of(found).cells]


def test_each_part_of_a_work_sheet_follows_what_it_belongs_to(tmp_path):
    sources = sheet_of(tmp_path, SHEET, cell("x = 1"), *SECTIONS)
    heads = [source.split("\n")[0] for source in sources]
    first = heads.index("## Work sheet: fall")
    assert heads[first:] == [
        "## Work sheet: fall",
        "## Work sheet, part 1: Predictions, before the run",
        "x = 1",
        "## 2. The scene",
        "y = 2",
        "## Work sheet, part 2: The scene",
        "## 3. Run",
        "## Work sheet, part 3: Results",
        "z = 3",
        "## Work sheet, part 4: Measured",
    ]
    assert sources[first + 1].endswith("\n\nEarlier or later?")
    assert sources[-1].endswith("```python\n## no heading\n```")


@pytest.mark.parametrize(
    ("installed", "said"),
    [
        (PINNED, None),
        (
            {"genesis-world": "1.0.0", "robo-genesis": "0.1.0"},
            "genesis-world 1.2.3; it is 1.0.0",
        ),
        ({"genesis-world": "1.2.3"}, "robo-genesis 0.1.0; it is not installed here"),
    ],
)
def test_its_check_accepts_the_pinned_engine_alone(
    monkeypatch, capsys, installed, said
):
    def look_up(name: str) -> str:
        if name not in installed:
            raise PackageNotFoundError(name)
        return installed[name]

    monkeypatch.setattr("importlib.metadata.version", look_up)
    if said is None:
        left: dict[str, object] = {"check_versions": None}
        exec(CHECK, left)
        assert {*left} == {"__builtins__"}
        assert capsys.readouterr().out == "genesis-world 1.2.3\nrobo-genesis 0.1.0\n"
    else:
        with pytest.raises(
            RuntimeError, match=rf"{said}[\s\S]*-m pip install -c constr"
        ):
            exec(CHECK, {})


def executed(page, folder, *outputs):
    """The page's executed notebook, its code cells and its text, with these outputs of cells."""
    codes = [c.source for c in page.notebook.cells if c.cell_type == "code"]
    ran = [
        new_code_cell(source, execution_count=k, outputs=[output])
        for k, (source, output) in enumerate(zip(codes, outputs, strict=True), 1)
    ]
    writer = Writer(folder, lambda _: "0.12 s")
    found = notebooks.executed_notebook(
        page, new_notebook(cells=ran), "The origin.", writer
    )
    return [c for c in found.cells if c.cell_type == "code"], nbformat.writes(found)


@pytest.mark.parametrize(
    ("shown", "counts"), [("1", [1, 2, 3, 4, 5]), ("0", [1, 3, 4, 5])]
)
def test_an_executed_notebook_has_what_the_site_shows(
    page, tmp_path, monkeypatch, shown, counts
):
    monkeypatch.setenv("SOLUTIONS", shown)
    stack = ["File /home/me/secret.py", "ValueError: no"]
    error = new_output("error", ename="ValueError", evalue="no", traceback=stack)
    hello = new_output("stream", text="hello")
    cells, text = executed(page, tmp_path, *[hello] * 4, error)
    assert [c.execution_count for c in cells] == counts
    assert cells[0].outputs[0].text == "hello"
    assert cells[-1].outputs[0].traceback == ["ValueError: no"]
    assert ("SECRET code" in text) == (shown == "1")
    assert ("The solution is left out on this site" in text) == (shown == "0")
    assert next(c for c in cells if c.source == "log()").metadata.jupyter.outputs_hidden
    assert "It was 0.12 s." in text
    assert "Only on the site" not in text
