"""A page's minutes below its title, a link for feedback at its end, and its description."""

import textwrap
from html import escape
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

from docutils import nodes
from sphinx.application import Sphinx

from robo_genesis.core.project import engine_pin
from robo_genesis.site.evidence.plain_nodes import html

from .sizes import count_minutes

# Longest description, in characters: search engines show about as many
DESCRIPTION = 200
MINUTES = "minutes"  # The name of the time in a page's metadata
COUNTED = "minutes"  # The label of the section that says how the time is counted


FORM = "lesson.yml"  # The repository's form for a mistake or a question


def add_facts(app: Sphinx, document: nodes.document, docname: str) -> None:
    """Insert the time below the title, except on the home page, and the link at the end."""
    section = document.next_node(nodes.section)
    repository = app.config.course_repository
    if docname != app.config.root_doc:
        time: nodes.Node = nodes.Text(str(app.env.metadata[docname][MINUTES]))
        if COUNTED in (labels := app.env.domaindata["std"]["anonlabels"]):
            page, anchor = labels[COUNTED]
            place = app.builder.get_relative_uri(docname, page)
            link = nodes.reference("", "", time, internal=True)
            link["refuri"] = f"{place}#{anchor}"
            time = link
        line = nodes.paragraph("", "About ", time, nodes.Text("."))
        line["classes"].append("page-facts")
        section.insert(1, line)
    if repository.startswith("https://github.com/"):
        place = f"{docname}, Genesis {engine_pin()}"
        address = (
            f"{repository}/issues/new?{urlencode({'template': FORM, 'page': place})}"
        )
        link = f'<a href="{escape(address)}">Report a mistake on this page, or ask</a>'
        section += html(f'<p class="report">{link}</p>')


def keep_facts(app: Sphinx, document: nodes.document) -> None:
    """Keep the time that a page takes, and the beginning of its first paragraph."""
    name = app.env.docname
    facts: dict[str, Any] = app.env.metadata[name]
    facts[MINUTES] = count_minutes(name, Path(app.env.doc2path(name)))
    section = document.next_node(nodes.section)
    paragraphs = (n for n in section or () if isinstance(n, nodes.paragraph))
    if node := next(paragraphs, None):
        text = textwrap.shorten(node.astext(), DESCRIPTION, placeholder=" …")
        facts["og:description"] = text  # for the social card
        document.insert(0, nodes.meta("", name="description", content=text))


def add_place(
    app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: Any
) -> None:
    """Keep room for the line in which `memory.js` offers to mark a page of a lesson."""
    if page.startswith("lessons/"):
        context["body"] += '<p class="finish-page"></p>\n'


def setup(app: Sphinx) -> None:
    """Register the additions."""
    app.connect("html-page-context", add_place)
    app.connect("doctree-read", keep_facts)
    app.connect("doctree-resolved", add_facts)
