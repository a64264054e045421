"""Refuses markup of a page that only a run may create."""

from collections.abc import Iterator, Set
from pathlib import Path

from bs4 import BeautifulSoup
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util import logging

from robo_genesis.site.evidence.measured import evidence_badge, measured_value
from robo_genesis.site.evidence.origin import above, cell_of

# Class → the nodes that may have it while a page is read, and the alternative for a
# page.
OURS: dict[str, tuple[type[nodes.Element] | tuple[()], str]] = {
    "evidence-badge": (evidence_badge, "Use {lesson-status}."),
    "status-line": ((), "Use {lesson-status}."),
    "status-word": ((), "Use {lesson-status}."),
    "measured": (measured_value, "Use {measured}."),
    "provenance": (
        (),
        "The build writes that line below each figure and measured table.",
    ),
}

# Elements that, as raw HTML, would have no line of provenance and no row in the ledger.
PICTURES = ("img", "picture")

logger = logging.getLogger(__name__)


def refuse(app: Sphinx, doctree: nodes.document) -> None:
    """Warn about each problem of a page; a warning fails the build."""
    env = app.env
    for node, problem in problems(doctree, Path(env.srcdir)):
        place = next((n for n in (node, *above(node)) if n.line), env.docname)
        logger.warning(problem, location=place)


def problems(
    doctree: nodes.document, book: Path
) -> Iterator[tuple[nodes.Element, str]]:
    """Yield each node that imitates a result of a run or avoids its check, with the reason.

    Args:
        doctree: a page as it was read, before the lines of provenance.
        book: the folder of the pages.
    """
    for node in doctree.findall(nodes.Element):
        found = [
            *_imitated(node, set(node.get("classes", ()))),
            *_past_its_check(node, book),
        ]
        if isinstance(node, nodes.raw):
            html = BeautifulSoup(node.astext(), "html.parser")
            written = {
                name for tag in html.find_all(class_=True) for name in tag["class"]
            }
            found += [*_imitated(None, written), *_raw(node, html)]
        for problem in dict.fromkeys(found):
            yield node, problem


def _imitated(node: nodes.Element | None, written: Set[str]) -> Iterator[str]:
    """Yield the problems of the classes of a node, or of raw HTML, where `node` is None."""
    for name, (made, instead) in OURS.items():
        if name in written and not (node is not None and isinstance(node, made)):
            yield f"a page may not set the class {name}: only the build sets it. {instead}"


def _past_its_check(node: nodes.Element, book: Path) -> Iterator[str]:
    recorded = (book / "evidence").resolve()  # links are followed
    if isinstance(node, nodes.image) and (book / node["uri"]).resolve().is_relative_to(
        recorded
    ):
        yield (
            f"the picture {node['uri']} lies below evidence/, where it may be stale. "
            "Use the {evidence} directive: it shows only accepted bundles."
        )


def _raw(node: nodes.Element, html: BeautifulSoup) -> Iterator[str]:
    made, of_page = cell_of(node) is not None, html.find_all(PICTURES)
    where, instead = "the page has", "Use the {figure} directive."
    if made:
        where, instead = (
            "a cell outputs",
            "Display Markdown (robo_genesis.core.tables) or a figure.",
        )
    for name in sorted({tag.name for tag in (html.find_all() if made else of_page)}):
        yield f"{where} <{name}> as raw HTML, which would have no line in the ledger. {instead}"
