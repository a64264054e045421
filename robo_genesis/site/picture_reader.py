"""A recorded picture to read pixel by pixel: ```` ```{picture-reader} l05/cameras world ````.

A reader points at a pixel and reads what it shows, its depth, its point and the closed form, from
the frames of a page's bundle.
"""

import base64
from html import escape
from io import BytesIO
from pathlib import Path
from typing import Any

from docutils import nodes
from PIL import Image
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robo_genesis.site.evidence.measured import BACKEND
from robo_genesis.site.evidence.plain_nodes import image
from robo_genesis.site.explorer import of_lesson
from robo_genesis.site.replay.controls import as_json

LINES = ("pixel", "shows", "depth", "point in the world", "closed form", "depth − closed form")


class PictureReaderDirective(SphinxDirective):
    """Show a view of a page's bundle of this build."""

    required_arguments = 2

    def run(self) -> list[nodes.Node]:
        """Return the picture, or SKIP for a run without a camera.

        Errors: the page has no bundle, or its lesson has no such view.
        """
        folder, run, view = of_lesson(self, "picture")
        if not run.rendered:
            return [nodes.paragraph("", "SKIP: this run has no camera.")]
        lesson_page, name = self.arguments
        return [reader_block(self, f"{lesson_page}/{BACKEND}", name, folder / "frames", view)]


def reader_block(
    directive: SphinxDirective, key: str, name: str, frames: Path, view: dict[str, Any]
) -> nodes.Node:
    """Return the picture with the controls that a script fills and shows.

    Args:
        directive: the directive that shows it.
        key: names the run, as in the ledger.
        name: of the view.
        frames: folder of its frames.
        view: as the lesson's `explorer.picture` returns it.
    """
    read = {
        part: (frames / f"{name}_{part}.png").read_bytes() for part in ("depth", "segmentation")
    }
    data = {"view": as_json(view)} | {k: base64.b64encode(v).decode() for k, v in read.items()}
    words = " ".join(f'data-{key}="{escape(text)}"' for key, text in data.items())
    file = "-".join(("picture", *key.split("/"), f"{name}.jpg"))
    picture = image(directive.env, file, as_jpeg(frames / f"{name}_rgb.png"), view["alt"])
    cross = nodes.raw("", '<span class="cross" hidden></span>', format="html")
    block = nodes.container(classes=["picture-reader-block"], evidence_runs=(key,))
    block += nodes.raw("", f'<div class="picture-reader" {words}>', format="html")
    stage = nodes.container("", picture, cross, classes=["stage"])
    block += nodes.figure("", stage, nodes.caption("", view["caption"]), ids=[file[:-4]])
    block += nodes.raw("", panel(view["size"]), format="html")
    return block


def as_jpeg(frame: Path) -> bytes:
    """Return a frame as a smaller picture to look at; all numbers are read from other frames."""
    content = BytesIO()
    with Image.open(frame) as picture:
        picture.convert("RGB").save(content, "JPEG", quality=85, optimize=True)
    return content.getvalue()


def panel(size: tuple[int, int]) -> str:
    """Return the controls and the end of the reader as HTML."""
    ranges = "".join(
        f'<label>{label} <input type="range" name="{label.lower()}" min="0" max="{count - 1}" '
        f'value="{count // 2}"></label>'
        for label, count in zip(("Column", "Row"), size, strict=True)
    )
    lines = "".join(f"<div><dt>{escape(line)}</dt><dd>&nbsp;</dd></div>" for line in LINES)
    return (
        f'<div class="panel" hidden><p>Point at the picture, or use the arrow keys at a slider.</p>'
        f'<div class="controls">{ranges}</div><dl>{lines}</dl></div></div>'
    )


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("picture-reader", PictureReaderDirective)
