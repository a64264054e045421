"""Directives where Sphinx does not run: a folder, a parser of Markdown, and a page of one block."""

import shutil
from collections import defaultdict
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import trimesh
from docutils import nodes
from docutils.core import publish_doctree, publish_from_doctree
from docutils.utils import new_document
from myst_parser.parsers.docutils_ import Parser

from robo_genesis.core.project import BOOK
from robo_genesis.sim.visual_shape import Part
from robo_genesis.site.evidence import panel
from robo_genesis.site.evidence.plain_nodes import between
from robo_genesis.site.evidence.plain_nodes import html as html_of
from robo_genesis.site.figures import palette_css
from robo_genesis.site.replay import viewer

SCRIPTS = (
    "memory.js",
    "scroll-boxes.js",
    "plot.js",
    "stage.js",
    "replay.js",
    "explorer.js",
)
SHEETS = ("course.css", "plot.css", "replay.css", "explorer.css")


class Panel(panel.Evidence):
    """The panel of recorded runs for a book's page `lessons/page`."""

    def __init__(self, book):
        app = SimpleNamespace(outdir=book / "_build" / "html")
        named = {"docname": "lessons/page", "metadata": defaultdict(dict)}
        config = SimpleNamespace(root_doc="index")
        env = SimpleNamespace(srcdir=book, app=app, config=config, **named)
        settings = SimpleNamespace(env=env, record_dependencies=None)
        self.state = SimpleNamespace(document=SimpleNamespace(settings=settings))

    def parse_text_to_nodes(self, text):
        return publish_doctree(text, parser=Parser()).children


def page_of(block: nodes.Node, folder: Path) -> Path:
    """Write a page that holds one block alone, for a browser, and return its file.

    Args:
        block: of a directive for the book `folder / "book"`.
        folder: of the test.
    """
    document = new_document("page")
    document += block.deepcopy()
    for box in list(document.findall(between)):  # whose writer is Sphinx's
        ends = (html_of(box[end]) for end in ("opening", "closing"))
        box.replace_self([next(ends), *box.children, next(ends)])
    for image in document.findall(nodes.image):  # which Sphinx copies
        image["uri"] = (folder / "book" / image["uri"][1:]).resolve().as_uri()
    html = publish_from_doctree(document, writer_name="html5").decode()
    site = folder / "book" / "_build" / "html"
    (site / "lessons").mkdir(parents=True, exist_ok=True)
    (site / "palette.css").write_text(palette_css.css())
    viewer.write_viewer(SimpleNamespace(outdir=site), None)
    for name in SHEETS + SCRIPTS:
        shutil.copy(BOOK / "_static" / name, site)
    sheets = ("palette.css", *SHEETS)
    head = [f'<link rel="stylesheet" href="../{name}">' for name in sheets]
    head += [f'<script defer src="../{name}"></script>' for name in SCRIPTS]
    file = site / "lessons" / "page.html"
    file.write_text(html.replace("</head>", f"{''.join(head)}</head>"))
    return file


def box(link, size=0.2, rgb=(200, 80, 0), at=(0, 0, 0)) -> Part:
    """A cube as the shape of a link; its width and the place of its middle are in [m]."""
    mesh = trimesh.creation.box(
        (size, size, size), trimesh.transformations.translation_matrix(at)
    )
    return Part(link, rgb, mesh.vertices.astype(np.float32), mesh.faces)


def rows_of(found):
    """The text of the cells of every row of the tables among some nodes."""
    rows = [row for node in found for row in node.findall(nodes.row)]
    return [[cell.astext() for cell in row.findall(nodes.entry)] for row in rows]
