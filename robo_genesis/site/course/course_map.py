"""The lessons of the course, from `course_map.yml`: the map, links to lessons, what needs one.

| in a page | shows |
|---|---|
| {course-map} (directive) | published lessons as cards, planned ones as a list of titles |
| {featured} L04 (directive) | its content, while the map has this lesson published |
| {lesson}`some words <l04/lab>` | a link to a lesson's page, plain text without that lesson |
"""

import fnmatch
import re
from collections.abc import Iterable
from pathlib import Path

import yaml
from docutils import nodes
from pydantic import TypeAdapter, ValidationError
from pydantic.dataclasses import dataclass
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment

from robo_genesis.core.text import listed
from robo_genesis.pipeline.pages.book import LAB
from robo_genesis.site.course.facts import MINUTES
from robo_genesis.site.course.sizes import Minutes
from robo_genesis.site.evidence.plain_nodes import bullets, html, marked, paragraph
from robo_genesis.site.pages import PageDirective, PageRole

FILE = "course_map.yml"

# A link to a lesson's page: its words, the lesson and the page.
LINK = re.compile(r"(.+?)\s*<(l\d\d)/([a-z][\w-]*)>", re.DOTALL)


@dataclass(frozen=True, slots=True, config={"extra": "forbid"})
class Lesson:
    """One lesson.

    `needs` is None where it is not decided yet. `page` is the lecture, None while the
    lesson is planned. `outcomes` is what a student can do after a published lesson,
    with code in backticks.
    """

    id: str
    title: str
    needs: tuple[str, ...] | None = None
    page: str | None = None
    outcomes: tuple[str, ...] = ()


def read_map(book: Path) -> list[Lesson]:
    """Return the lessons of a book's map in their order.

    Raises:
        ValueError: the file is not a list of lessons, or a lesson needs one that does
            not come before it.
    """
    try:
        rows = yaml.safe_load((book / FILE).read_text("utf8"))
        lessons = TypeAdapter(list[Lesson]).validate_python(rows)
    except (yaml.YAMLError, ValidationError) as error:
        raise ValueError(f"{FILE}: {error}") from error
    for place, lesson in enumerate(lessons):
        known = [earlier.id for earlier in lessons[:place]]
        unknown = [need for need in lesson.needs or () if need not in known]
        if unknown:
            raise ValueError(
                f"{FILE}: {lesson.id} needs {', '.join(unknown)}; before it come "
                f"{', '.join(known) or 'none'}."
            )
    return lessons


class MapDirective(PageDirective):
    """Base of the directives that read the map."""

    def lessons(self) -> list[Lesson]:
        """Return the lessons.

        Raises:
            ValueError: the map is not valid, or the book lacks one of its pages.
        """
        book = Path(self.env.srcdir)
        self.env.note_dependency(str(book / FILE))
        self.env.note_reread()  # it shows titles, times and pictures of other pages
        lessons = read_map(book)
        gone = [x.page for x in lessons if x.page and x.page not in self.env.found_docs]
        if gone:
            raise ValueError(f"the book has no page {', '.join(gone)}.")
        return lessons


class Featured(MapDirective):
    """Show content about one lesson while the map has it published, otherwise nothing."""

    required_arguments = 1
    has_content = True

    def shown(self) -> list[nodes.Node]:
        """Return the content; without the lesson it is not even parsed."""
        published = [lesson.id for lesson in self.lessons() if lesson.page]
        return self.parse_content_to_nodes() if self.arguments[0] in published else []


class LessonLink(PageRole):
    """Link to a page of a lesson; without that lesson, the words alone remain."""

    def shown(self) -> list[nodes.Node]:
        """Return the link or the words."""
        found = LINK.fullmatch(self.text)
        if found is None:
            raise ValueError(
                f"{self.text!r} is not a link; write `some words <l04/lecture>`."
            )
        words, lesson, page = found.groups()
        pages = lesson_pages(self.env.found_docs, lesson)
        if not pages:
            return [nodes.Text(words)]
        if page not in pages:
            raise LookupError(
                f"{lesson} has no page {page!r}; choices: {', '.join(pages)}."
            )
        return [page_link(self.env.docname, pages[page], words)]


def lesson_pages(docnames: Iterable[str], lesson: str) -> dict[str, str]:
    """Return the pages of a lesson by name, from the folder `lessons/l04-…` of a book."""
    paths = [Path(name) for name in sorted(docnames)]
    return {p.name: str(p) for p in paths if p.match(f"lessons/{lesson}-*/*")}


