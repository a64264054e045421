"""A lab as two notebooks: one to work in, without outputs or solutions, and one executed."""

import re
from collections.abc import Iterator, Sequence, Set
from itertools import pairwise
from textwrap import indent

import nbformat
from markdown_it import MarkdownIt
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from robo_genesis.core.project import solutions_shown
from robo_genesis.pipeline.pages.book import WORK_SHEET, Page
from robo_genesis.pipeline.pages.page_rules import NO_SOLUTION, SOLUTION
from robo_genesis.site.frame.executed import without_stack

from .plain_markdown import Writer, plain

SITE_ONLY = "site-only"  # The tag of a cell that makes sense only on the site

# The tag of a cell that students run after their own answer
AFTER_YOURS = "after-yours"
WAITS = "# Write your own text first. Then remove the # from the lines below, and run this cell.\n"

SOURCE, OUTPUTS = "source_hidden", "outputs_hidden"

# What Jupyter hides of a cell, by its tag on the site. Outputs are hidden in the
# executed notebook alone: JupyterLab shows those of a cell that it runs, and a student
# must see a failed test.
HIDDEN = {
    "hide-input": (SOURCE,),
    "hide-output": (OUTPUTS,),
    "hide-cell": (SOURCE, OUTPUTS),
}

# Words in the heading of each part of the work sheet that comes first
BEFORE = "before the run"

# The heading of a part of the work sheet.
PART = re.compile(r"## (?P<number>\d+)\. (?P<title>.+)")
# Words of a lab that name parts of its work sheet.
NAMED = re.compile(
    r"\bparts?\s+(\d+)(?:\s+(?:to|and)\s+(\d+))?\s+of\s+the\s+work\s+sheet"
)

# The index of the lab's introduction, after the origin and the check of the versions.
INTRODUCTION = 2

KERNEL = {"name": "python3", "display_name": "Python 3", "language": "python"}

# Code that requires versions by package, and otherwise says how to install the named
# wheel.
CHECK = """\
# Is this the engine that the lab was written for?
def check_versions(needed):
    import sys
    from importlib.metadata import PackageNotFoundError, version

    for package, number in needed.items():
        try:
            found = version(package)
        except PackageNotFoundError:
            found = "not installed"
        if found != number:
            raise RuntimeError(
                f"This notebook needs {{package}} {{number}}; it is {{found}} here. Install it\\n"
                "where {wheel} lies, then restart the kernel:\\n"
                f"    {{sys.executable}} -m pip install -c constraints.txt ./{wheel}\\n"
                "To try another version on purpose, change it at the end of this cell."
            )
        print(package, number)


check_versions({needed!r})
del check_versions"""


def student_notebook(
    page: Page, origin: str, check: str, writer: Writer
) -> NotebookNode:
    """Return the lab to work in: no outputs, no solutions, and a first check of the versions.

    The parts of a work sheet in the page's folder become cells to fill in; see
    `_with_work_sheet`.

    Args:
        page: the lab.
        origin: Markdown of the first cell.
        check: code of the second; see `CHECK`.
        writer: of its prose; it must not return measured values.
    """
    start = [new_markdown_cell(origin), new_code_cell(check)]
    cells = [*start, *_cells(page, writer, {SITE_ONLY, SOLUTION})]
    return _notebook(_with_work_sheet(cells, page))


def executed_notebook(
    page: Page, executed: NotebookNode, origin: str, writer: Writer
) -> NotebookNode:
    """Return the lab as it ran for the site, with its outputs; without solutions if the site is.

    Args:
        page: the lab.
        executed: the same code cells with outputs.
        origin: Markdown of the first cell.
        writer: of its prose; measured values are those of this run.
    """
    left_out = {SITE_ONLY} if solutions_shown() else {SITE_ONLY, SOLUTION}
    cells = _cells(page, writer, left_out, executed.cells)
    return _notebook([new_markdown_cell(origin), *cells])


