"""The runs of the whole course, computed from their bundles.

| in a page | shows |
|---|---|
| {course-measured} (directive) | a line: engine version and dates of this build's runs |
| {course-status} (directive) | the state of the runs of each published lesson |
| {course-processors} (directive) | processors of this build's runs, and whether two runs agree |
"""

from collections.abc import Iterable
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robo_genesis.core.text import listed
from robo_genesis.site.course.course_map import MapDirective, named, page_link
from robo_genesis.site.evidence.ledger_data import PageRun
from robo_genesis.site.evidence.measured import (
    BACKEND,
    READABLE,
    lesson_statuses,
    status_list,
)
from robo_genesis.site.evidence.plain_nodes import paragraph
from robo_genesis.site.evidence.provenance import all_runs

EVIDENCE = "evidence/index"  # The page that explains the evidence
NONE_ACCEPTED = "No run of this build was accepted."


class CourseMeasured(SphinxDirective):
    """Show with which engine and when the runs of this build were measured."""

    def run(self) -> list[nodes.Node]:
        """Return the line, with a link to the page on evidence where the book has it."""
        line = measured_line(all_runs(Path(self.env.srcdir)).values())
        link = page_link(self.env.docname, EVIDENCE, "How to read the evidence")
        more = [" ", link] if EVIDENCE in self.env.found_docs else []
        return [paragraph(line, *more, classes=["course-measured"])]


def measured_line(runs: Iterable[PageRun]) -> str:
    """Return engine version and dates of the accepted runs that were not recorded.

    Args:
        runs: of this build, and recorded ones, which are left out.
    """
    own = [run for run in runs if not run.recorded]
    accepted = [run.manifest for run in own if run.manifest]
    if not accepted:
        return NONE_ACCEPTED
    engines = sorted({manifest.engine.version for manifest in accepted})
    dates = sorted({manifest.started[:10] for manifest in accepted})
    when = f"on {dates[0]}" if len(dates) == 1 else f"from {dates[0]} to {dates[-1]}"
    line = f"Measured on {READABLE[BACKEND]} with Genesis {listed(engines)} {when}."
    lacking = len(own) - len(accepted)
    return (
        f"{line} {lacking} of {len(own)} runs were not accepted." if lacking else line
    )


class CourseProcessors(SphinxDirective):
    """Show the processors of this build's runs."""

    def run(self) -> list[nodes.Node]:
        """Return a paragraph."""
        runs = all_runs(Path(self.env.srcdir)).values()
        return [nodes.paragraph("", executed_once(runs))]


def executed_once(runs: Iterable[PageRun]) -> str:
    """Return the processors of this build's runs; recorded runs are left out."""
    found = {run.manifest.host.cpu for run in runs if run.manifest and not run.recorded}
    return (
        f"Each page was executed once, on {listed(sorted(found))}."
        if found
        else NONE_ACCEPTED
    )


class CourseStatus(MapDirective):
    """Show the state of the runs of each published lesson's lab."""

    def shown(self) -> list[nodes.Node]:
        """Return a title and a list for each lesson."""
        found: list[nodes.Node] = []
        for lesson in self.lessons():
            if lesson.page:
                title = page_link(self.env.docname, lesson.page, lesson.title)
                statuses = lesson_statuses(Path(self.env.srcdir), lesson.id.lower())
                found += [named(lesson, title), status_list(statuses)]
        return found


def setup(app: Sphinx) -> None:
    """Register the directives."""
    app.add_directive("course-measured", CourseMeasured)
    app.add_directive("course-status", CourseStatus)
    app.add_directive("course-processors", CourseProcessors)
