"""Refuses what a page writes by itself and only a run may say or show."""

import os
from collections.abc import Iterator, Set
from pathlib import Path

from bs4 import BeautifulSoup
from docutils import nodes
from myst_nb.ext.glue.utils import PendingGlueReference
from sphinx.application import Sphinx
from sphinx.util import logging

from robo_genesis.site.evidence.measured import evidence_badge, measured_value
from robo_genesis.site.evidence.origin import above, origin

OURS: dict[str, tuple[type[nodes.Element] | tuple[()], str]] = {
    "evidence-badge": (evidence_badge, "Use {lesson-status} or {lesson-state}."),
    "measured": (measured_value, "Use {measured}."),
    "provenance": ((), "The build writes that line below each figure and measured table."),
}
"""Class → the nodes that may carry it while a page is read, and what to do instead."""

PICTURES = ("img", "picture")
SHOWN = (*PICTURES, "table", "svg", "canvas", "video", "object", "embed", "iframe")
"""Elements that show something; as raw HTML they would have neither line nor row."""

logger = logging.getLogger(__name__)


def refuse(app: Sphinx, doctree: nodes.document) -> None:
    """Make each problem of a page that was read an error of the build."""
    env = app.env
    for node, problem in problems(doctree, Path(env.srcdir)):
        place = next((n for n in (node, *above(node)) if n.line), env.docname)
        logger.warning(problem, location=place)


def problems(doctree: nodes.document, book: Path) -> Iterator[tuple[nodes.Element, str]]:
    """Yield each node that imitates what a run made or shows it past its check, and why not.

    Args:
        doctree: a page as it was read, before the lines of provenance.
        book: the folder of the pages.
    """
    for node in doctree.findall(nodes.Element):
        found = [*_imitated(node, set(node.get("classes", ()))), *_past_its_check(node, book)]
        if isinstance(node, nodes.raw):
            html = BeautifulSoup(node.astext(), "html.parser")
            written = {name for tag in html.find_all(class_=True) for name in tag["class"]}
            found += [*_imitated(None, written), *_raw(node, html)]
        for problem in dict.fromkeys(found):
            yield node, problem


def _imitated(node: nodes.Element | None, written: Set[str]) -> Iterator[str]:
    """Yield what is wrong with the classes of a node, or of raw HTML, where `node` is None."""
    for name, (made, instead) in OURS.items():
        if name in written and not (node is not None and isinstance(node, made)):
            yield f"a page may not set the class {name}: it follows from a run. {instead}"


def _past_its_check(node: nodes.Element, book: Path) -> Iterator[str]:
    if isinstance(node, nodes.image) and _is_evidence(node["uri"], book):
        yield (
            f"the picture {node['uri']} lies below evidence/, where it may be stale. "
            "Use the {evidence} directive: it shows accepted bundles alone."
        )
    if isinstance(node, PendingGlueReference):
        yield (
            f"{node.key} is glued from the page {node.refdoc}, and nothing would say so. "
            "Glue it there, or insert a metric of its bundle by {measured}."
        )


def _raw(node: nodes.Element, html: BeautifulSoup) -> Iterator[str]:
    in_cell = origin(node, None) is not None
    for name in sorted({tag.name for tag in html.find_all(SHOWN if in_cell else PICTURES)}):
        mend = (
            "Display Markdown (robo_genesis.core.tables) or a figure."
            if in_cell
            else "Use the {figure} directive."
        )
        what = "a cell puts out" if in_cell else "the page holds"
        yield f"{what} <{name}> as raw HTML, which would have no line in the ledger. {mend}"


def _is_evidence(uri: str, book: Path) -> bool:
    """Whether a picture lies where recorded bundles do, as it is written or as links lead."""
    path, folder = book / uri, book / "evidence"
    normal = Path(os.path.normpath(path))
    return normal.is_relative_to(folder) or path.resolve().is_relative_to(folder.resolve())


def register(app: Sphinx) -> None:
    """Register the pass, before lines of provenance are added."""
    app.connect("doctree-read", refuse, priority=890)
