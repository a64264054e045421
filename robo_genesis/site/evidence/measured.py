"""Measured numbers, guards and lesson states in prose: always read from an accepted bundle.

Roles and a directive, as pages write them:

| in a page | shows |
|---|---|
| {measured}`l04/lab G2.overshoot` | a metric, written with its unit |
| {measured}`l04/lab G2.overshoot mrad` | the same in another unit, with three digits |
| {measured}`l05/lab sag_explains:baseline.unexplained_share %` | a value that a check found |
| {measured}`l04/lab engine` | the engine version that the page ran on |
| {guard}`near_coulomb` | nothing: this check of the page guards the sentence before it |
| {guard}`l04/lab saturation` | nothing: the same by a check of another page |
| {engine-source}`engine/scene.py` | a file of the engine, linked to the pinned release |
| {engine-release}`some words` | the pinned release |
| {lesson-status} l04 (directive) | one line with the states of a lesson's runs, details in a fold |
"""

import importlib.metadata
import pickle
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from functools import lru_cache
from hashlib import sha256
from html import escape
from pathlib import Path
from typing import Any, TypeVar, cast

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robo_genesis.core import project
from robo_genesis.core.files import write_whole
from robo_genesis.core.text import format_value, listed, quoted, scaled_value
from robo_genesis.evidence import bundle
from robo_genesis.lessons import find_page
from robo_genesis.pipeline.bundles.status import (
    RECORDED_PAGE,
    Status,
    bundle_status,
    recorded_folders,
    recorded_status,
)
from robo_genesis.pipeline.pages.page_index import (
    measuring_page,
    page_index,
    page_outputs,
)
from robo_genesis.pipeline.pages.values import value_of
from robo_genesis.site.evidence.ledger_data import PageRun
from robo_genesis.site.evidence.plain_nodes import WRITERS, between, bullets
from robo_genesis.site.pages import PageRole

T = TypeVar("T")
BACKEND = project.BUILD_BACKEND
REFERENCE = "amdgpu"
COUNTED = ("episodes", "cells")  # Units that a page gives to counts

# The names of backends in the line below a title.
READABLE = {"cpu": "CPU", "amdgpu": "AMD GPU", "cuda": "CUDA GPU"}
REPOSITORY = "https://github.com/Genesis-Embodied-AI/genesis-world"


def measured(lesson_page: str, name: str) -> tuple[str, str]:
    """Return (text, provenance) of one measured value.

    Args:
        lesson_page: `l04/lab`.
        name: `group.metric` of its metrics.json, `check:label` of what a check found,
            or `engine`. After a space it may have a unit such as mm or %; then the
            value has three digits.

    Raises:
        LookupError: the page has no metric of this name, and the message lists its
            metrics; or the metric has no value in this unit.
        BundleRefused: the bundle cannot be read.
    """
    folder = page_outputs(lesson_page) / BACKEND
    manifest = bundle.read_manifest(folder)
    origin = (
        f"Measured by {lesson_page} on {BACKEND}, Genesis {manifest.engine.version}, "
    )
    origin += f"run {manifest.run_id[:8]}, {manifest.started[:10]}"
    if name == "engine":
        return manifest.engine.version, origin
    name, _, unit = name.partition(" ")
    of_camera = name.partition(".")[0] in find_page(*lesson_page.split("/")).with_camera
    if of_camera and manifest.render.mode != "camera":
        return "SKIP: no camera", origin
    value, given, source = value_of(folder, name, "" if unit in COUNTED else unit)
    if unit in COUNTED:
        if given != "1":
            raise LookupError(
                f"{name} is in {given}, so it does not count {unit}. Valid: {given}."
            )
        text = f"{value:.0f} {unit}"
    elif unit:
        text = format_value(value, unit) if unit == given else scaled_value(value, unit)
    elif given is None:
        text = listed(quoted(value).split(", "))
    else:
        text = str(value) if name.startswith("model.") else format_value(value, given)
    return text, f"{origin}, {source}"


class measured_value(nodes.inline):  # noqa: N801 - docutils names nodes in lower case
    """A measured value in prose; its attribute `provenance` names its run."""


class Measured(PageRole):
    """Insert one measured value."""

    def shown(self) -> list[nodes.Node]:
        """Return the value as text that carries its provenance."""
        lesson_page, _, name = self.text.partition(" ")
        text, origin = measured(lesson_page, name)
        classes = ["measured", *(["measured-list"] if ", " in text else [])]
        return [measured_value(self.rawtext, text, classes=classes, provenance=origin)]


def stored(name: str, compute: Callable[[], T]) -> T:
    """Return the value that an earlier render stored, or compute and store it.

    Args:
        name: of the value.
        compute: its result can be pickled.
    """
    states = page_index().states
    if states is None:
        return compute()
    file = states / sha256(name.encode()).hexdigest()
    with suppress(OSError, EOFError, pickle.UnpicklingError):
        return cast(T, pickle.loads(file.read_bytes()))
    value = compute()
    write_whole(file, pickle.dumps(value))
    return value


@lru_cache(maxsize=64)
def page_run(book: Path, lesson: str, page: str = RECORDED_PAGE) -> PageRun:
    """Return a page's run of this build; it does not change while Sphinx runs.

    A stored state is shown; the build verifies the bundle itself each time.
    """
    folder = page_outputs(f"{lesson}/{page}") / BACKEND
    absent = f"No bundle was recorded for {lesson}/{page}."

    def run() -> PageRun:
        status = bundle_status(folder, lesson, page, absent, book, once=True)
        return PageRun(f"{lesson}/{page}", folder, status)

    return stored(f"{lesson}/{page}", run)


