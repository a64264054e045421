"""What a lesson measured, at a glance: ```` ```{glance} l04 ```` on the page on evidence.

A plot of this build's lab, and the camera's last frame beside it where rendering ran.
"""

import io
import os
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robo_genesis.core.declaration import Compared, Moving
from robo_genesis.evidence.bundle import Predicate, read_manifest
from robo_genesis.evidence.replay_data import read_runs
from robo_genesis.lessons import compared_cases, course_marks, filmed
from robo_genesis.pipeline.pages.built import LAST_OUTPUTS
from robo_genesis.site.evidence.ledger_data import PageRun
from robo_genesis.site.evidence.measured import page_run
from robo_genesis.site.evidence.panel import Picture, figure, frames


class Glance(SphinxDirective):
    """Show pictures of a lesson's accepted run on CPU."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return the figures.

        Errors are a lesson without an accepted run of this build, and one that compares no cases.
        """
        lesson = self.arguments[0]
        compared = compared_cases(lesson)
        if compared is None:
            raise self.error(
                f"glance: {lesson} compares no cases. Declare `compared` in its LESSON."
            )
        run = page_run(Path(self.env.srcdir), lesson)
        predicate = shown_predicate(run)
        if predicate is None:
            raise self.error(f"glance: {lesson} has no accepted run: {run.status.reason}")
        box = nodes.container(classes=["glance"], evidence_runs=(run.key,))
        camera = frames(run.folder, filmed(lesson), run.status.backend)
        last = (frame for frame in camera if frame.name == "final")
        for picture in (response(run.folder, compared), *last):
            box += figure(self, f"glance-{lesson}-{picture.name}", picture)
        if predicate.render.mode != "camera":
            box += nodes.paragraph("", "SKIP: rendering was off, so there is no camera frame.")
        return [box]


def shown_predicate(run: PageRun) -> Predicate | None:
    """Return what the manifest of a run that may be shown states, None for another run.

    With the outputs of last runs, a stale run is shown. The lines of provenance give its state.
    """
    if run.status.code == "stale" and LAST_OUTPUTS in os.environ:
        return read_manifest(run.folder).predicate
    return run.predicate


def response(folder: Path, compared: Compared | Moving) -> Picture:
    """Return the first channel of the compared cases, drawn from a bundle's arrays."""
    runs = read_runs(folder, compared)
    stream = io.BytesIO()

    from robo_genesis.core import plotting

    with plotting.course_style():
        drawing = plotting.figure(3.2)
        ax = drawing.subplots()
        plotting.first_channel(ax, runs, course_marks())
        ax.set_xlim(0, compared.until)
        ends = [(values[0], values[-1]) for values in runs.channels[0].values.values()]
        fall = sum(last < first for first, last in ends) > len(ends) / 2
        ax.set_title(ax.get_title(loc="left"), loc="left", pad=6)
        ax.legend(loc="upper right" if fall else "lower right")
        drawing.savefig(stream, format="svg", metadata={"Date": None, "Creator": None})
    return Picture("response", ".svg", stream.getvalue(), runs.alt, runs.caption)


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("glance", Glance)
