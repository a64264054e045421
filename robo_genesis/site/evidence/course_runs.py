"""The runs of the whole course, computed from their bundles.

| in a page | shows |
|---|---|
| {course-measured} (directive) | a line: engine version and dates of this build's runs |
| {course-status} (directive) | the state of the runs of each published lesson |
| {glance} l04 (directive) | a plot of this build's lab and its last camera frame |
"""

import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.util.docutils import SphinxDirective

from robo_genesis.core.channels import Replay
from robo_genesis.core.text import listed
from robo_genesis.evidence.bundle import Predicate, read_manifest
from robo_genesis.evidence.replay_data import read_runs
from robo_genesis.lessons import course_marks, find_replay
from robo_genesis.pipeline.pages.built import LAST_OUTPUTS
from robo_genesis.site.course.course_map import MapDirective, page_link
from robo_genesis.site.evidence.ledger_data import PageRun
from robo_genesis.site.evidence.measured import READABLE, lesson_statuses, page_run, status_list
from robo_genesis.site.evidence.panel import drawn_figure, frames
from robo_genesis.site.evidence.plain_nodes import paragraph
from robo_genesis.site.evidence.provenance import all_runs
from robo_genesis.site.pages import PageDirective

if TYPE_CHECKING:
    from matplotlib.figure import Figure

EVIDENCE = "evidence/index"  # The page that explains the evidence


class CourseMeasured(SphinxDirective):
    """Show with which engine and when the runs of this build were measured."""

    def run(self) -> list[nodes.Node]:
        """Return the line, with a link to the page on evidence where the book has it."""
        line = nodes.paragraph("", measured_line(all_runs(Path(self.env.srcdir)).values()))
        if EVIDENCE in self.env.found_docs:
            link = page_link(self.env.docname, EVIDENCE, "How to read the evidence")
            line += [nodes.Text(" "), link]
        line["classes"].append("course-measured")
        return [line]


def measured_line(runs: Iterable[PageRun]) -> str:
    """Return backend, engine version and dates of the accepted runs that were not recorded.

    Args:
        runs: of this build, and recorded ones, which are left out.
    """
    own = [run for run in runs if not run.recorded]
    accepted = [(run, run.predicate) for run in own if run.predicate is not None]
    if not accepted:
        return "No run of this build was accepted."
    backends = sorted({READABLE.get(run.status.backend, run.status.backend) for run, _ in accepted})
    engines = sorted({predicate.engine.version for _, predicate in accepted})
    dates = sorted({predicate.started[:10] for _, predicate in accepted})
    when = f"on {dates[0]}" if len(dates) == 1 else f"from {dates[0]} to {dates[-1]}"
    line = f"Measured on {listed(backends)} with Genesis {listed(engines)} {when}."
    if lacking := len(own) - len(accepted):
        line += f" {lacking} of {len(own)} runs were not accepted."
    return line


class CourseStatus(MapDirective):
    """Show the state of the runs of each published lesson's lab."""

    def shown(self) -> list[nodes.Node]:
        """Return a title and a list for each lesson."""
        found: list[nodes.Node] = []
        for lesson in (lesson for lesson in self.lessons() if lesson.page):
            assert lesson.page is not None
            title = page_link(self.env.docname, lesson.page, lesson.title)
            found.append(paragraph(nodes.strong("", f"{lesson.id} "), title))
            statuses = lesson_statuses(Path(self.env.srcdir), lesson.id.lower())
            found.append(status_list(statuses))
        return found


class Glance(PageDirective):
    """Show pictures of a lesson's accepted run on CPU."""

    required_arguments = 1

    def shown(self) -> list[nodes.Node]:
        """Return the figures."""
        lesson = self.arguments[0]
        run = page_run(Path(self.env.srcdir), lesson)
        predicate = shown_predicate(run)
        if predicate is None:
            raise LookupError(f"{lesson} has no accepted run: {run.status.reason}")
        box = nodes.container(classes=["glance"], evidence_runs=(run.key,))
        prefix, replay = f"glance-{lesson}", find_replay(lesson)
        box += response(self.env, prefix, run.folder, replay)
        box += frames(self.env, prefix, run.folder, replay, run.status.backend, ["final"])
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


def response(env: BuildEnvironment, prefix: str, folder: Path, replay: Replay) -> nodes.figure:
    """Return the first channel of the compared cases, drawn from a bundle's arrays."""
    from robo_genesis.core import plotting  # it loads slowly

    runs = read_runs(folder, replay)

    def draw(drawing: "Figure") -> None:
        ax = drawing.subplots()
        plotting.first_channel(ax, runs, course_marks())
        ax.set_xlim(0, replay.until)
        ends = [(values[0], values[-1]) for values in runs.channels[0].values.values()]
        fall = sum(last < first for first, last in ends) > len(ends) / 2
        ax.set_title(ax.get_title(loc="left"), loc="left", pad=6)
        ax.legend(loc="upper right" if fall else "lower right")

    return drawn_figure(env, prefix, 3.2, draw, runs.alt, runs.caption)


def setup(app: Sphinx) -> None:
    """Register the directives."""
    app.add_directive("course-measured", CourseMeasured)
    app.add_directive("course-status", CourseStatus)
    app.add_directive("glance", Glance)
