"""Rules for pages: each problem is named with its line before anything is executed.

What MyST, Sphinx, YAML or nbformat report has no rule here. At a picture that Sphinx
cannot read, or one above the title, it stops before it has named any other mistake.
"""

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from urllib.parse import unquote

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

MOST_IN_PICTURE = 2_000_000  # Bytes of a picture in a page

# What no text contains, and the cure. A picture may stay if the first group of its rule
# names a good file.
TEXTS = {
    r"(?im)<img|(?:!\[[^\]]*\](?:\[|\(\s*<?)|[`:]{3}\{(?:figure|image)\} +)([^)>\s]*)": (
        "a picture is a file beside the page of at most "
        f"{MOST_IN_PICTURE:,} bytes, as in `![words](picture.svg)`."
    ),
    # front matter, targets, comments and breaks between cells may precede the title
    r"\A(?!(---\n(?s:.*?)\n---\n)?(?:\s|\(.+\)=\n|%.*\n|\+\+\+.*\n)*# ).*": (
        "a page begins with its title: `# Words`."
    ),
    r"(?im)<!--|<details|^##+ +(?:\d+\. +)?(?:answers?|solutions?|worked examples?)\b|"
    r"\{tab-set-code\}|"
    r"\{tab-item\}.*\n(?!( *:.*\n)*? *:class-container:.*\b(?:solution|explanation)\b)": (
        "a site without solutions would show this. A solution belongs in a {dropdown} or "
        "{tab-item} with `:class-container: solution`, and a tab without one has the class "
        "`explanation`. A comment begins with `% `, and another section has another heading."
    ),
    r"(?m)[\u200b-\u200f\u202a-\u202e\u2060-\u2069\ufeff]|^(<{7}|>{7}) ": (
        "no reader should get this, an unseen character or a mark of a merge. Remove it."
    ),
}

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


def text_problems(path: Path) -> Iterator[Problem]:
    """Yield what the text of a page may not contain."""
    text = path.read_text("utf8")
    for rule, cure in TEXTS.items():
        for found in re.finditer(rule, text):
            file = path.parent / unquote(found[1] or "")
            if not file.is_file() or file.stat().st_size > MOST_IN_PICTURE:
                line = text.count("\n", 0, found.start()) + 1
                yield line, f"{found[0]!r}: {cure}"


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
