"""Nodes that no parser of markup makes."""

import os
from functools import partial
from html import escape
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment


class between(nodes.General, nodes.Element):  # noqa: N801 - docutils names nodes in lower case
    """Nodes between two pieces of the site's own HTML, `opening` and `closing`."""


def _write(part: str, self: Any, node: between) -> None:
    self.body.append(node[part])


# What Sphinx calls before and after such nodes.
WRITERS = (partial(_write, "opening"), partial(_write, "closing"))


class late(nodes.General, nodes.Element):  # noqa: N801 - docutils names nodes in lower case
    """Markup that needs all pages: `make(app, docname)` returns it when they are read."""


def fill_in(app: Sphinx, doctree: nodes.document, docname: str) -> None:
    """Write the markup that waited for all pages."""
    for place in list(doctree.findall(late)):
        place.replace_self(html(place["make"](app, docname)))


def image(env: BuildEnvironment, name: str, content: bytes, alt: str) -> nodes.image:
    """Return a picture; its file is written outside the site until Sphinx copies it.

    Args:
        env: of the build.
        name: of the file, unique on the site.
        content: of the file.
        alt: its alternative text.
    """
    file = Path(env.app.outdir).parent / "panel" / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(content)
    return nodes.image(uri=f"/{os.path.relpath(file, env.srcdir)}", alt=alt)


def html(text: str) -> nodes.Node:
    """Return markup of the site's own."""
    return nodes.raw("", text, format="html")


def scroll_box(label: str, *inside: nodes.Node) -> between:
    """Return a box that scrolls a wide table and accepts the keyboard's focus."""
    named = (
        f'aria-label="{escape(label)}" class="scroll-box" role="region" tabindex="0"'
    )
    return between("", *inside, opening=f"<div {named}>\n", closing="</div>\n")


def on_request(*inside: nodes.Node) -> between:
    """Return long content of a fold, which `scroll-boxes.js` adds to the page when it opens.

    Until then it is text to a browser with scripts; without them it is always there.
    """
    return between("", *inside, opening="<noscript>\n", closing="</noscript>\n")
