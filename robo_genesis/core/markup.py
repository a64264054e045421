"""HTML from Jinja templates, which escape each value that they get."""

from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, Template

MEASURES = False


def filled(template: Path, **values: Any) -> str:
    """Return the text of a template with these values, escaped as HTML."""
    return _read(template).render(values)


@cache
def _read(template: Path) -> Template:
    environment = Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True)
    return environment.from_string(template.read_text("utf8"))
