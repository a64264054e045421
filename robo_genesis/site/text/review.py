"""The questions of all pages: ```` ```{all-questions} ````.

`memory.js` shows those that this browser's reader missed or did not answer.
"""

from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx

from robo_genesis.core.markup import filled
from robo_genesis.pipeline.pages.book import page_files
from robo_genesis.site.evidence.plain_nodes import late
from robo_genesis.site.pages import PageDirective

from .questions import QUESTIONS


class AllQuestions(PageDirective):
    """Show a list of links to the questions, in the order of the table of contents."""

    def shown(self) -> list[nodes.Node]:
        """Return the place of the list."""
        self.env.note_reread()  # it shows questions of other pages
        return [late(make=links)]


def links(app: Sphinx, docname: str) -> str:
    """Return the list, when all pages are read; each item has what a right answer is."""
    env = app.env
    pages = [
        (
            app.builder.get_relative_uri(docname, name),
            env.titles[name].astext(),
            env.metadata[name].get(QUESTIONS, {}),
        )
        for name in page_files(Path(app.srcdir))
    ]
    return filled(Path(__file__).with_suffix(".html"), pages=pages)


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("all-questions", AllQuestions)
