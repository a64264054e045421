"""Measured numbers and guards in prose: always read from an accepted bundle.

Roles, as pages write them:

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
"""

import importlib.metadata
from html import escape
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx

from robo_genesis.core import project
from robo_genesis.core.text import format_value, listed, quoted, scaled_value
from robo_genesis.evidence.bundle import read_manifest
from robo_genesis.lessons import find_page
from robo_genesis.pipeline.pages.page_index import measuring_page, page_bundle
from robo_genesis.pipeline.pages.values import value_of
from robo_genesis.site.pages import PageRole

from .plain_nodes import WRITERS, between, fill_in, late
from .runs import BACKEND

COUNTED = ("episodes", "cells")  # Units that a page gives to counts
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
    folder = page_bundle(lesson_page)
    manifest = read_manifest(folder)
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


class Measured(PageRole):
    """Insert one measured value, which shows its provenance on hover, focus or touch."""

    def shown(self) -> list[nodes.Node]:
        """Return the value as text that carries its provenance."""
        lesson_page, _, name = self.text.partition(" ")
        text, origin = measured(lesson_page, name)
        kind = "measured measured-list" if ", " in text else "measured"
        words = escape(origin)
        opening = (
            f'<span aria-description="{words}" class="{kind}" data-provenance="{words}" '
            'role="note" tabindex="0">'
        )
        return [between("", nodes.Text(text), opening=opening, closing="</span>")]


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
    folder = page_bundle(lesson_page)
    checks = {record.name: record for record in read_manifest(folder).checks}
    if check not in checks:
        raise LookupError(
            f"{lesson_page} has no check {check!r}. Choices: {', '.join(checks)}."
        )
    if not checks[check].passed:
        raise ValueError(
            f"the check {check} of {lesson_page} found {checks[check].found}."
        )


class EngineLink(PageRole):
    """Link to the pinned release of the engine, or with `engine-source` to one of its files."""

    def shown(self) -> list[nodes.Node]:
        """Return the link; its text is as given."""
        if self.name == "engine-release":
            target = f"releases/tag/v{project.engine_pin()}"
            text: nodes.Node = nodes.Text(self.text)
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


def setup(app: Sphinx) -> None:
    """Register roles and writers."""
    app.add_role("measured", Measured())
    app.add_role("guard", Guard())
    for name in ("engine-source", "engine-release"):
        app.add_role(name, EngineLink())
    app.add_node(between, html=WRITERS)
    app.add_node(late)
    app.connect("doctree-resolved", fill_in)