def _cells(
    page: Page, writer: Writer, left_out: Set[str], ran: Sequence[NotebookNode] = ()
) -> Iterator[NotebookNode]:
    """Yield the cells of a page without some tags, with the outputs of its code as it ran."""
    outputs = iter(ran)
    for cell in page.notebook.cells:
        is_code = cell.cell_type == "code"
        output = next(outputs, None) if is_code else None
        tags = left_out & set(cell.metadata.get("tags", []))
        if not tags:
            if is_code:
                yield from _code(cell, writer, output)
            else:
                yield from _sections(plain(cell.source, writer))
        elif ran and SOLUTION in tags:
            yield new_markdown_cell(f"*{NO_SOLUTION}*")


def _sections(text: str) -> list[NotebookNode]:
    """Return a cell for the text before the first heading of level two, and for each section."""
    starts = [
        token.map[0]
        for token in MarkdownIt().parse(text)
        if token.type == "heading_open"
        and token.tag == "h2"
        and not token.level
        and token.map
    ]
    lines = text.splitlines()
    parts = (
        "\n".join(lines[a:b]).strip() for a, b in pairwise([0, *starts, len(lines)])
    )
    return [new_markdown_cell(part) for part in parts if part]


def _with_work_sheet(cells: list[NotebookNode], page: Page) -> list[NotebookNode]:
    """Return a student notebook with the parts of the page's work sheet among its cells.

    The sheet's beginning follows the lab's introduction. A part follows the cell that
    names it, or the section with its heading. Of the others, those before the run
    follow the introduction, and the rest is at the end.

    Raises:
        ValueError: the heading of a part has no number.
    """
    sheet = page.path.with_name(WORK_SHEET)
    if not sheet.is_file():
        return cells
    follow: dict[int, list[NotebookNode]] = {}
    for cell in _sections(sheet.read_text("utf8")):
        heading, _, rest = cell.source.partition("\n")
        place = INTRODUCTION
        if heading.startswith("# "):
            title = f"#{heading}"
        elif part := PART.fullmatch(heading):
            title = f"## Work sheet, part {part['number']}: {part['title']}"
            place = _place(cells, heading, int(part["number"]))
        else:
            raise ValueError(
                f"{sheet} has the part {heading!r}. Number it, as in `## 2. Measured`."
            )
        follow.setdefault(place, []).append(
            new_markdown_cell(f"{title}\n{rest}".rstrip())
        )
    return [part for k, cell in enumerate(cells) for part in (cell, *follow.get(k, ()))]


def _place(cells: Sequence[NotebookNode], heading: str, number: int) -> int:
    """Return the index of the cell that a part of the work sheet follows."""
    heads = {
        k: c.source.split("\n")[0]
        for k, c in enumerate(cells)
        if c.cell_type == "markdown"
    }
    for k in heads:
        for first, last in NAMED.findall(cells[k].source):
            if int(first) <= number <= int(last or first):
                return k
    starts = [k for k, head in heads.items() if head.startswith("## ")]
    for start, end in pairwise([*starts, len(cells)]):
        if heads[start] == heading:
            return end - 1
    return min(INTRODUCTION, len(cells) - 1) if BEFORE in heading else len(cells) - 1


def _code(
    cell: NotebookNode, writer: Writer, ran: NotebookNode | None
) -> Iterator[NotebookNode]:
    """Yield a code cell, and its caption below it where it draws a figure."""
    tags = list(cell.metadata.get("tags", []))
    hidden = {
        key: True for tag in tags for key in HIDDEN.get(tag, ()) if ran or key == SOURCE
    }
    code = new_code_cell(cell.source, metadata={"tags": tags} if tags else {})
    if ran is None and AFTER_YOURS in tags:
        code.source = WAITS + indent(cell.source, "# ")
    elif hidden:
        code.metadata["jupyter"] = hidden
    if ran is not None:
        code.outputs = [*map(without_stack, ran.outputs)]
        code.execution_count = ran.execution_count
    yield code
    if caption := cell.metadata.get("mystnb", {}).get("figure", {}).get("caption"):
        yield new_markdown_cell(f"*{plain(caption, writer)}*")


def _notebook(cells: list[NotebookNode]) -> NotebookNode:
    """Return a valid notebook whose bytes depend only on its content."""
    for number, cell in enumerate(cells):
        cell["id"] = f"cell-{number}"
    notebook = new_notebook(cells=cells, metadata={"kernelspec": KERNEL})
    nbformat.validate(notebook)
    return notebook
