"""A page's prose as plain Markdown, for a notebook that is opened where no Sphinx is.

A directive travels only if it is listed here, so nothing that a page folds away as a solution can
travel unseen, and neither can a measured value.
"""

import re
import textwrap
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import yaml
from markdown_it import MarkdownIt
from markdown_it.token import Token
from mdit_py_plugins.amsmath import amsmath_plugin
from mdit_py_plugins.colon_fence import colon_fence_plugin
from mdit_py_plugins.dollarmath import dollarmath_plugin
from mdit_py_plugins.myst_blocks import myst_block_plugin
from sphinx.config import Config
from sphinx.directives.code import LiteralIncludeReader

SOLUTION = "solution"
"""The tag of a code cell and the class of a directive that hold one."""

ADMONITIONS = ("note", "tip", "hint", "important", "attention", "caution", "warning", "danger")
TOLD = {"numref": "the figure", "eq": "the equation", "ref": "the section", "doc": "the site"}
"""What stands for a link whose text is written by the site."""

DIRECTIVE = re.compile(r"\{([\w:-]+)\}\s*(.*)")
OPTION = re.compile(r":([\w-]+):\s*(.*)")
ROLE = re.compile(r"\{([a-z][\w:-]*)\}(`+)(.+?)\2", re.DOTALL)
TITLED = re.compile(r"(.+?)\s*<[^<>]+>", re.DOTALL)
LINK = re.compile(r"(!?)\[([^\]]*)\]\((?!https?:|mailto:)[^)\s]*\)")
VERBATIM = ("fence", "code_block", "math_block", "math_block_label", "amsmath")


class ProseError(ValueError):
    """The prose cannot become plain Markdown; the message says what to write instead."""


@dataclass(frozen=True, slots=True)
class Writer:
    """What prose needs from around it: the page's folder, and the words for a measured value."""

    folder: Path
    measured: Callable[[str], str]


def plain(text: str, writer: Writer) -> str:
    """Return MyST prose as plain Markdown, without solutions.

    Args:
        text: of one cell, or of the inside of a directive.
        writer: see there.

    Raises:
        ProseError: a fold is written as HTML, whose content cannot be told from prose.
    """
    lines, written, at = text.splitlines(), [], 0
    for token in _blocks(text):
        first, last = token.map or (0, 0)
        if first < at:
            continue  # inside of what was written already
        written.append(_inline("\n".join(lines[at:first]), writer))
        block = textwrap.dedent("\n".join(lines[first:last]))
        indent = lines[first][: len(lines[first]) - len(lines[first].lstrip())]
        written.append(textwrap.indent(_block(token, block, writer), indent))
        at = last
    written.append(_inline("\n".join(lines[at:]), writer))
    return re.sub(r"\n{3,}", "\n\n", "\n".join(written)).strip()


def _blocks(text: str) -> Iterator[Token]:
    """Yield the blocks that are not plain prose, in their order."""
    parser = MarkdownIt("commonmark").enable("table").use(myst_block_plugin)
    parser.use(colon_fence_plugin).use(dollarmath_plugin).use(amsmath_plugin)
    for token in parser.parse(text):
        if token.type == "html_block" and "<details" in token.content.lower():
            raise ProseError(
                "a fold is written as <details>. Write a dropdown: `:::{dropdown} Title`."
            )
        if token.map and (token.type in VERBATIM or token.type.startswith(("myst", "colon"))):
            yield token


def _block(token: Token, source: str, writer: Writer) -> str:
    """Return a block as plain Markdown; what only the site knows is left out."""
    if token.type.startswith("myst"):
        return ""  # targets, comments, breaks
    found = DIRECTIVE.match(token.info.strip()) if "fence" in token.type else None
    if found is None:
        return source if token.type != "colon_fence" else ""
    options, body = split_options(token.content)
    return _directive(found[1], found[2].strip(), options, body, writer)


def split_options(content: str) -> tuple[Mapping[str, str], str]:
    """Return options and body of a directive; options are `:name: value` lines or a YAML block."""
    lines = content.splitlines()
    if lines and lines[0].strip() == "---":
        end = next(k for k, line in enumerate(lines[1:], 1) if line.strip() == "---")
        options = yaml.safe_load("\n".join(lines[1:end])) or {}
        return {name: str(value) for name, value in options.items()}, "\n".join(lines[end + 1 :])
    count = next((k for k, line in enumerate(lines) if not OPTION.match(line)), len(lines))
    pairs = [OPTION.match(line) for line in lines[:count]]
    return {pair[1]: pair[2] for pair in pairs if pair}, "\n".join(lines[count:])


def _directive(
    name: str, argument: str, options: Mapping[str, str], body: str, writer: Writer
) -> str:
    if is_solution(name, argument, options):
        return ""
    if name in ("admonition", "dropdown") or name in ADMONITIONS:
        title = argument if name in ("admonition", "dropdown") else name.capitalize()
        inside = plain(body if title == argument or not argument else f"{argument}\n{body}", writer)
        return textwrap.indent(f"**{_inline(title, writer)}**\n\n{inside}", "> ", lambda _: True)
    if name == "literalinclude":
        return f"```python\n{_excerpt(writer.folder / argument, options)}\n```"
    if name in ("code", "code-block"):
        return f"```{argument}\n{body}\n```"
    if name == "math":
        return f"$$\n{body.strip()}\n$$"
    if name == "choice":
        return f"**Question.** {plain(body, writer)}"
    if name == "figure":
        return f"*On the site, a figure: {plain(body, writer)}*"
    return ""


def is_solution(name: str, title: str, options: Mapping[str, str]) -> bool:
    """Whether a directive holds a solution, by its name, its class or the title of a fold."""
    classes = " ".join(options.get(key, "") for key in ("class", "class-container")).split()
    titled = name == "dropdown" and re.match(r"(?:our |a )?(?:answer|solution)", title, re.I)
    return SOLUTION in (name, *classes) or bool(titled)


def _excerpt(path: Path, options: Mapping[str, str]) -> str:
    """Return the part of a file that a literalinclude shows, as Sphinx itself cuts it."""
    chosen = {key: int(value) if value.isdecimal() else value for key, value in options.items()}
    text, _ = LiteralIncludeReader(str(path.resolve()), chosen, Config()).read()
    return str(text).rstrip()


def _inline(text: str, writer: Writer) -> str:
    """Return running text without roles, and without links that lead nowhere outside the site."""
    return LINK.sub(lambda link: link[2], ROLE.sub(lambda role: _role(role, writer), text))


def _role(role: re.Match[str], writer: Writer) -> str:
    name, text = role[1], role[3]
    titled = TITLED.fullmatch(text)
    if name == "measured":
        return writer.measured(text)
    if name == "engine-source":
        return f"`genesis/{text}`"
    if titled:
        return titled[1]
    return TOLD.get(name, "" if name == "lesson-state" else text)
