"""A made-up lab as notebooks: what travels to a student, and what never does."""

import contextlib
import io
from importlib.metadata import PackageNotFoundError, version

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_notebook, new_output
from tiny_book import LAB_FRONT, cell, make_book, notebook

from robo_genesis.lessons.book_pages import find_pages
from robo_genesis.site.takeaways.notebooks import Origin, executed_notebook, student_notebook
from robo_genesis.site.takeaways.plain_markdown import Writer

FOLD = "\n:::{dropdown} Answer\n:class-container: solution\nSECRET prose\n:::\n"
PROSE = "\nIt was {measured}`l04/lab G1.rise_time`.\n" + FOLD
CELLS = (
    cell("x = 1"),
    PROSE,
    cell("print('SECRET code')", ":tags: [hide-cell, solution]\n"),
    cell("plot()", ":tags: [figure]\n:mystnb: {figure: {caption: 'Drawn by {term}`plot`.'}}\n"),
    '\n+++ {"tags": ["site-only"]}\n\nOnly on the site.\n',
)
ORIGIN = Origin(
    title="A lab",
    system="Linux with Python 3",
    engine="1.2.3",
    package="0.1.0",
    wheel="robo.whl",
    commands=("python3 -m venv course", "course/bin/pip install ./robo.whl jupyterlab"),
    run="12345678",
    measured="2026-01-02",
)


@pytest.fixture
def page(tmp_path):
    (found,) = find_pages(make_book(tmp_path, lab=notebook(*CELLS, front=LAB_FRONT)))
    return found


@pytest.fixture
def student(page, tmp_path):
    return student_notebook(page, ORIGIN, Writer(tmp_path, lambda _: "(yours)"))


def test_the_student_s_notebook_is_clean_and_valid(student):
    nbformat.validate(student)
    text = nbformat.writes(student)
    assert not [words for words in ("SECRET", "Only on the site", "{measured}") if words in text]
    assert "It was (yours)." in text
    code = [c for c in student.cells if c.cell_type == "code"]
    assert [c.source for c in code[1:]] == ["x = 1", "plot()"]
    assert all(c.outputs == [] and c.execution_count is None for c in code)
    assert student.metadata.kernelspec.name == "python3"
    assert "*Drawn by plot.*" in [c.source for c in student.cells]


def test_its_first_lines_say_where_it_comes_from_and_how_to_install(student):
    first = student.cells[0].source
    for words in (
        "A lab",
        "1.2.3",
        "12345678",
        "2026-01-02",
        "CC BY 4.0",
        ORIGIN.system,
        *ORIGIN.commands,
    ):
        assert words in first


SHEET = """\
# Work sheet

## 1. Predictions, before the run

Earlier or later?

## 2. Measured

```python
## no heading
```
"""


def test_a_work_sheet_is_filled_in_before_and_after_the_run(page, tmp_path):
    page.path.with_name("worksheet.md").write_text(SHEET)
    found = student_notebook(page, ORIGIN, Writer(tmp_path, lambda _: "(yours)"))
    sources = [cell.source for cell in found.cells]
    asked = sources.index("## 1. Predictions, before the run\n\nEarlier or later?")
    assert asked < sources.index("x = 1") < sources.index("# Work sheet")
    assert sources[-1] == "## 2. Measured\n\n```python\n## no heading\n```"


def run_check(student, monkeypatch, installed: dict[str, str]) -> str:
    def look_up(name: str) -> str:
        if name not in installed:
            raise PackageNotFoundError(name)
        return installed[name]

    monkeypatch.setattr("importlib.metadata.version", look_up)
    assert version is not look_up
    code = next(c.source for c in student.cells if c.cell_type == "code")
    with contextlib.redirect_stdout(io.StringIO()) as said:
        exec(compile(code, "check", "exec"), {})
    return said.getvalue()


def test_its_first_cell_accepts_the_pinned_engine(student, monkeypatch):
    installed = {"genesis-world": "1.2.3", "robo-genesis": "0.1.0"}
    assert run_check(student, monkeypatch, installed) == "genesis-world 1.2.3\nrobo-genesis 0.1.0\n"


@pytest.mark.parametrize(
    ("installed", "said"),
    [
        (
            {"genesis-world": "1.0.0", "robo-genesis": "0.1.0"},
            "genesis-world 1.2.3; it is 1.0.0 here",
        ),
        ({"robo-genesis": "0.1.0"}, "genesis-world 1.2.3; it is not installed here"),
        ({"genesis-world": "1.2.3"}, "robo-genesis 0.1.0; it is not installed here"),
    ],
)
def test_its_first_cell_says_what_to_do_about_another(student, monkeypatch, installed, said):
    with pytest.raises(RuntimeError) as error:
        run_check(student, monkeypatch, installed)
    assert said in str(error.value)
    assert "course/bin/pip install ./robo.whl" in str(error.value)


def test_the_executed_notebook_has_outputs_and_measured_values(page, tmp_path):
    codes = [c for c in page.notebook.cells if c.cell_type == "code"]
    ran = [new_code_cell(c.source, execution_count=k) for k, c in enumerate(codes, 1)]
    ran[0].outputs = [new_output("stream", text="hello")]
    stack = ["File /home/me/secret.py", "\x1b[31mValueError\x1b[0m: no"]
    ran[1].outputs = [new_output("error", ename="ValueError", evalue="no", traceback=stack)]
    found = executed_notebook(
        page, new_notebook(cells=ran), ORIGIN, Writer(tmp_path, lambda _: "0.12 s")
    )
    nbformat.validate(found)
    code = [c for c in found.cells if c.cell_type == "code"]
    assert code[0].outputs[0].text == "hello"
    assert code[1].outputs[0].traceback == ["ValueError: no"]
    assert [c.execution_count for c in code] == [1, 2, 3]
    assert "It was 0.12 s." in nbformat.writes(found)
    assert "Only on the site" not in nbformat.writes(found)


def test_notes_of_the_compiler_on_its_process_are_dropped_and_warnings_stay(page, tmp_path):
    codes = [c for c in page.notebook.cells if c.cell_type == "code"]
    ran = [new_code_cell(c.source) for c in codes]
    note = "[I 01/02/26 11:30:00.841 25171] [shell.py:_shell_pop_print@25] a shell\n"
    warning = "[W 01/02/26 11:30:00.841 25171] [a.py:b@2] mind\n"
    ran[0].outputs = [new_output("stream", name="stderr", text=note)]
    ran[1].outputs = [new_output("stream", name="stderr", text=f"{note}UserWarning: x\n{warning}")]
    ran[2].outputs = [new_output("stream", name="stdout", text=note)]
    found = executed_notebook(page, new_notebook(cells=ran), ORIGIN, Writer(tmp_path, str))
    outputs = [c.outputs for c in found.cells if c.cell_type == "code"]
    assert outputs[0] == []
    assert outputs[1][0].text == f"UserWarning: x\n{warning}"
    assert outputs[2][0].text == note


def test_the_same_page_gives_the_same_bytes(page, tmp_path):
    writer = Writer(tmp_path, str)
    first, second = (nbformat.writes(student_notebook(page, ORIGIN, writer)) for _ in "ab")
    assert first == second
