"""Rules for files and pages: each problem is named with its line before anything is executed."""

import ast
import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from difflib import get_close_matches
from functools import lru_cache
from pathlib import Path
from xml.etree import ElementTree

import yaml
from docutils.parsers.rst.directives.misc import TestDirective
from markdown_it.renderer import RendererHTML
from markdown_it.token import Token
from myst_parser.config.main import MdParserConfig
from myst_parser.parsers.directives import parse_directive_text
from myst_parser.parsers.mdit import create_md_parser
from nbformat import NotebookNode

from robo_genesis.core.files import derived_value
from robo_genesis.core.palette import VALID_COLOURS, outside_the_palette
from robo_genesis.pipeline.pages.syntax import PACKAGE, plain_python

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
TITLED = {
    *ADMONITIONS,
    "admonition",
    "card",
    "rubric",
    "seealso",
    "sidebar",
    "tab-item",
    "topic",
}

# Directives whose content is not Markdown.
VERBATIM = {"code", "code-block", "csv-table", "literalinclude", "math", "sourcecode"}

DIRECTIVE = re.compile(r"\{([\w:-]+)\}\s*(.*)")
ANSWER = re.compile(r"\b(?:answer|solution)s?\b", re.IGNORECASE)
INLINE_CODE = re.compile(r"`[^`]*`")
HIDDEN = re.compile(
    r"<details\b|(?:\{[^}]*\.|class=[^>]*\b)(?:solution|dropdown|toggle)\b",
    re.IGNORECASE,
)
OPENED = re.compile(r"\bopen_page\(\s*[\"'](\w+)[\"'],\s*[\"'](\w+)[\"']")

MARK = f": {SOLUTION}`, or `{EXPLANATION}` if a site without solutions may show it"
DROPDOWN = f"`:::{{{{dropdown}}}} Title` with `:class-container{MARK}"
OTHER_PAGE = (
    "the cell opens {}/{}, which the front matter does not declare. Write both alike."
)
UNCLOSED = (
    "the block {} has no end of its own. Close it before the next one with {}. An outer block has "
    "more of these marks than an inner one; a code cell is inside no other block."
)
UNREAD = ("class", "container", "div", "eval-rst", "include", "rst-class")
NOT_READ = (
    "no rule reads what {{{}}} does to a solution. Write Markdown, or a {{dropdown}}."
)
NOT_RUN = (
    "nothing runs this code cell. Move it out of other blocks; the page begins with a front matter "
    "that has `file_format: mystnb` and `kernelspec: {name: python3}`."
)
GLUE = "{glue} shows a value away from its cell. Show it below the cell, or write {measured}."
SHEET = "a work sheet is plain Markdown, and students get it as it is. Remove the directive."
HTML = f"nothing leaves out {{!r}} with solutions. Write {DROPDOWN}."
UNMARKED = (
    f"{{{{{{}}}}}} “{{}}” does not say whether it is a solution. Add `:{{}}{MARK}."
)

PARSER = create_md_parser(
    MdParserConfig(enable_extensions={"amsmath", "colon_fence", "dollarmath"}),
    RendererHTML,
)

TEXT_FILES = (
    ".css",
    ".csv",
    ".html",
    ".js",
    ".json",
    ".lock",
    ".md",
    ".py",
    ".svg",
    ".tmpl",
    ".toml",
    ".urdf",
    ".xml",
    ".yml",
)
READERS: dict[str, Callable[[str], object]] = {
    ".yml": yaml.safe_load,
    ".svg": ElementTree.fromstring,
}
CONFLICT = re.compile(
    r"^(?:<{7}|={7}|>{7}|\|{7})(?=\s|$)", re.MULTILINE
)  # as git finds them

# Characters that an editor does not show, or that end a line for some programs only.
ODD = re.compile("[\0-\x08\x0b\x0c\x0e-\x1f\x7f\x85\u2028\u2029\ufeff]|\r(?!\n)")

# A line, counted from 1, and what is wrong there, with its cure.
Problem = tuple[int, str]


def file_problems(path: Path) -> list[Problem]:
    """Return why a text file of the checkout cannot be meant as it is."""
    if path.suffix not in TEXT_FILES or not path.is_file():
        return []
    found = _of_bytes(path.read_bytes(), path.suffix)
    if path.suffix == ".svg" and path.parent.name != "_static" and not found:
        colours = ", ".join(outside_the_palette(path.read_text("utf8")))
        return [(1, f"the drawing has {colours}. {VALID_COLOURS}")] if colours else []
    return found


