"""A page's prose as plain Markdown, for a notebook that is opened outside the site.

Only the directives that are listed here are kept, so that no solution passes unnoticed.
"""

import re
import textwrap
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urljoin

from docutils.parsers.rst.directives.misc import TestDirective
from markdown_it.renderer import RendererHTML
from markdown_it.token import Token
from myst_parser.config.main import MdParserConfig
from myst_parser.parsers.directives import parse_directive_text
from myst_parser.parsers.mdit import create_md_parser

from robo_genesis.pipeline.pages.page_rules import SOLUTION
from robo_genesis.site.text.excerpts import excerpt

PARSER = create_md_parser(
    MdParserConfig(enable_extensions={"amsmath", "colon_fence", "dollarmath"}),
    RendererHTML,
)
DIRECTIVE = re.compile(r"\{([\w:-]+)\}\s*(.*)")
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

# Words that replace a role whose text only the site can write.
UNTITLED = {
    "numref": "the figure",
    "eq": "the equation",
    "ref": "the section",
    "doc": "the site",
}

# Tokens of the blocks that are not running text.
BLOCKS = (
    "fence",
    "code_block",
    "colon_fence",
    "math_block",
    "math_block_label",
    "amsmath",
    "myst_target",
    "myst_line_comment",
    "myst_block_break",
)

GUARD = re.compile(r" ?\{guard\}`[^`]*`")
ROLE = re.compile(r"\{([a-z][\w:-]*)\}(`+)(.+?)\2", re.DOTALL)
TITLED = re.compile(r"(.+?)\s*<[^<>]+>", re.DOTALL)
LINK = re.compile(r"!?\[([^\]]*)\]\((?!https?:|mailto:)([^)\s]*)\)")


@dataclass(frozen=True, slots=True)
class Writer:
    """The page's folder, and the function that returns the text of a measured value.

    `address` is that of the page on the site, empty where it is not known.
    """

    folder: Path
    measured: Callable[[str], str]
    address: str = ""


def plain(text: str, writer: Writer) -> str:
    """Return MyST prose, of a cell or a directive, as plain Markdown without solutions."""
    lines, written, at = text.splitlines(), [], 0
    for token in PARSER.parse(text):
        first, last = token.map or (0, 0)
        if token.type in BLOCKS and first >= at:
            indent = re.match(r"\s*", lines[first])[0]  # type: ignore[index] # matches any line
            block = _block(token, textwrap.dedent("\n".join(lines[first:last])), writer)
            written += [
                _inline(lines[at:first], writer),
                textwrap.indent(block, indent),
            ]
            at = last
    written.append(_inline(lines[at:], writer))
    return re.sub(r"\n{3,}", "\n\n", "\n".join(written)).strip()


def _block(token: Token, source: str, writer: Writer) -> str:
    """Return a block as plain Markdown without targets, comments and breaks."""
    if found := DIRECTIVE.match(token.info.strip()):
        return _directive(found[1], found[2], token.content, writer)
    return "" if token.type.startswith(("myst", "colon")) else source


def _directive(name: str, first_line: str, content: str, writer: Writer) -> str:
    """Return a directive as plain Markdown; a solution or an unlisted directive is dropped."""
    found = parse_directive_text(TestDirective, first_line, content)  # takes any option
    argument, body, options = (
        " ".join(found.arguments),
        "\n".join(found.body),
        found.options,
    )
    classes = f"{name} {options.get('class')} {options.get('class-container')}".split()
    if SOLUTION in classes:
        return ""
    if name in ADMONITIONS:
        argument, body = name.capitalize(), f"{argument}\n{body}"
    if name in ("admonition", "dropdown", *ADMONITIONS):
        quoted = f"**{_inline([argument], writer)}**\n\n{plain(body, writer)}"
        return textwrap.indent(quoted, "> ", lambda _: True)
    match name:
        case "literalinclude":
            return f"```python\n{excerpt(writer.folder, first_line, content).rstrip()}\n```"
        case "code" | "code-block":
            return f"```{argument}\n{body}\n```"
        case "math":
            return f"$$\n{body.strip()}\n$$"
        case "choice" | "number":
            question = re.split(r"\n(?=[-*] )", body)[
                0
            ]  # the causes below it answer it
            return f"**Question.** {plain(question, writer)}"
        case "figure":
            return f"*On the site, a figure: {plain(body, writer)}*"
    return ""


def _inline(lines: list[str], writer: Writer) -> str:
    """Return running text without roles. Links lead to the site, if its address is known."""

    def link(found: re.Match[str]) -> str:
        target = urljoin(writer.address, re.sub(r"\.md(?=#|$)", ".html", found[2]))
        return f"[{found[1]}]({target})" if writer.address and found[1] else found[1]

    text = GUARD.sub("", "\n".join(lines))
    text = ROLE.sub(lambda role: _role(role[1], role[3], writer), text)
    return LINK.sub(link, text)


def _role(name: str, text: str, writer: Writer) -> str:
    """Return a role as plain Markdown."""
    titled = TITLED.fullmatch(text)
    if name == "measured":
        return writer.measured(text)
    if name == "engine-source":
        return f"`genesis/{text}`"
    return titled[1] if titled else UNTITLED.get(name, text)
