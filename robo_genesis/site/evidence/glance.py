"""What a lesson measured, at a glance: ```` ```{glance} l04 ```` on the home page.

A plot of this build's lab, and the camera's last frame beside it where rendering ran.
"""

import io
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from docutils import nodes
from matplotlib.figure import Figure
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robo_genesis.core import plotting
from robo_genesis.evidence.replay_data import read_runs
from robo_genesis.evidence.status import RECORDED_PAGE, Status
from robo_genesis.lessons.declaration import Compared, Moving
from robo_genesis.lessons.registry import compared_cases, filmed
from robo_genesis.site.evidence.ledger_data import Run
from robo_genesis.site.evidence.measured import BACKEND, outputs_folder, page_state
from robo_genesis.site.evidence.panel import Picture, frames


class Glance(SphinxDirective):
    """Show pictures of a lesson's accepted run on CPU."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return the figures.

        Errors are a lesson without an accepted run of this build, and one that compares no cases.
        """
        lesson, book = self.arguments[0], Path(self.env.srcdir)
        compared = compared_cases(lesson)
        if compared is None:
            raise self.error(
                f"glance: {lesson} compares no cases. Declare `compared` in its LESSON."
            )
        status = page_state(outputs_folder(), lesson, RECORDED_PAGE, book)
        if status.manifest is None:
            raise self.error(f"glance: {lesson} has no accepted run: {status.reason}")
        folder = outputs_folder() / lesson / RECORDED_PAGE / BACKEND
        run = Run(f"{lesson}/{RECORDED_PAGE}", folder, status).key
        box = nodes.container(classes=["glance"], evidence_runs=(run,))
        shown = pictures(folder, compared, lesson, status)
        box += [self.figure(lesson, picture) for picture in shown]
        if status.manifest.predicate.render.mode != "camera":
            box += nodes.paragraph("", "SKIP: rendering was off, so there is no camera frame.")
        return [box]

    def figure(self, lesson: str, picture: Picture) -> nodes.Node:
        """Return a figure; its file lies beside the site until Sphinx copies it."""
        anchor = f"glance-{lesson}-{picture.name}"
        file = Path(self.env.app.outdir).parent / "panel" / f"{anchor}{picture.suffix}"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(picture.content)
        image = nodes.image(uri=f"/{os.path.relpath(file, self.env.srcdir)}", alt=picture.alt)
        return nodes.figure("", image, nodes.caption("", picture.caption), ids=[anchor])


def pictures(
    folder: Path, compared: Compared | Moving, lesson: str, status: Status
) -> Iterator[Picture]:
    """Yield the plot, and the last camera frame if there is one."""
    yield response(folder, compared)
    for frame in frames(folder, filmed(lesson), status):
        if frame.name == "final":
            yield frame


def response(folder: Path, compared: Compared | Moving) -> Picture:
    """Return the first channel of the compared cases, drawn from a bundle's arrays."""
    runs = read_runs(folder, compared)
    stream = io.BytesIO()
    with plotting.course_style():
        figure = Figure(figsize=(4.8, 3.6))
        ax = figure.subplots()
        plotting.first_channel(ax, runs)
        ax.set_xlim(0, compared.until)
        ends = [(values[0], values[-1]) for values in runs.channels[0].values.values()]
        fall = sum(last < first for first, last in ends) > len(ends) / 2
        ax.legend(loc="upper right" if fall else "lower right", fontsize="medium")
        figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None})
    return Picture("response", ".svg", stream.getvalue(), runs.alt, runs.caption)


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive."""
    app.add_directive("glance", Glance)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