@lru_cache(maxsize=64)
def recorded_runs(book: Path, lesson: str) -> tuple[PageRun, ...]:
    """Return the recorded runs of a lesson's lab, the reference first, recorded or not."""
    folder, name = book / "evidence" / lesson, f"{lesson}/{RECORDED_PAGE}"
    recorded = (path.name for path in recorded_folders(book) if path.parent == folder)

    def run(backend: str) -> PageRun:
        status = recorded_status(book, lesson, backend)
        return PageRun(name, folder / backend, status, recorded=True)

    backends = dict.fromkeys((REFERENCE, *recorded))
    return stored(
        f"{lesson}, recorded", lambda: tuple(run(backend) for backend in backends)
    )


def lesson_statuses(book: Path, lesson: str) -> list[Status]:
    """Return the states of a lesson's lab: of this build on CPU, then of the recorded runs."""
    return [
        run.status for run in (page_run(book, lesson), *recorded_runs(book, lesson))
    ]


class evidence_badge(nodes.inline):  # noqa: N801
    """A state; no markup of a page creates this node, so an imitation is recognized."""


def badge_node(status: Status) -> nodes.Node:
    """Return a state as the site shows it everywhere: one word and its colour."""
    return evidence_badge(
        "", status.badge, classes=["evidence-badge", f"state-{status.state}"]
    )


def state_words(status: Status) -> str:
    """Return the state of a run in a few words; only an accepted run counts as measured."""
    if status.state == "verified" and status.manifest is not None:
        engine = status.manifest.engine.version
        return f"Measured on {READABLE.get(status.backend, status.backend)} with Genesis {engine}"
    return f"{READABLE.get(status.backend, status.backend)} run: {status.state}"


class LessonStatus(SphinxDirective):
    """Show the states of a lesson's runs in one line, and a sentence on each behind it.

    The line leaves out missing runs unless all are missing.
    """

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return the fold; inside it is one line per backend."""
        statuses = lesson_statuses(Path(self.env.srcdir), self.arguments[0])
        known = [status for status in statuses if status.state != "missing"] or statuses
        opening = (
            f'<details class="status-line"><summary>{status_line(known)}</summary>'
        )
        return [
            between("", status_list(statuses), opening=opening, closing="</details>")
        ]


def status_line(statuses: Iterable[Status]) -> str:
    """Return the states of runs as a line of HTML."""
    return " · ".join(
        f'<span class="status-word state-{status.state}">{escape(state_words(status))}</span>'
        for status in statuses
    )


def status_list(statuses: Sequence[Status]) -> nodes.bullet_list:
    """Return the states of runs as a list: the badge and a sentence on each."""
    lines = ((badge_node(status), f" {status.sentence}") for status in statuses)
    return bullets(*lines, classes=["lesson-status"])


class Guard(PageRole):
    """Require that the check which guards the sentence in front of it passed; show nothing."""

    def shown(self) -> list[nodes.Node]:
        """Return nothing."""
        place, _, check = self.text.rpartition(" ")
        require_passed(place or measuring_page(self.env.docname), check)
        return []


def require_passed(lesson_page: str, check: str) -> None:
    """Require that a check of a page passed.

    Raises:
        LookupError: the page has no such check; the message lists those that it has.
        ValueError: the check failed, or the page has no bundle that can be read.
    """
    folder = page_outputs(lesson_page) / BACKEND
    found = {c.name: c for c in bundle.read_manifest(folder).checks}
    if check not in found:
        raise LookupError(
            f"{lesson_page} has no check {check!r}. Choices: {', '.join(found)}."
        )
    if not found[check].passed:
        raise ValueError(
            f"the check {check} of {lesson_page} found {found[check].found}."
        )


class EngineLink(PageRole):
    """Link to the pinned release of the engine, or with `engine-source` to one of its files."""

    def shown(self) -> list[nodes.Node]:
        """Return the link; its text is as given."""
        if self.name == "engine-release":
            target, text = (
                f"releases/tag/v{project.engine_pin()}",
                nodes.Text(self.text),
            )
        else:
            installed = importlib.metadata.distribution("genesis-world")
            if not Path(str(installed.locate_file(f"genesis/{self.text}"))).is_file():
                raise LookupError(
                    f"Genesis {installed.version} has no file genesis/{self.text}"
                )
            target = f"blob/v{project.engine_pin()}/genesis/{self.text}"
            text = nodes.literal(self.text, self.text)
        return [
            nodes.reference(self.rawtext, "", text, refuri=f"{REPOSITORY}/{target}")
        ]


def visit_measured(self: Any, node: measured_value) -> None:
    """Write a value that shows its provenance on hover, focus or touch."""
    provenance = {
        "data-provenance": node["provenance"],
        "aria-description": node["provenance"],
    }
    self.body.append(
        self.starttag(node, "span", "", tabindex="0", role="note", **provenance)
    )


def setup(app: Sphinx) -> None:
    """Register roles, directive and writer."""
    app.add_role("measured", Measured())
    app.add_role("guard", Guard())
    for name in ("engine-source", "engine-release"):
        app.add_role(name, EngineLink())
    app.add_directive("lesson-status", LessonStatus)
    app.add_node(between, html=WRITERS)
    app.add_node(
        measured_value,
        html=(visit_measured, lambda self, _: self.body.append("</span>")),
    )