@lru_cache(maxsize=1024)
def _of_bytes(content: bytes, suffix: str) -> list[Problem]:
    try:
        text = content.decode()
    except UnicodeDecodeError as error:
        line, byte = content.count(b"\n", 0, error.start) + 1, content[error.start]
        return [
            (
                line,
                f"the byte 0x{byte:02x} is not UTF-8. Save the file as UTF-8, without BOM.",
            )
        ]
    found = []
    if odd := ODD.search(text):
        found = [
            (
                odd,
                f"the character U+{ord(odd[0]):04X}. Remove it; save as UTF-8 without BOM.",
            )
        ]
    if mark := CONFLICT.search(text):
        found += [
            (mark, f"the mark {mark[0]} of a merge conflict. Keep one version alone.")
        ]
    try:
        _ = found or READERS.get(suffix, str)(text)
    except (yaml.YAMLError, ElementTree.ParseError) as error:
        at, why = (
            re.findall(r"line (\d+)", str(error)) or ["1"],
            " ".join(str(error).split()),
        )
        return [(int(at[-1]), f"it cannot be read: {why}. Correct it.")]
    return [
        (text.count("\n", 0, at.start()) + 1, f"the file has {why}")
        for at, why in found
    ]


def page_problems(text: str, notebook: NotebookNode | None) -> list[Problem]:
    """Return what a page may not contain.

    Args:
        text: the page's source.
        notebook: the page as it is executed, None if its front matter is not that of a
            notebook.
    """
    return derived_value(
        "page-rules", text, lambda: sorted({*_of_page(text, notebook)})
    )


def sheet_problems(text: str) -> list[Problem]:
    """Return what a work sheet may not contain, which students get as it is."""
    begins = (
        n
        for n, line in enumerate(text.split("\n"), 1)
        if re.match("[ >]*[`:~]{3,}{", line)
    )
    return [*_of_text(text, 1), *((n, SHEET) for n in begins)]


def _of_page(text: str, notebook: NotebookNode | None) -> Iterator[Problem]:
    yield from (
        (n, GLUE) for n, line in enumerate(text.split("\n"), 1) if "{glue" in line
    )
    if notebook is None:
        yield from _of_text(text, 1)
        return
    lines = text.split("\n")
    yield from ((1, problem) for problem in _of_front_matter(notebook))
    for index, (cell, begin) in enumerate(
        zip(notebook.cells, notebook.metadata.source_map, strict=True)
    ):
        first = first_line(lines, notebook, index)
        yield from (
            (max(begin, 1), what)
            for what in _of_metadata(cell, lines[begin : first - 1])
        )
        if cell.cell_type == "code":
            code = _of_code(cell, declared(notebook))
            yield from ((first + offset, problem) for offset, problem in code)
            mark = lines[begin - 1].split("{")[0].strip()
            if not any(_ends(line, mark) for line in lines[begin:]):
                yield begin, UNCLOSED.format(lines[begin - 1], mark)
        else:
            yield from _of_text(cell.source, first)


def first_line(lines: Sequence[str], notebook: NotebookNode, index: int) -> int:
    """Return the number of a cell's first line in the page's source, counted from 1.

    Args:
        lines: of the source.
        notebook: with its source map, which has the line after the fence, where options
            may be.
        index: the cell's position among all cells.
    """
    code, begin = (
        notebook.cells[index].source.splitlines(),
        notebook.metadata.source_map[index],
    )
    places = range(begin, len(lines))
    return 1 + next((n for n in places if lines[n : n + len(code)] == code), begin)


def declared(notebook: NotebookNode) -> tuple[str, str] | None:
    """Return lesson and page from the front matter, None without a declaration that is valid."""
    given = notebook.metadata.get(PACKAGE)
    parts = given if isinstance(given, dict) else {}
    words = all(
        isinstance(part, str) and part.isidentifier() for part in parts.values()
    )
    return (
        (parts["lesson"], parts["page"])
        if words and {*parts} == {"lesson", "page"}
        else None
    )


def _of_front_matter(notebook: NotebookNode) -> Iterator[str]:
    kernel, given = notebook.metadata.get("kernelspec"), notebook.metadata.get(PACKAGE)
    name = kernel.get("name") if isinstance(kernel, dict) else kernel
    if name != "python3":
        yield f"the kernel is {name!r}. Valid is `kernelspec: {{name: python3}}`."
    if notebook.metadata.get("execution", {}).get("allow_errors"):
        yield "`allow_errors` would publish failing cells. Tag the one cell `raises-exception`."
    if given is not None and not declared(notebook):
        valid = f"`{PACKAGE}: {{lesson: l04, page: lab}}`, both plain words"
        yield f"`{PACKAGE}: {given!r}` is not valid. Write {valid}."


