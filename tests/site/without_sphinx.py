"""Directives where Sphinx does not run: a folder, and a parser of Markdown."""

from types import SimpleNamespace

from docutils.core import publish_doctree
from myst_parser.parsers.docutils_ import Parser

from robo_genesis.site.evidence import panel


class Panel(panel.Evidence):
    """The panel of recorded runs for a book's page `lessons/page`."""

    def __init__(self, book, **options):
        self.options = options
        app = SimpleNamespace(outdir=book / "_build" / "html")
        env = SimpleNamespace(srcdir=book, app=app, docname="lessons/page")
        self.state = SimpleNamespace(
            document=SimpleNamespace(settings=SimpleNamespace(env=env, record_dependencies=None))
        )

    def parse_text_to_nodes(self, text):
        return publish_doctree(text, parser=Parser()).children
