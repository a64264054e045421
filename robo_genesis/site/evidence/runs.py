"""The runs of this build and the recorded ones: their states, as pages show them.

| directive | shows |
|---|---|
| {lesson-status} l04 | a line with the states of a lesson's runs, details in a fold |
| {course-status} | the states of the runs of each published lesson |
| {course-measured} | a line: engine version and dates of this build's runs |
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

from docutils import nodes
from markupsafe import Markup
from sphinx.application import Sphinx

from robo_genesis.core import project
from robo_genesis.core.markup import filled
from robo_genesis.evidence.bundle import Manifest
from robo_genesis.pipeline.bundles.status import (
    RECORDED_PAGE,
    Status,
    bundle_status,
    recorded_folders,
    recorded_status,
)
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.page_index import page_bundle
from robo_genesis.site.course.course_map import MapDirective
from robo_genesis.site.pages import PageDirective

from .plain_nodes import html

BACKEND, REFERENCE = project.BUILD_BACKEND, "amdgpu"


@dataclass(frozen=True, slots=True)
class PageRun:
    """One run of a page on a backend: the folder of its bundle, existing or not, and its state."""

    page: str  # as `l04/lab`
    folder: Path
    status: Status
    recorded: bool = False  # committed with the book; otherwise of this build

    @property
    def key(self) -> str:
        """Page and backend, as items name their run."""
        recorded = "/recorded" if self.recorded else ""
        return f"{self.page}/{self.status.backend}{recorded}"

    @property
    def anchor(self) -> str:
        """Its anchor in the ledger."""
        return f"run-{self.key}".replace("/", "-")

    @property
    def started(self) -> str:
        """Date and time (UTC) at which the accepted run began."""
        return self.manifest.started[:19].replace("T", " ") if self.manifest else ""

    @property
    def lesson(self) -> str:
        """The lesson of its page."""
        return self.page.split("/")[0]

    @property
    def command(self) -> str:
        """The command that creates it, as a console shows it."""
        if self.recorded:
            return f"$ make evidence LESSON={self.lesson} BACKEND={self.status.backend}"
        return "$ make book"

    @property
    def manifest(self) -> Manifest | None:
        """The accepted manifest, None where there is none."""
        return self.status.manifest


@lru_cache(maxsize=64)
def page_run(book: Path, lesson: str, page: str = RECORDED_PAGE) -> PageRun:
    """Return a page's run of this build; it does not change while Sphinx runs."""
    name = f"{lesson}/{page}"
    folder, absent = page_bundle(name), f"No bundle was recorded for {name}."
    status = bundle_status(folder, lesson, page, absent, book, once=True)
    return PageRun(name, folder, status)


@lru_cache(maxsize=64)
def recorded_runs(book: Path, lesson: str) -> tuple[PageRun, ...]:
    """Return the recorded runs of a lesson's lab, the reference first, recorded or not."""
    folder, name = book / "evidence" / lesson, f"{lesson}/{RECORDED_PAGE}"
    recorded = [path.name for path in recorded_folders(book) if path.parent == folder]
    return tuple(
        PageRun(name, folder / backend, recorded_status(book, lesson, backend), True)
        for backend in dict.fromkeys((REFERENCE, *recorded))
    )


@lru_cache(maxsize=4)
def measured_pages(book: Path) -> dict[str, str]:
    """Return docname → `lesson/page` of the pages that run the engine."""
    return {
        page.docname: f"{page.lesson}/{page.page}"
        for page in find_pages(book)
        if page.declares_bundle
    }


@lru_cache(maxsize=4)
def all_runs(book: Path) -> dict[str, PageRun]:
    """Return the runs of this build and the recorded ones by key, missing runs included."""
    runs = [page_run(book, *name.split("/")) for name in measured_pages(book).values()]
    recorded = [run for own in runs for run in recorded_runs(book, own.lesson)]
    return {run.key: run for run in (*runs, *recorded)}


def badge(status: Status) -> Markup:
    """Return a state as the site shows it everywhere: one word and its colour."""
    span = Markup('<span class="evidence-badge state-{}">{}</span>')
    return span.format(status.state, status.badge)


def lesson_statuses(book: Path, lesson: str) -> list[Status]:
    """Return the states of a lesson's lab: of this build on CPU, then of the recorded runs."""
    return [
        run.status for run in (page_run(book, lesson), *recorded_runs(book, lesson))
    ]


class LessonStatus(PageDirective):
    """Show the states of a lesson's runs in one line, and a sentence on each behind it.

    Missing runs are left out unless all are missing.
    """

    required_arguments = 1

    def shown(self) -> list[nodes.Node]:
        """Return the fold; inside it is one line per backend."""
        statuses = lesson_statuses(self.book, self.arguments[0])
        known = [status for status in statuses if status.state != "missing"] or statuses
        return [status_list(known, line=known)]


class CourseStatus(MapDirective):
    """Show the state of the runs of each published lesson's lab."""

    def shown(self) -> list[nodes.Node]:
        """Return a title and a list for each lesson."""
        link = partial(self.env.app.builder.get_relative_uri, self.env.docname)
        return [
            status_list(lesson_statuses(self.book, x.id.lower()), lesson=x, link=link)
            for x in self.published()
        ]


def status_list(statuses: Iterable[Status], **values: Any) -> nodes.Node:
    """Return the states of runs as a list, below a lesson's title or in the fold of a line."""
    template = Path(__file__).with_name("statuses.html")
    return html(filled(template, statuses=statuses, badge=badge, **values))


class CourseMeasured(PageDirective):
    """Show with which engine and when the runs of this build were measured, then its content."""

    has_content = True

    def shown(self) -> list[nodes.Node]:
        """Return the paragraph."""
        line = measured_line(all_runs(self.book).values())
        text = "\n".join(["{.course-measured}", line, *self.content])
        return self.parse_text_to_nodes(text)


def measured_line(runs: Iterable[PageRun]) -> str:
    """Return engine version and dates of the accepted runs that were not recorded.

    Args:
        runs: of this build, and recorded ones, which are left out.
    """
    own = [run.manifest for run in runs if run.manifest and not run.recorded]
    dates = sorted({manifest.started[:10] for manifest in own})
    if not dates:
        return "No run of this build was accepted."
    when = f"on {dates[0]}" if len(dates) == 1 else f"from {dates[0]} to {dates[-1]}"
    return f"Measured on CPU with Genesis {project.engine_pin()} {when}."


def setup(app: Sphinx) -> None:
    """Register the directives."""
    app.add_directive("lesson-status", LessonStatus)
    app.add_directive("course-status", CourseStatus)
    app.add_directive("course-measured", CourseMeasured)
