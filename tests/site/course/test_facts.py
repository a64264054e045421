"""Reading time, history and description of a page; an unknown history is not invented."""

import pytest
from bs4 import BeautifulSoup
from built_site import parsed
from docutils import nodes
from docutils.core import publish_doctree
from tiny_book import git

from robo_genesis.site.course import facts
from robo_genesis.site.text.question_nodes import question


def history(file):
    return BeautifulSoup(facts.history_html(file), "html.parser")


def test_words_of_code_tables_and_formulas_do_not_count():
    text = "Title\n=====\n\nThree words here.\n\n::\n\n  not these\n\n=== ===\nnor the\n=== ===\n"
    assert facts.count_words(publish_doctree(text)) == 4


@pytest.mark.parametrize(
    ("counted", "shown"),
    [
        ((1, 0), "1 min to read"),
        ((45, 16), "61 min (45 to read, 16 for code and questions)"),
        ((6, 61, True), "65 min with the work sheet"),
    ],
)
def test_minutes_are_shown_with_their_parts(counted, shown):
    assert str(facts.Minutes(*counted)) == shown


def code(text, *tags):
    cell = nodes.container(nb_element="cell_code", cell_metadata={"tags": [*tags]})
    source = nodes.container("", nodes.literal_block(text, text), nb_element="cell_code_source")
    cell += nodes.container("", source)  # a fold is a further node around the code
    cell += nodes.container("", nodes.literal_block("7", "7"), nb_element="cell_code_output")
    return cell


def test_work_is_in_visible_code_questions_functions_and_a_lab_s_work_sheet(tmp_path):
    document = publish_doctree("Text.\n\n::\n\n  typed = 1\n")
    document += [code("a\n\nb"), code("c", "hide-input"), code("d", "inputs"), question()]
    document += code("def f():\n    raise NotImplementedError")
    lab, work = tmp_path / "lab.md", facts.work_minutes(5, 1, 1, sheet=False)
    assert work == 0.5 + facts.MINUTES_A_QUESTION + facts.MINUTES_A_FUNCTION + facts.MINUTES_A_RUN
    assert facts.count_minutes(document, lab) == facts.Minutes(1, round(work))
    (tmp_path / "worksheet.md").touch()
    sheet = facts.Minutes(1, round(work + facts.MINUTES_A_SHEET), sheet=True)
    assert facts.count_minutes(document, lab) == sheet
    assert not facts.count_minutes(document, tmp_path / "lecture.md").sheet


def test_history_is_the_latest_commits_and_uncommitted_changes_or_the_reason_why_there_is_none(
    tmp_path,
):
    checkout = tmp_path / "checkout"
    git(tmp_path, "init", "-q", "checkout")
    page = checkout / "page.md"
    for subject in ("First <words>", "Second words"):
        page.write_text(subject)
        git(checkout, "add", "page.md")
        git(checkout, "commit", "-q", "-m", subject)
    items = history(page).select("li")
    assert [item.get_text().split(" ", 1)[1] for item in items] == ["Second words", "First <words>"]
    assert not history(page).select("p")
    page.write_text("three")
    assert history(page).p.get_text() == "The page has changes that are in no commit yet."
    git(tmp_path, "clone", "-q", "--depth=1", checkout.as_uri(), "shallow")
    (checkout / "new.md").touch()
    for file, reason in (
        (checkout / "new.md", "The page is in no commit yet."),
        (tmp_path / "shallow" / "page.md", "a shallow clone, which has no history."),
        (tmp_path / "page.md", "There was no Git, or no Git history of this page"),
    ):
        assert reason in history(file).p.get_text()
        assert not history(file).select("li")


def test_a_page_has_all_three_and_the_home_page_no_time(small_site):
    page, home = parsed(small_site, "described"), parsed(small_site, "index")
    assert "About 1 min to read." in page.select_one("h1 + p.page-facts").get_text()
    assert not home.select(".page-facts")
    assert "no Git history" in home.select_one("details.page-history").get_text()
    (tag,) = page.select('meta[name="description"]')
    assert tag["content"].startswith("A joint’s step & more. word")
    assert tag["content"].endswith("word …")
    assert len(tag["content"]) <= facts.DESCRIPTION


def test_a_row_shows_rounded_times_and_the_slowest_cell(small_site):
    table = parsed(small_site, "times").select_one("tbody")
    assert [[c.get_text(strip=True) for c in row.select("td")] for row in table.select("tr")] == [
        ["Page", "3", "15.6", "2", "12.3"],
        ["Other", "1", "2.0", "1", "2.0"],
    ]
