"""The course map is one file: what is planned is called so, what is published has its badges."""

import pytest
import yaml
from built_site import LESSON_PAGES, parsed
from tiny_book import make_book

from robo_genesis.build.built_pages import BuiltPages
from robo_genesis.build.site.render import render
from robo_genesis.build.site.sphinx_process import SphinxProcess
from robo_genesis.core.project import BOOK
from robo_genesis.lessons.registry import LESSONS
from robo_genesis.site.course_map import FILE, CourseMapError, Lesson, read_map

MAP = [
    {"id": "L01", "title": "One"},
    {"id": "L02", "title": "Two", "needs": []},
    {"id": "L04", "title": "Four", "needs": ["L01", "L02"], "page": "page", "featured": True},
]


def write(book, rows):
    (book / FILE).write_text(yaml.safe_dump(rows))


def test_the_course_s_map_names_the_lessons_that_are_published():
    published = {lesson.id: lesson.page for lesson in read_map(BOOK) if lesson.page}
    lectures = {name.upper(): LESSON_PAGES[name, "lecture"] for name in LESSONS}
    assert published == lectures


def test_a_map_is_read_in_its_order(tmp_path):
    write(tmp_path, MAP)
    assert read_map(tmp_path) == [
        Lesson("L01", "One"),
        Lesson("L02", "Two", ()),
        Lesson("L04", "Four", ("L01", "L02"), "page", featured=True),
    ]


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ([{"id": "L01"}], "a lesson has id, title"),
        ([{"id": "L01", "title": "One", "state": "verified"}], "a lesson has id, title"),
        (["L01"], "a lesson has id, title"),
        ([MAP[0], MAP[0]], "names L01 twice"),
        ([MAP[0], MAP[2]], "L04 needs L02; before it come L01"),
        ([{"id": "L01", "title": "One", "needs": ["L01"]}], "L01 needs L01; before it come none"),
        ([MAP[2] | {"id": name, "needs": []} for name in ("L04", "L05")], "features L04 and L05"),
    ],
)
def test_a_map_that_cannot_be_right_is_refused(tmp_path, rows, said):
    write(tmp_path, rows)
    with pytest.raises(CourseMapError, match=said):
        read_map(tmp_path)


CARDS = "```{course-map}\n```\n"
FEATURED = """
{lesson}`The second <l02/lecture>` and {lesson}`the
third <l03/lab>`.

:::{featured} L04
Four was measured.
:::

:::{featured} L05
```{glance} l05
```
:::

```{course-status}
```
"""


@pytest.fixture(scope="module")
def html(tmp_path_factory):
    """A book with this map, shown on one page, and lessons of it featured on another."""
    folder = tmp_path_factory.mktemp("map")
    (folder / "book" / "lessons" / "l02-two").mkdir(parents=True)
    pages = {"page": "Page", "lessons/l02-two/lecture": "Two", "cards": f"Map\n\n{CARDS}"}
    pages |= {"featured": f"Map\n\n{FEATURED}"}
    book = make_book(folder, **{name: f"# {text}\n\nText.\n" for name, text in pages.items()})
    write(book, MAP)
    return render(SphinxProcess(book, folder / "render.log"), folder / "staging", BuiltPages())


def test_a_card_a_lesson_with_prerequisites_and_state(html):
    cards = parsed(html, "cards").select("ul.course-map > li")
    lines = [[p.get_text() for p in card.select("p")] for card in cards]
    assert lines == [
        ["L01 One", "planned"],
        ["L02 Two", "Builds on nothing before it.", "planned"],
        ["L04 Four", "Builds on L01 and L02.", "cpu-missing amdgpu-missing"],
    ]
    assert [card["class"] for card in cards] == [["planned"], ["planned"], ["published"]]
    assert [a["href"] for a in cards[2].select("a")] == ["page.html", "#lesson-l01", "#lesson-l02"]
    assert {a["href"][1:] for a in cards[2].select(".needs a")} < {card["id"] for card in cards}


def test_lessons_that_are_absent_leave_words_and_no_content(html):
    article = parsed(html, "featured").article
    _, first, second, *_ = article.select("section > p")
    assert first.get_text() == "The second and the third."
    assert [a["href"] for a in first.select("a")] == ["lessons/l02-two/lecture.html"]
    assert second.get_text() == "Four was measured."
    assert [b.get_text() for b in article.select("section > p > strong")] == ["L04"]
    assert len(article.select("ul.lesson-status > li")) == 2
    assert "L05" not in article.get_text()
