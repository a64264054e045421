"""Rules for pages: each problem is named with its line before anything is executed.

What MyST, Sphinx, YAML or nbformat report has no rule here.
"""

from collections.abc import Iterator, Sequence

from nbformat import NotebookNode

from .syntax import PACKAGE

# The tag of a code cell and the class of a directive that contain a solution
SOLUTION = "solution"
# What a site without solutions shows in place of a cell with one.
NO_SOLUTION = "The solution is left out on this site; the outputs are those of its run."

TAGS = (
    "after-yours",
    "alone",
    "compiles-first",
    "figure",
    "hide-cell",
    "hide-input",
    "hide-output",
    "inputs",
    "raises-exception",
    "remove-cell",
    SOLUTION,
)

# The options of a cell by its type; nothing else would notice a wrong option or tag.
OPTIONS = {"code": ("tags", "mystnb", "prints", "expects"), "markdown": ("tags",)}

DETAILS = (
    "a site without solutions would show this <details>. Use a {dropdown} with "
    f"`:class-container: {SOLUTION}` or `explanation`."
)

# A line, counted from 1, and what is wrong there, with its cure.
Problem = tuple[int, str]


def page_problems(notebook: NotebookNode) -> Iterator[Problem]:
    """Yield what a page with code cells may not contain."""
    given = notebook.metadata.get(PACKAGE)
    if given is not None and not declared(notebook):
        valid = f"`{PACKAGE}: {{lesson: l04, page: lab}}`, both plain words"
        yield 1, f"`{PACKAGE}: {given!r}` is not valid. Write {valid}."
    for cell, begin in zip(notebook.cells, notebook.metadata.source_map, strict=True):
        yield from ((max(begin, 1), problem) for problem in _of_metadata(cell))
        if cell.cell_type == "markdown" and "<details" in cell.source:
            yield begin, DETAILS


def first_line(lines: Sequence[str], notebook: NotebookNode, index: int) -> int:
    """Return the number of a cell's first line in the page's source, counted from 1.

    Args:
        lines: of the source.
        notebook: with its source map, which has the line after the fence, where options
            may be.
        index: the cell's position among all cells.
    """
    code = notebook.cells[index].source.splitlines()
    begin = notebook.metadata.source_map[index]
    places = range(begin, len(lines))
    return 1 + next((n for n in places if lines[n : n + len(code)] == code), begin)


def declared(notebook: NotebookNode) -> tuple[str, str] | None:
    """Return lesson and page from the front matter, None without a declaration that is valid."""
    match notebook.metadata.get(PACKAGE):
        case {"lesson": str(lesson), "page": str(page), **others} if not others:
            return lesson, page
    return None


def _of_metadata(cell: NotebookNode) -> Iterator[str]:
    """Yield what is wrong in the tags and options of a cell."""
    given, valid = cell.metadata, OPTIONS.get(cell.cell_type, ())
    tags, mystnb = given.get("tags", []), given.get("mystnb", {})
    known = TAGS if cell.cell_type == "code" else ("site-only",)
    for what, names, choices in (("tag", tags, known), ("option", given, valid)):
        for name in (str(name) for name in names if name not in choices):
            yield f"the {what} {name!r} is unknown. Valid: {', '.join(choices)}."
    if "figure" in tags and not mystnb.get("image", {}).get("alt"):
        yield "a figure needs a text for those who do not see it: `mystnb: {image: {alt: …}}`."
    if ("raises-exception" in tags) != ("expects" in given):
        yield "the tag raises-exception needs `expects: 'ValueError: some words'`, and vice versa."
