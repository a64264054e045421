"""HTML from Jinja templates, which escape each value that they get.

The filter `inline` also turns the code and the emphasis of a Markdown text into HTML.
"""

from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, Template
from markdown_it import MarkdownIt
from markupsafe import Markup

MEASURES = False


def filled(template: Path, **values: Any) -> str:
    """Return the text of a template with these values, escaped as HTML."""
    return _read(template).render(values)


@cache
def _read(template: Path) -> Template:
    environment = Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True)
    markdown = MarkdownIt("commonmark", {"html": False})
    environment.filters["inline"] = lambda text: Markup(markdown.renderInline(text))
    return environment.from_string(template.read_text("utf8"))