def page_link(source: str, target: str, words: str) -> nodes.Node:
    """Return a link from one page to another."""
    return addnodes.pending_xref(
        "",
        nodes.inline("", words, classes=["std", "std-doc"]),
        reftype="doc",
        refdomain="std",
        refdoc=source,
        refexplicit=True,
        reftarget=f"/{target}",
        refwarn=True,
    )


class page_minutes(nodes.inline):  # noqa: N801 - docutils names nodes in lower case
    """Placeholder for the minutes of pages until all pages are read."""


class card_picture(nodes.inline):  # noqa: N801 - docutils names nodes in lower case
    """Placeholder for the picture of a lesson's first replay until all pages are read."""


class CourseMap(MapDirective):
    """Show the published lessons as cards, and the planned ones as a list."""

    def shown(self) -> list[nodes.Node]:
        """Return the cards and the list, without the list where no lesson is planned."""
        lessons = self.lessons()
        cards = [self.card(lesson, lesson.page) for lesson in lessons if lesson.page]
        lists: list[nodes.Node] = [
            nodes.bullet_list("", *cards, classes=["course-map"])
        ]
        planned = [
            nodes.list_item("", named(lesson, lesson.title), ids=[anchor(lesson.id)])
            for lesson in lessons
            if not lesson.page
        ]
        if planned:
            lists.append(nodes.paragraph("", "Planned lessons:"))
            lists.append(nodes.bullet_list("", *planned, classes=["planned-lessons"]))
        return lists

    def card(self, lesson: Lesson, lecture: str) -> nodes.list_item:
        """Return the card of a published lesson."""
        title = page_link(self.env.docname, lecture, lesson.title)
        card = nodes.list_item("", card_picture(lesson=lesson.id.lower()))
        card += [named(lesson, title), bullets(*map(marked, lesson.outcomes))]
        if lesson.needs is not None:
            before = listed(lesson.needs) if lesson.needs else "no other lesson"
            card += nodes.paragraph("", f"Builds on {before}.", classes=["needs"])
        card += self.times(lesson, lecture)
        card["ids"] = [anchor(lesson.id)]
        return card

    def times(self, lesson: Lesson, lecture: str) -> list[nodes.Node]:
        """Return a line for the lecture, for the lab, and for the other pages together."""
        pages = lesson_pages(self.env.found_docs, lesson.id.lower())
        lab = pages.pop(LAB, None)
        others = [page for page in pages.values() if page != lecture]
        lines = [
            (page_link(self.env.docname, page, word), [page])
            for word, page in (("Lecture", lecture), ("Lab", lab))
            if page
        ]
        if others:
            words = f"{len(others)} more page{'s' * (len(others) > 1)}"
            lines.append((nodes.Text(words), others))
        return [
            paragraph(words, ": ", page_minutes(pages=names), classes=["time"])
            for words, names in lines
        ]


def named(lesson: Lesson, title: str | nodes.Node) -> nodes.paragraph:
    """Return a line of a lesson's name and title."""
    return paragraph(nodes.strong("", f"{lesson.id} "), title)


def anchor(lesson: str) -> str:
    """Return the anchor of a lesson on the map."""
    return f"lesson-{lesson.lower()}"


def total_minutes(env: BuildEnvironment, pages: list[str]) -> Minutes:
    """Return the time that some pages take together."""
    times: list[Minutes] = [env.metadata[page][MINUTES] for page in pages]
    read, work = sum(time.read for time in times), sum(time.work for time in times)
    return Minutes(read, work, sheet=any(time.sheet for time in times))


def fill_in(app: Sphinx, document: nodes.document, docname: str) -> None:
    """Write the minutes of the pages, as each page itself shows them, and the pictures of cards."""
    names = sorted(name for _, name in app.env.images.values())
    up = "../" * docname.count("/")
    for place in list(document.findall(card_picture)):
        lesson = place["lesson"]
        pictures = fnmatch.filter(names, f"replay-{lesson}-lecture-cpu*.webp")[:1]
        alt = f"{lesson.upper()}: the start of its replay."
        images = [f'<img src="{up}_images/{name}" alt="{alt}">' for name in pictures]
        place.replace_self([*map(html, images)])
    for place in list(document.findall(page_minutes)):
        place.replace_self(nodes.Text(str(total_minutes(app.env, place["pages"]))))


def setup(app: Sphinx) -> None:
    """Register the directives, the role and the later step."""
    app.add_directive("featured", Featured)
    app.add_role("lesson", LessonLink())
    app.add_directive("course-map", CourseMap)
    app.add_node(page_minutes)
    app.add_node(card_picture)
    app.connect("doctree-resolved", fill_in)
