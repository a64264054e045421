"""The lessons of the course, from `course_map.yml`: the map, links to lessons, what needs one.

| in a page | shows |
|---|---|
| {course-map} (directive) | published lessons as cards, planned ones as a list of titles |
| {course-map} with :brief: | a short list of the published lessons |
| {featured} L04 (directive) | its content, while the map has this lesson published |
| {lesson}`some words <l04/lab>` | a link to a lesson's page, plain text without that lesson |
"""

from collections.abc import Iterable, Iterator
from functools import partial
from pathlib import Path

import yaml
from docutils import nodes
from docutils.parsers.rst.directives import flag
from pydantic import TypeAdapter, ValidationError
from pydantic.dataclasses import dataclass
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.util.docutils import ReferenceRole

from robo_genesis.core.markup import filled
from robo_genesis.core.text import listed
from robo_genesis.pipeline.pages.book import LAB
from robo_genesis.site.evidence.plain_nodes import late
from robo_genesis.site.pages import PageDirective, PageRole

from .facts import MINUTES
from .sizes import Minutes

FILE = "course_map.yml"

# The pages with a line of their own, besides the lecture.
LINES = {
    "motion": "Lecture, part 2",
    "practice": "Practice",
    LAB: "Lab",
    "capstone": "Capstone",
}


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
        ValueError: the file is not a list of lessons.
    """
    try:
        rows = yaml.safe_load((book / FILE).read_text("utf8"))
        return TypeAdapter(list[Lesson]).validate_python(rows)
    except (yaml.YAMLError, ValidationError) as error:
        raise ValueError(f"{FILE}: {error}") from error


class MapDirective(PageDirective):
    """Base of the directives that read the map."""

    def published(self) -> list[Lesson]:
        """Return the published lessons.

        Raises:
            ValueError: the map is not valid, or the book lacks one of its pages.
        """
        self.env.note_dependency(str(self.book / FILE))
        self.env.note_reread()  # it shows titles, times and pictures of other pages
        lessons = [lesson for lesson in read_map(self.book) if lesson.page]
        if gone := {str(lesson.page) for lesson in lessons} - self.env.found_docs:
            raise ValueError(f"the book has no page {', '.join(sorted(gone))}.")
        return lessons


class Featured(MapDirective):
    """Show content about one lesson while the map has it published, otherwise nothing."""

    required_arguments = 1
    has_content = True

    def shown(self) -> list[nodes.Node]:
        """Return the content; without the lesson it is not even parsed."""
        published = [lesson.id for lesson in self.published()]
        return self.parse_content_to_nodes() if self.arguments[0] in published else []


class LessonLink(PageRole, ReferenceRole):
    """Link to a page of a lesson; without that lesson, the words alone remain."""

    def shown(self) -> list[nodes.Node]:
        """Return the link or the words."""
        lesson, _, page = self.target.partition("/")
        pages = lesson_pages(self.env.found_docs, lesson)
        if not pages:
            return [nodes.Text(self.title)]
        if page not in pages:
            raise LookupError(
                f"{lesson} has no page {page!r}; choices: {', '.join(pages)}."
            )
        place = self.env.app.builder.get_relative_uri(self.env.docname, pages[page])
        return [nodes.reference("", self.title, internal=True, refuri=place)]


def lesson_pages(docnames: Iterable[str], lesson: str) -> dict[str, str]:
    """Return the pages of a lesson by name, from the folder `lessons/l04-…` of a book."""
    paths = [Path(name) for name in sorted(docnames)]
    return {p.name: str(p) for p in paths if p.match(f"lessons/{lesson}-*/*")}


class CourseMap(MapDirective):
    """Show the published lessons as cards, and the planned ones as a list."""

    option_spec = {"brief": flag}  # noqa: RUF012 - as docutils declares it

    def shown(self) -> list[nodes.Node]:
        """Return the place of the map."""
        self.published()
        return [late(make=partial(cards, "brief" in self.options))]


def cards(brief: bool, app: Sphinx, docname: str) -> str:
    """Return the map, when the minutes of all pages and the pictures of replays are known."""
    lessons = read_map(Path(app.srcdir))
    return filled(
        Path(__file__).with_suffix(".html"),
        brief=brief,
        lessons=lessons,
        times=partial(times, app.env),
        pictures=sorted(name for _, name in app.env.images.values()),
        link=partial(app.builder.get_relative_uri, docname),
        up="../" * docname.count("/"),
        listed=listed,
    )


def times(
    env: BuildEnvironment, lesson: str, lecture: str
) -> Iterator[tuple[str, list[str], Minutes]]:
    """Yield (name, pages, minutes) of the lecture, each of `LINES`, and without a name the rest."""
    groups: dict[str, list[str]] = {"Lecture": [lecture]}
    groups |= {words: [] for words in (*LINES.values(), "")}
    for name, page in lesson_pages(env.found_docs, lesson.lower()).items():
        if page != lecture:
            groups[LINES.get(name, "")].append(page)
    for name, pages in groups.items():
        if pages:
            found: list[Minutes] = [env.metadata[page][MINUTES] for page in pages]
            read, work = (
                sum(getattr(time, of) for time in found) for of in ("read", "work")
            )
            yield name, pages, Minutes(read, work, any(time.sheet for time in found))


def setup(app: Sphinx) -> None:
    """Register the directives and the role."""
    app.add_directive("featured", Featured)
    app.add_role("lesson", LessonLink())
    app.add_directive("course-map", CourseMap)