def _of_metadata(cell: NotebookNode, head: Sequence[str]) -> Iterator[str]:
    """Yield what is wrong in the tags and options of a cell, which its first lines give."""
    given, valid = cell.metadata, OPTIONS.get(cell.cell_type, ())
    tags, mystnb = given.get("tags", []), given.get("mystnb", {})
    if not isinstance(mystnb, dict):
        yield f"mystnb is {mystnb!r}. Valid is a mapping: `mystnb: {{image: {{alt: …}}}}`."
        return
    known = TAGS if cell.cell_type == "code" else ("site-only",)
    for what, names, choices in (("tag", tags, known), ("option", given, valid)):
        for name in (str(name) for name in names if name not in choices):
            near = "".join(
                f" Is it {each}?" for each in get_close_matches(name, choices, 1, 0.7)
            )
            yield f"the {what} {name!r} is unknown.{near} Valid: {', '.join(choices)}."
    names = Counter(re.findall(r"^:?([\w-]+):", "\n".join(head), re.MULTILINE))
    twice = ", ".join(name for name, count in names.items() if count > 1)
    if twice:
        yield f"the cell has {twice} twice, and the last one alone counts. Join them."
    prompts = " ".join(text for text in mystnb.values() if isinstance(text, str))
    if SOLUTION not in tags and ANSWER.search(prompts):
        yield f"a solution is behind {prompts!r}. Add the tag {SOLUTION}, or use other words."
    image = mystnb.get("image")
    if "figure" in tags and not (isinstance(image, dict) and image.get("alt")):
        yield "a figure needs a text for those who do not see it: `mystnb: {image: {alt: …}}`."
    if ("raises-exception" in tags) != ("expects" in given):
        yield "the tag raises-exception needs `expects: 'ValueError: some words'`, and vice versa."


def _of_code(cell: NotebookNode, page: tuple[str, str] | None) -> Iterator[Problem]:
    """Yield what the code of a cell of a declared page shows, with the offset of its line."""
    try:
        flags = ast.PyCF_ONLY_AST | ast.PyCF_ALLOW_TOP_LEVEL_AWAIT
        compile(plain_python(cell.source), "cell", "exec", flags)
    except SyntaxError as error:
        if "raises-exception" not in cell.metadata.get("tags", ()):
            yield (
                (error.lineno or 1) - 1,
                f"{type(error).__name__}: {error.msg}. Correct the code.",
            )
    for call in OPENED.finditer(cell.source):
        if call.groups() != page:
            yield (
                cell.source.count("\n", 0, call.start()),
                OTHER_PAGE.format(*call.groups()),
            )


def _of_text(text: str, line: int) -> Iterator[Problem]:
    """Yield the problems of Markdown: of a cell, a page without cells, or a directive.

    Args:
        text: see above.
        line: its first line in the page.
    """
    lines = text.split("\n")
    for token in PARSER.parse(text):
        at = line + (token.map or [0])[0]
        if token.type in ("fence", "colon_fence"):
            yield from _of_block(token, lines, at)
        elif token.type == "hr" and at == 1:
            yield at, "the front matter has no end. Close it with a line `---`."
        elif token.type in ("inline", "html_block"):
            shown = INLINE_CODE.sub("", token.content)
            yield from ((at, HTML.format(found[0])) for found in HIDDEN.finditer(shown))
            if shown.count("$$") % 2:
                yield (
                    at,
                    "the formula that begins with $$ is not closed. Close it with $$.",
                )


def _of_block(token: Token, lines: Sequence[str], at: int) -> Iterator[Problem]:
    """Yield the problems of a fence or a directive that begins at a line of the page."""
    first, last = token.map or (0, 0)
    mark, found = token.markup, DIRECTIVE.match(token.info.strip())
    another = re.compile(rf" *{mark}{mark[0]}* *[^\s{mark[0]}]")
    inner, end = lines[first + 1 : last - 1], lines[first + 1 : last][-1:]
    if not any(_ends(line, mark) for line in end) or any(map(another.match, inner)):
        yield at, UNCLOSED.format(mark + token.info, mark)
    elif found and found[1] in ("code-cell", "raw-cell"):
        yield at, NOT_RUN
    elif found and found[1] not in VERBATIM:
        nested = token.type[0] == "c" and token.content.startswith(
            ":::"
        )  # as MyST recognizes it
        content = "\n" * nested + token.content
        yield from _of_directive(found[1], found[2], content, at - nested)


def _ends(line: str, mark: str) -> bool:
    """Whether a line, which may be in a list or a quote, ends a block with this mark."""
    line = line.strip(" \t>")
    return len(line) >= len(mark) and not line.strip(mark[0])


def _of_directive(name: str, title: str, content: str, at: int) -> Iterator[Problem]:
    parsed = parse_directive_text(TestDirective, title, content)
    if name in UNREAD:
        yield at, NOT_READ.format(name)
    options = [
        parsed.options.get(f"class{part}") for part in ("", "-container", "-card")
    ]
    classes = " ".join(map(str, options)).split()
    named = ANSWER.search(f"{name} {title}" if name in TITLED else name)
    marked = {SOLUTION, EXPLANATION}.intersection(classes)
    if not marked and (named or FOLDS.intersection([name, *classes])):
        yield (
            at,
            UNMARKED.format(
                name, title, "class-container" if name == "dropdown" else "class"
            ),
        )
    yield from _of_text("\n".join(parsed.body), at + 1 + parsed.body_offset)
