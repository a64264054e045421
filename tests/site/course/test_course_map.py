"""The course map is one file: published lessons become cards with minutes, planned ones a list."""

import re

import pytest
import yaml
from built_site import LESSON_PAGES, parsed

from robo_genesis.core.project import BOOK, ROOT
from robo_genesis.lessons import LESSONS
from robo_genesis.site.course.course_map import FILE, read_map


def test_the_course_s_map_names_the_lessons_that_are_published():
    published = {lesson.id: lesson.page for lesson in read_map(BOOK) if lesson.page}
    lectures = {name.upper(): LESSON_PAGES[name, "lecture"] for name in LESSONS}
    assert published == lectures


@pytest.mark.parametrize(
    ("document", "form"),
    [
        ("README.md", "- **{id}:** {title}\n"),
        ("book/running-a-lab.md", "`{id} <{folder}/lab>`"),
        ("book/troubleshooting.md", "`{id}, "),
        ("book/{page}.md", "\n# {id}: {heading}\n"),
    ],
)
def test_a_published_lesson_is_in_each_list_that_is_kept_by_hand(document, form):
    """A lecture may have the first sentence of its title as heading."""
    missing = []
    for lesson in read_map(BOOK):
        if lesson.page:
            file = document.format(page=lesson.page)
            text = (ROOT / file).read_text()
            words = {
                "id": lesson.id,
                "title": lesson.title,
                "folder": lesson.id.lower(),
            }
            titles = {lesson.title, re.split(r"(?<=[?.]) ", lesson.title)[0]}
            if not any(form.format(heading=title, **words) in text for title in titles):
                line = form.format(heading=lesson.title, **words).strip()
                missing.append(f"{file} lacks {line!r}")
    assert not missing


def test_the_list_of_decision_records_has_each_of_them():
    folder = BOOK / "_decisions"
    titles = {
        p.name: p.read_text().splitlines()[0] for p in sorted(folder.glob("0*.md"))
    }
    rows = re.findall(
        r"\[(\d+)\]\((.+?)\) \| (.+?) \|", (folder / "README.md").read_text()
    )
    assert {name: f"# {number}: {title}" for number, name, title in rows} == titles


def test_a_map_that_is_not_one_of_lessons_is_refused(tmp_path):
    (tmp_path / FILE).write_text(yaml.safe_dump([{"id": "L01"}]))
    with pytest.raises(ValueError, match=r"title\n *Field required"):
        read_map(tmp_path)


def test_a_published_lesson_is_a_card_and_a_planned_one_a_title_without_a_link(
    small_site,
):
    page = parsed(small_site, "cards")
    cards = page.select("ul.course-map > li")
    assert [[p.get_text() for p in card.select("p")] for card in cards] == [
        [
            "L04 Four",
            "read a qpos",
            "stop",
            "Builds on L01 and L02.",
            "Lecture: 1 min to read",
            "The whole lesson: 1 min",
        ],
        [
            "L06 Six",
            "walk",
            "Lecture: 4 min to read",
            "Lab: 15 min with the work sheet",
            "2 more pages: 8 min to read",
            "The whole lesson: 26 min",
        ],
    ]
    pages = ("lecture", "lecture", "lab")
    links = [a["href"] for a in cards[1].select("a")]
    assert links == [f"lessons/l06-six/{name}.html" for name in pages]
    assert cards[0].code.get_text() == "qpos"
    planned = page.select_one("ul.planned-lessons")
    lines = {item["id"]: item.get_text().strip() for item in planned.select("li")}
    assert lines == {"lesson-l01": "L01 One", "lesson-l02": "L02 Two"}
    assert not planned.select("a")


def test_the_brief_map_is_a_list_of_lectures_with_their_minutes(small_site):
    lines = parsed(small_site, "cards").select("ul.lesson-list > li")
    assert [line.get_text() for line in lines] == [
        "L04: Four 1\xa0min",
        "L06: Six 4\xa0min",
    ]
    assert lines[1].a["href"] == "lessons/l06-six/lecture.html"


def test_lessons_that_are_absent_leave_words_and_no_content(small_site):
    article = parsed(small_site, "featured").article
    _, first, second, *_ = article.select("section > p")
    assert first.get_text() == "The second and the third."
    assert [a["href"] for a in first.select("a")] == ["lessons/l02-two/lecture.html"]
    assert second.get_text() == "Four was measured."
    assert [b.get_text() for b in article.select("section > p > strong")] == [
        "L04 ",
        "L06 ",
    ]
    lines = article.select("ul.lesson-status > li")
    assert [line.select_one(".evidence-badge").get_text() for line in lines] == 2 * [
        "cpu-missing",
        "amdgpu-missing",
    ]
    assert (
        article.select_one(".course-measured").get_text()
        == "No run of this build was accepted."
    )
