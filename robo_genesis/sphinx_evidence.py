"""Measured numbers and lesson states in prose: always read from an accepted bundle.

Roles and directive, as pages write them:

| in a page | shows |
|---|---|
| {measured}`l04/lab G2.overshoot` | a metric, written with its unit |
| {measured}`l04/lab engine` | the engine version that the page ran on |
| {engine-source}`engine/scene.py` | a file of the engine, linked to the pinned release |
| {engine-release}`some words` | the pinned release |
| {lesson-state}`l04` | the state of a lesson on CPU, in a word |
| {lesson-status} l04 (directive) | what was run for a lesson, and its state |
"""

import importlib.metadata
import os
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective, SphinxRole

from robo_genesis import l04, project
from robo_genesis.evidence import bundle
from robo_genesis.evidence.status import page_status, recorded_status
from robo_genesis.metrics import format_value

BUILD_OUTPUTS = "ROBO_GENESIS_BUILD_OUTPUTS"
BACKEND = l04.MINIMUM_HARDWARE
REFERENCE = "amdgpu"
REPOSITORY = "https://github.com/Genesis-Embodied-AI/genesis-world"


def outputs_folder() -> Path:
    """Return the folder of this build's bundles, which the build names in the environment."""
    return Path(os.environ[BUILD_OUTPUTS])


def measured(lesson_page: str, name: str) -> tuple[str, str]:
    """Return (text, provenance) of one measured value.

    Args:
        lesson_page: `l04/lab`.
        name: `group.metric` of its metrics.json, or `engine`.

    Raises:
        LookupError: there is no such metric; the message lists those there are.
        BundleRefused: the bundle cannot be read.
    """
    folder = outputs_folder() / lesson_page / BACKEND
    predicate = bundle.read_manifest(folder).predicate
    origin = f"Measured by {lesson_page} on {BACKEND}, Genesis {predicate.engine.version}, "
    origin += f"run {predicate.run_id[:8]}, {predicate.started[:10]}"
    if name == "engine":
        return predicate.engine.version, origin
    group, _, metric = name.partition(".")
    records = bundle.read_metrics(folder)
    if metric not in records.get(group, {}):
        known = ", ".join(f"{g}.{m}" for g, items in records.items() for m in items)
        raise LookupError(f"{lesson_page} has no metric {name!r}. Known: {known}.")
    record = records[group][metric]
    text = str(record.value) if group == "model" else format_value(record.value, record.unit)
    return text, f"{origin}, from {', '.join(record.source)}"


class measured_value(nodes.inline):  # noqa: N801 - docutils names nodes in lower case
    """A measured value in prose; its attribute `provenance` says where it comes from."""


class Measured(SphinxRole):
    """Insert one measured value; an unknown one is an error of the build."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        """Return the value as text that carries its provenance."""
        lesson_page, _, name = self.text.partition(" ")
        try:
            text, origin = measured(lesson_page, name)
        except (LookupError, bundle.BundleRefused) as error:
            message = self.inliner.reporter.error(f"measured: {error}", line=self.lineno)
            return [], [message]
        node = measured_value(self.rawtext, text, classes=["measured"], provenance=origin)
        return [node], []


class LessonStatus(SphinxDirective):
    """Say what was run for a lesson: the state of its lab on CPU and on the reference backend."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return one line a backend."""
        lesson = self.arguments[0]
        book = Path(self.env.srcdir)
        cpu = page_status(outputs_folder(), lesson, "lab", BACKEND, book)
        reference = recorded_status(book, lesson, REFERENCE)
        lines = nodes.bullet_list(classes=["lesson-status", f"status-{cpu.state}"])
        for status in (cpu, reference):
            lines += nodes.list_item("", nodes.paragraph("", status.sentence))
        return [lines]


class LessonState(SphinxRole):
    """Say in a word what state a lesson's lab is in on CPU."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        """Return state and backend."""
        book = Path(self.env.srcdir)
        status = page_status(outputs_folder(), self.text, "lab", BACKEND, book)
        return [nodes.inline(self.rawtext, f"{status.state} ({status.backend})")], []


class EngineSource(SphinxRole):
    """Link to a file of the engine at the pin; a path that it does not have is an error."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        """Return the link, its text the path."""
        installed = importlib.metadata.distribution("genesis-world")
        if not Path(str(installed.locate_file(f"genesis/{self.text}"))).is_file():
            message = f"engine-source: Genesis {installed.version} has no file genesis/{self.text}"
            return [], [self.inliner.reporter.error(message, line=self.lineno)]
        target = f"{REPOSITORY}/blob/v{project.engine_pin()}/genesis/{self.text}"
        literal = nodes.literal(self.text, self.text)
        return [nodes.reference(self.rawtext, "", literal, refuri=target)], []


class EngineRelease(SphinxRole):
    """Link to the pinned release of the engine."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        """Return the link, its text as given."""
        target = f"{REPOSITORY}/releases/tag/v{project.engine_pin()}"
        return [nodes.reference(self.rawtext, self.text, refuri=target)], []


def visit_measured(self: Any, node: measured_value) -> None:
    """Write a value that shows its provenance on hover, focus or touch."""
    provenance = {"data-provenance": node["provenance"], "aria-description": node["provenance"]}
    self.body.append(self.starttag(node, "span", "", tabindex="0", role="note", **provenance))


def depart_measured(self: Any, node: measured_value) -> None:
    """Close the element."""
    self.body.append("</span>")


def setup(app: Sphinx) -> dict[str, Any]:
    """Register role, directive and their writer."""
    app.add_role("measured", Measured())
    app.add_role("lesson-state", LessonState())
    app.add_role("engine-source", EngineSource())
    app.add_role("engine-release", EngineRelease())
    app.add_directive("lesson-status", LessonStatus)
    app.add_node(measured_value, html=(visit_measured, depart_measured))
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
