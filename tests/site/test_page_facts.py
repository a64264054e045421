"""Reading time and history of a page; what is not known is not made up."""

import subprocess

import pytest
from bs4 import BeautifulSoup
from docutils.core import publish_doctree
from tiny_book import make_book

from robo_genesis.build.render import render
from robo_genesis.site import page_facts as facts

WHO = ("-c", "user.name=A", "-c", "user.email=a@example.org", "-c", "commit.gpgsign=false")


def git(folder, *arguments):
    done = subprocess.run(
        ["git", "-C", str(folder), *WHO, *arguments], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr


def commit(folder, text, subject):
    (folder / "page.md").write_text(text)
    git(folder, "add", "page.md")
    git(folder, "commit", "-m", subject)


@pytest.fixture
def checkout(tmp_path):
    folder = tmp_path / "checkout"
    folder.mkdir()
    git(folder, "init", "-q")
    commit(folder, "one", "First <words>")
    commit(folder, "two", "Second words")
    return folder


@pytest.fixture(autouse=True)
def forget():
    facts._why_unknown.cache_clear()


def test_words_of_code_tables_and_formulas_do_not_count():
    text = "Title\n=====\n\nThree words here.\n\n::\n\n  not these\n\n=== ===\nnor the\n=== ===\n"
    assert facts.count_words(publish_doctree(text)) == 4


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (0, "About 1 min to read: 0 words of text at 200 a minute"),
        (500, "About 2 min to read: 500 words of text"),
        (9000, "About 45 min to read: 9,000 words of text"),
    ],
)
def test_minutes_follow_from_words(words, said):
    assert facts.reading_time(words).startswith(said)


def test_history_is_git_s_newest_first(checkout):
    found = facts.history(checkout / "page.md")
    assert [subject for _, subject in found.commits] == ["Second words", "First <words>"]
    assert (found.unknown, found.changed) == ("", False)
    days = BeautifulSoup(facts.history_html(found), "html.parser").select("time")
    assert [day["datetime"] for day in days] == [day for day, _ in found.commits]


def test_subjects_are_text_not_markup(checkout):
    html = facts.history_html(facts.history(checkout / "page.md"))
    assert "First &lt;words&gt;" in html


def test_a_change_in_no_commit_is_said(checkout):
    (checkout / "page.md").write_text("three")
    found = facts.history(checkout / "page.md")
    assert found.changed
    assert "changes that are in no commit yet" in facts.history_html(found)


def test_only_the_latest_are_listed(checkout):
    for number in range(facts.COMMITS):
        commit(checkout, f"{number}", f"Change {number}")
    assert len(facts.history(checkout / "page.md").commits) == facts.COMMITS


def test_a_page_in_no_commit_has_no_history(checkout):
    (checkout / "new.md").touch()
    assert facts.history(checkout / "new.md").unknown == "The page is in no commit yet."


def test_a_shallow_clone_knows_no_history(checkout, tmp_path):
    git(tmp_path, "clone", "-q", "--depth=1", checkout.as_uri(), "shallow")
    found = facts.history(tmp_path / "shallow" / "page.md")
    assert found.commits == ()
    assert "shallow clone" in found.unknown


def test_without_a_checkout_or_git_it_is_not_known(tmp_path, checkout, monkeypatch):
    assert "Git knows no history" in facts.history(tmp_path / "page.md").unknown
    facts._why_unknown.cache_clear()
    monkeypatch.setenv("PATH", "")
    found = facts.history(checkout / "page.md")
    assert "Git is not installed" in found.unknown
    assert "Not known." in facts.history_html(found)


def test_both_stand_on_a_page_and_the_home_page_has_no_time(tmp_path):
    book = make_book(tmp_path, page="# Page\n\nSome words.\n")
    html = render(book, tmp_path / "staging", tmp_path / "cache", tmp_path / "render.log")
    page, home = (
        BeautifulSoup((html / f"{name}.html").read_text(), "html.parser")
        for name in ("page", "index")
    )
    assert (
        page.select_one("article h1")
        .find_next_sibling("p")
        .get_text()
        .startswith("About 1 min to read: 3 words")
    )
    assert not home.select(".page-facts")
    for parsed in (page, home):
        assert "Git knows no history" in parsed.select_one("details.page-history").get_text()


def test_a_page_is_described_by_its_first_paragraph(tmp_path):
    text = "# Page\n\n- no paragraph\n\nA joint's *step* & more. " + "word " * 100
    book = make_book(tmp_path, page=text)
    html = render(book, tmp_path / "staging", tmp_path / "cache", tmp_path / "render.log")
    page = BeautifulSoup((html / "page.html").read_text(), "html.parser")
    (tag,) = page.select('meta[name="description"]')
    assert tag["content"].startswith("A joint’s step & more. word")
    assert tag["content"].endswith("word …")
    assert len(tag["content"]) <= facts.DESCRIPTION
