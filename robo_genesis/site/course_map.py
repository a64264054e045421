"""The map of the course, from `course_map.yml`: each lesson, what it builds on, and its state.

A page shows it with ```` ```{course-map} ````. A lesson with a page has the badges of its evidence;
one without is planned.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml
from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robo_genesis.site.evidence.measured import badge_node, lesson_statuses

FILE = "course_map.yml"


class CourseMapError(Exception):
    """The map cannot be used; the message says which line of it and why."""


@dataclass(frozen=True, slots=True)
class Lesson:
    """One lesson; `needs` None where it is not decided yet, `page` None while it is planned."""

    id: str
    title: str
    needs: tuple[str, ...] | None = None
    page: str | None = None


def read_map(book: Path) -> list[Lesson]:
    """Return the lessons of a book's map in their order.

    Raises:
        CourseMapError: the file is not a list of lessons, an id stands twice, or a lesson needs one
            that does not come before it.
    """
    rows = yaml.safe_load((book / FILE).read_text("utf8"))
    lessons: list[Lesson] = []
    for row in rows if isinstance(rows, list) else [rows]:
        try:
            needs = row.get("needs")
            lesson = Lesson(**row | {"needs": None if needs is None else tuple(needs)})
        except (AttributeError, TypeError) as error:
            message = f"{FILE} has {row!r}; a lesson has id, title and perhaps needs and page."
            raise CourseMapError(message) from error
        known = [earlier.id for earlier in lessons]
        if lesson.id in known:
            raise CourseMapError(f"{FILE} names {lesson.id} twice.")
        unknown = [need for need in lesson.needs or () if need not in known]
        if unknown:
            raise CourseMapError(
                f"{FILE}: {lesson.id} needs {', '.join(unknown)}; before it come "
                f"{', '.join(known) or 'none'}."
            )
        lessons.append(lesson)
    return lessons


class CourseMap(SphinxDirective):
    """Show the lessons as a list of cards."""

    def run(self) -> list[nodes.Node]:
        """Return the list; a map that cannot be used, or a page that is not there, is an error."""
        book = Path(self.env.srcdir)
        self.env.note_dependency(str(book / FILE))
        try:
            lessons = read_map(book)
        except (CourseMapError, OSError, yaml.YAMLError) as error:
            raise self.error(f"course-map: {error}") from error
        gone = [x.page for x in lessons if x.page and x.page not in self.env.found_docs]
        if gone:
            raise self.error(f"course-map: the book has no page {', '.join(gone)}.")
        return [nodes.bullet_list("", *map(self.card, lessons), classes=["course-map"])]

    def card(self, lesson: Lesson) -> nodes.list_item:
        """Return what stands on one lesson's card."""
        name = nodes.strong("", f"{lesson.id} ")
        head = nodes.paragraph("", "", name, self.title(lesson))
        state = nodes.paragraph("", "", *self.verdict(lesson), classes=["state"])
        kind = "published" if lesson.page else "planned"
        parts = [head, *needs_line(lesson), state]
        return nodes.list_item("", *parts, classes=[kind], ids=[anchor(lesson.id)])

    def title(self, lesson: Lesson) -> nodes.Node:
        """Return the title, of a published lesson as a link."""
        text = nodes.inline("", lesson.title)
        if lesson.page is None:
            return text
        return addnodes.pending_xref(
            "", text, reftype="doc", refdomain="std", refdoc=self.env.docname, refexplicit=True,
            reftarget=f"/{lesson.page}", refwarn=True,
        )  # fmt: skip

    def verdict(self, lesson: Lesson) -> list[nodes.Node]:
        """Return the badges of a published lesson, a word for a planned one."""
        if lesson.page is None:
            return [nodes.inline("", "planned", classes=["planned"])]
        shown: list[nodes.Node] = []
        for status in lesson_statuses(Path(self.env.srcdir), lesson.id.lower()):
            shown += [badge_node(status), nodes.Text(" ")]
        return shown[:-1]


def needs_line(lesson: Lesson) -> list[nodes.Node]:
    """Return the line that says which lessons come before, none where that is not decided yet."""
    if lesson.needs is None:
        return []
    line = nodes.paragraph(classes=["needs"])
    line += nodes.Text("Builds on ")
    for number, need in enumerate(lesson.needs):
        line += nodes.Text((", ", " and ")[number == len(lesson.needs) - 1] if number else "")
        line += nodes.reference("", need, internal=True, refid=anchor(need))
    line += nodes.Text("." if lesson.needs else "nothing before it.")
    return [line]


def anchor(lesson: str) -> str:
    """Return the anchor of a lesson's card."""
    return f"lesson-{lesson.lower()}"


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive."""
    app.add_directive("course-map", CourseMap)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
