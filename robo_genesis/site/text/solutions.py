"""With `SOLUTIONS=0`, pages, search index and executed notebooks have no solutions and answers.

The pages' sources, which contain them, are not published. A question that the page
itself marks keeps its feedback. A page whose run is itself an answer has no outputs, and
its bundle cannot be downloaded. Otherwise a page of a lesson can be printed without
answers; `print.css` leaves them out.
"""

from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.config import Config
from sphinx.transforms import SphinxTransform
from sphinx.util import logging

from robo_genesis.core.project import solutions_shown
from robo_genesis.pipeline.pages.page_rules import NO_SOLUTION, SOLUTION

# The second is the class that a code cell has from its tag.
MARKS = {SOLUTION, f"tag_{SOLUTION}"}
EXPLANATION = "explanation"  # The class of a fold that a site without solutions keeps

ANSWER = "capstone"  # A page whose run is the course's own answer

# What a click shows: directives, and a class of others.
FOLDS = {"dropdown", "toggle"}
UNMARKED = (
    f"a fold does not say whether it is a solution. Add `:class-container: {SOLUTION}`, or "
    f"`{EXPLANATION}` if a site without solutions may show it."
)

# What the button does that prints a page without answers.
PRINT = (
    "document.body.classList.add('no-answers');"
    "window.addEventListener('afterprint', () => document.body.classList"
    ".remove('no-answers'), { once: true }); print()"
)

logger = logging.getLogger(__name__)


def classes_of(node: nodes.Element) -> list[str]:
    """Return the classes of an element, and those of a dropdown's container."""
    return [*node["classes"], *node.get("container_classes", ())]


def answer_left_out(page: str | None) -> bool:
    """Return whether the run of a page, by its last name, is an answer that is not shown."""
    return page == ANSWER and not solutions_shown()


class RequireMarks(SphinxTransform):
    """Warn of each fold that neither is marked as a solution nor as an explanation."""

    default_priority = 199

    def apply(self, **kwargs: object) -> None:
        """Look at dropdowns and toggles."""
        for node in self.document.findall(nodes.Element):
            classes = classes_of(node)
            folds = FOLDS.intersection([node.get("design_component"), *classes])
            marked = {SOLUTION, EXPLANATION}.intersection(classes)
            if folds and not marked:
                logger.warning(UNMARKED, location=node)


class LeaveOutSolutions(SphinxTransform):
    """Remove what is marked as a solution, before anything refers to it."""

    default_priority = 200

    def apply(self, **kwargs: object) -> None:
        """Remove them from the page; the outputs of cells below a solution follow from it."""
        page = self.document.settings.env.docname.rpartition("/")[2]
        left_out = MARKS | ({"cell_output"} if answer_left_out(page) else set())
        for node in [*self.document.findall(nodes.Element)]:
            classes = classes_of(node)
            if left_out.intersection(classes):
                note = nodes.paragraph("", "", nodes.emphasis("", NO_SOLUTION))
                node.parent.replace(node, [note] if "cell" in classes else [])


def hide_sources(app: Sphinx, config: Config) -> None:
    """Publish no page's source."""
    config.html_copy_source = False
    config.html_theme_options["use_download_button"] = False  # it leads to the source


def offer_print(
    app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: Any
) -> None:
    """Add to the downloads of a lesson's page, the theme's print among them, our print."""
    for group in context["header_buttons"]:
        if page.startswith("lessons/") and group["label"] == "download-buttons":
            words = {"text": ".pdf without answers", "tooltip": "Print without answers"}
            kind = {
                "type": "javascript",
                "javascript": PRINT,
                "icon": "fas fa-file-pdf",
            }
            group["buttons"].append(words | kind | {"label": "print-without-answers"})


def setup(app: Sphinx) -> None:
    """Register what requires marks and, if solutions are not shown, leaves them out."""
    app.add_transform(RequireMarks)
    # After the theme, which makes the group.
    app.connect("html-page-context", offer_print, priority=900)
    if not solutions_shown():
        app.add_transform(LeaveOutSolutions)
        app.connect("config-inited", hide_sources)
