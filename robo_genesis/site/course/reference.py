"""The page of reference: the tables of calls and of advice that the lessons mark.

In a page of a lesson, ``{.in-reference}`` in the line above a table marks it. The
directive {reference} shows all of them, in a section for each lesson.
"""

from typing import Any

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.transforms.post_transforms import SphinxPostTransform

from .course_map import MapDirective, lesson_pages

MARK = "in-reference"  # The class of such a table
LESSON = "reference_of"  # The attribute of a section that names its lesson


class Reference(MapDirective):
    """Show a section for each published lesson; `CollectTables` fills them."""

    def shown(self) -> list[nodes.Node]:
        """Return the sections with their titles."""
        return [
            nodes.section(
                "",
                nodes.title("", f"{lesson.id}: {lesson.title}"),
                ids=[lesson.id.lower()],
                **{LESSON: lesson.id.lower()},
            )
            for lesson in self.published()
        ]


class CollectTables(SphinxPostTransform):
    """Copy the marked tables of each lesson, whose links then lead from this page."""

    default_priority = 5  # before references are resolved

    def run(self, **kwargs: Any) -> None:
        """Fill the sections."""
        for section in self.document.findall(nodes.section):
            pages = lesson_pages(self.env.found_docs, section.get(LESSON, ""))
            for page in pages.values():
                for table in self.env.get_doctree(page).findall(nodes.table):
                    if MARK in table["classes"]:
                        for link in table.findall(addnodes.pending_xref):
                            link["refdoc"] = self.env.docname
                        section += table


def setup(app: Sphinx) -> None:
    """Register the directive and what fills its sections."""
    app.add_directive("reference", Reference)
    app.add_post_transform(CollectTables)
