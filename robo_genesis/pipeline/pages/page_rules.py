"""Rules for pages: each problem is named with its line before anything is executed.

What MyST, Sphinx, YAML or nbformat report has no rule here.
"""

import re
from collections.abc import Iterator, Sequence
from difflib import get_close_matches

from docutils.parsers.rst.directives.misc import TestDirective
from markdown_it.renderer import RendererHTML
from markdown_it.token import Token
from myst_parser.config.main import MdParserConfig
from myst_parser.parsers.directives import parse_directive_text
from myst_parser.parsers.mdit import create_md_parser
from nbformat import NotebookNode

from robo_genesis.pipeline.pages.syntax import PACKAGE

# The tag of a code cell and the class of a directive that contain a solution
SOLUTION = "solution"
# What a site without solutions shows in place of a cell with one.
NO_SOLUTION = "The solution is left out on this site; the outputs are those of its run."
EXPLANATION = "explanation"  # The class of a fold that a site without solutions keeps

TAGS = (
    "after-yours",
    "alone",
    "figure",
    "hide-cell",
    "hide-input",
    "hide-output",
    "inputs",
    "own-kernels",
    "raises-exception",
    "remove-cell",
    "remove-input",
    "remove-output",
    SOLUTION,
)

# The options of a cell by its type; nothing else would notice a wrong option or tag.
OPTIONS = {"code": ("tags", "mystnb", "prints", "expects"), "markdown": ("tags",)}

# Directives, and classes of others, whose content a click shows.
FOLDS = {"dropdown", "toggle"}
ADMONITIONS = (
    "note",
    "tip",
    "hint",
    "important",
    "attention",
    "caution",
    "warning",
    "danger",
)

# Directives whose content is not Markdown.
VERBATIM = {"code", "code-block", "csv-table", "literalinclude", "math", "sourcecode"}

DIRECTIVE = re.compile(r"\{([\w:-]+)\}\s*(.*)")
UNCLOSED = (
    "the block {} has no end of its own. Close it before the next one with {}. An outer block has "
    "more of these marks than an inner one; a code cell is inside no other block."
)
UNMARKED = (
    "{{{}}} “{}” does not say whether it is a solution. Add `:class-container: {}`, or `{}` if a "
    "site without solutions may show it."
)

PARSER = create_md_parser(
    MdParserConfig(enable_extensions={"amsmath", "colon_fence", "dollarmath"}),
    RendererHTML,
)

# A line, counted from 1, and what is wrong there, with its cure.
Problem = tuple[int, str]


def page_problems(text: str, notebook: NotebookNode | None) -> Iterator[Problem]:
    """Yield what a page may not contain.

    Args:
        text: the page's source.
        notebook: the page as it is executed, None if its front matter is not that of a
            notebook.
    """
    if notebook is None:
        yield from _of_text(text, 1)
        return
    given = notebook.metadata.get(PACKAGE)
    if given is not None and not declared(notebook):
        valid = f"`{PACKAGE}: {{lesson: l04, page: lab}}`, both plain words"
        yield 1, f"`{PACKAGE}: {given!r}` is not valid. Write {valid}."
    lines = text.split("\n")
    cells = zip(notebook.cells, notebook.metadata.source_map, strict=True)
    for index, (cell, begin) in enumerate(cells):
        yield from ((max(begin, 1), problem) for problem in _of_metadata(cell))
        if cell.cell_type == "code":
            mark = lines[begin - 1].split("{")[0].strip()
            if not any(_ends(line, mark) for line in lines[begin:]):
                yield begin, UNCLOSED.format(lines[begin - 1], mark)
        else:
            yield from _of_text(cell.source, first_line(lines, notebook, index))


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
            near = "".join(
                f" Is it {each}?" for each in get_close_matches(name, choices, 1, 0.7)
            )
            yield f"the {what} {name!r} is unknown.{near} Valid: {', '.join(choices)}."
    if "figure" in tags and not mystnb.get("image", {}).get("alt"):
        yield "a figure needs a text for those who do not see it: `mystnb: {image: {alt: …}}`."
    if ("raises-exception" in tags) != ("expects" in given):
        yield "the tag raises-exception needs `expects: 'ValueError: some words'`, and vice versa."


def _of_text(text: str, line: int) -> Iterator[Problem]:
    """Yield the problems of Markdown: of a cell, a page without cells, or a directive.

    Args:
        text: see above.
        line: its first line in the page.
    """
    lines = text.split("\n")
    for token in PARSER.parse(text):
        if token.type in ("fence", "colon_fence"):
            yield from _of_block(token, lines, line + (token.map or [0])[0])


def _of_block(token: Token, lines: Sequence[str], at: int) -> Iterator[Problem]:
    """Yield the problems of a fence or a directive that begins at a line of the page."""
    first, last = token.map or (0, 0)
    mark, directive = token.markup, DIRECTIVE.match(token.info.strip())
    another = re.compile(rf" *{mark}{mark[0]}* *[^\s{mark[0]}]")
    inner, end = lines[first + 1 : last - 1], lines[first + 1 : last][-1:]
    if not any(_ends(line, mark) for line in end) or any(map(another.match, inner)):
        yield at, UNCLOSED.format(mark + token.info, mark)
    elif directive and directive[1] not in VERBATIM:
        # An inner directive in the first line is not an option of the outer one.
        nested = token.type == "colon_fence" and token.content.startswith(":::")
        content = "\n" * nested + token.content
        parsed = parse_directive_text(TestDirective, directive[2], content)
        name, options = directive[1], parsed.options
        classes = f"{options.get('class', '')} {options.get('class-container', '')}"
        folds = FOLDS.intersection([name, *classes.split()])
        if folds and not {SOLUTION, EXPLANATION}.intersection(classes.split()):
            yield at, UNMARKED.format(name, directive[2], SOLUTION, EXPLANATION)
        body = "\n".join(parsed.body)
        yield from _of_text(body, at + 1 - nested + parsed.body_offset)


def _ends(line: str, mark: str) -> bool:
    """Whether a line, which may be in a list or a quote, ends a block with this mark."""
    line = line.strip(" \t>")
    return len(line) >= len(mark) and not line.strip(mark[0])
