"""The course map on the home page: ```` ```{course-map} ````.

A published lesson is a card with its outcomes and the minutes of its pages. The planned lessons are
a list of titles.
"""

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment

from robo_genesis.core.text import listed
from robo_genesis.site.course_map import Lesson, MapDirective, lesson_pages, page_link
from robo_genesis.site.evidence.plain_nodes import marked
from robo_genesis.site.page_facts import LAB, Minutes, minutes_of


class page_minutes(nodes.inline):  # noqa: N801 - docutils names nodes in lower case
    """Placeholder for the minutes of pages until all pages are read."""


class CourseMap(MapDirective):
    """Show the published lessons as cards, and the planned ones as a list."""

    def run(self) -> list[nodes.Node]:
        """Return the cards and the list, without the list where no lesson is planned."""
        lessons = self.lessons()
        cards = [self.card(lesson) for lesson in lessons if lesson.page]
        shown: list[nodes.Node] = [nodes.bullet_list("", *cards, classes=["course-map"])]
        if planned := [planned_line(lesson) for lesson in lessons if not lesson.page]:
            shown.append(nodes.paragraph("", "Planned lessons:"))
            shown.append(nodes.bullet_list("", *planned, classes=["planned-lessons"]))
        return shown

    def card(self, lesson: Lesson) -> nodes.list_item:
        """Return the card of a published lesson."""
        assert lesson.page is not None
        title = page_link(self.env.docname, lesson.page, lesson.title)
        outcomes = (nodes.paragraph("", "", *marked(text)) for text in lesson.outcomes)
        return nodes.list_item(
            "",
            nodes.paragraph("", "", nodes.strong("", f"{lesson.id} "), title),
            nodes.bullet_list("", *(nodes.list_item("", line) for line in outcomes)),
            *needs_line(lesson),
            *self.times(lesson, lesson.page),
            ids=[anchor(lesson.id)],
        )

    def times(self, lesson: Lesson, lecture: str) -> list[nodes.Node]:
        """Return a line for the lecture, for the lab, and for the other pages together."""
        pages = lesson_pages(self.env.found_docs, lesson.id.lower())
        others = [page for name, page in pages.items() if name != LAB and page != lecture]
        rows: list[tuple[nodes.Node, list[str]]] = [
            (page_link(self.env.docname, lecture, "Lecture"), [lecture])
        ]
        if LAB in pages:
            rows.append((page_link(self.env.docname, pages[LAB], "Lab"), [pages[LAB]]))
        if others:
            more = "1 more page" if len(others) == 1 else f"{len(others)} more pages"
            rows.append((nodes.Text(more), others))
        return [
            nodes.paragraph(
                "", "", what, nodes.Text(": "), page_minutes(pages=of), classes=["time"]
            )
            for what, of in rows
        ]


def planned_line(lesson: Lesson) -> nodes.list_item:
    """Return the line of a planned lesson: its name and title, without a link."""
    name = nodes.strong("", f"{lesson.id} ")
    line = nodes.paragraph("", "", name, nodes.Text(lesson.title))
    return nodes.list_item("", line, ids=[anchor(lesson.id)])


def needs_line(lesson: Lesson) -> list[nodes.Node]:
    """Return the line with the lessons that come before, none where that is not decided yet."""
    if lesson.needs is None:
        return []
    before = listed(lesson.needs) if lesson.needs else "no other lesson"
    return [nodes.paragraph("", f"Builds on {before}.", classes=["needs"])]


def anchor(lesson: str) -> str:
    """Return the anchor of a lesson on the map."""
    return f"lesson-{lesson.lower()}"


def total_minutes(env: BuildEnvironment, pages: list[str]) -> Minutes:
    """Return the time that some pages take together."""
    found = [minutes_of(env, page) for page in pages]
    read, work = sum(time.read for time in found), sum(time.work for time in found)
    return Minutes(read, work, sheet=any(time.sheet for time in found))


def fill_in(app: Sphinx, document: nodes.document, docname: str) -> None:
    """Write the minutes of the pages, as each page itself shows them."""
    for place in list(document.findall(page_minutes)):
        place.replace_self(nodes.Text(str(total_minutes(app.env, place["pages"]))))


def setup(app: Sphinx) -> None:
    """Register the directive and the later step."""
    app.add_directive("course-map", CourseMap)
    app.add_node(page_minutes)
    app.connect("doctree-resolved", fill_in)
