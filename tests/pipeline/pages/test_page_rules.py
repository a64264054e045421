"""A text that Sphinx would publish without a word, or stop at, is refused with file and line."""

import pytest
from tiny_book import cell, make_book, notebook

from robo_genesis.core.project import BOOK
from robo_genesis.pipeline.pages.book import PageError, find_pages

TAB = "::::{tab-set}\n:::{tab-item} One\n%sIt is 2.\n:::\n::::\n"
BAD = (  # the text of a page below its title, the line that is named, and what is said of it
    ("![A map](gone.svg)", 3, "gone.svg.*: a picture is a file beside the page"),
    ("![A\nmap](https://a.org/b.png)", 3, "a picture is a file"),
    ("```{figure} gone.svg\nIt.\n```", 3, "a picture is a file"),
    (":::{note}\n![](large.png)\n:::", 4, "at most 2,000,000 bytes"),
    ("![A map][map]\n\n[map]: b.png", 3, "a picture is a file"),
    ('<img src="https://a.org/b.png">', 3, "a picture is a file"),
    ("It.\n\n<!-- It is 2. -->", 5, "A comment begins with `% `"),
    ("<details>It is 2.</details>", 3, "belongs in a {dropdown}"),
    ("It.\n\n## 3. Answers\n\nIt is 2.", 5, "has another heading"),
    ("### Worked example: a box", 3, "has another heading"),
    (TAB % "", 4, "a tab without one has"),
    (TAB % ":sync: a\n", 4, "a tab without one has"),
    ("one\u202etwo", 3, "an unseen character"),
    ("one\n\u200btwo", 4, "an unseen character"),
    ("<<<<<<< HEAD", 3, "mark of a merge"),
)
GOOD = (
    "![A map](a%20b.svg) and {figure} or `![]`",
    "```{figure} a%20b.svg\nIt.\n```",
    "## No solution, and how many answers\n\n% It is 2.",
    TAB % ":sync: a\n:class-container: solution\n",
    TAB % ":class-container: wide explanation\n",
    cell("# Answers"),
)


def book_of(folder, text):
    """Return a book with one page of this text, and beside it two pictures."""
    book = make_book(folder, page=text)
    (book / "a b.svg").write_text("<svg/>")
    (book / "large.png").write_bytes(bytes(2_000_001))
    return book


@pytest.mark.parametrize(("text", "line", "said"), BAD)
def test_a_text_is_refused_with_its_line_and_a_cure(tmp_path, text, line, said):
    book = book_of(tmp_path, f"# Title\n\n{text}\n")
    with pytest.raises(PageError, match=rf"^{book}/page\.md:{line}: .*{said}"):
        find_pages(book)


def test_good_texts_and_those_of_the_course_pass(tmp_path):
    for text in GOOD:
        find_pages(book_of(tmp_path, f"(target)=\n# Title\n\n{text}\n"))
    find_pages(BOOK)


@pytest.mark.parametrize("text", ["Words.\n", notebook().replace("# Page", "Page")])
def test_a_page_without_a_title_is_refused(tmp_path, text):
    with pytest.raises(PageError, match=r"page\.md:1: .*a page begins with its title"):
        find_pages(book_of(tmp_path, text))


def test_one_report_has_pages_and_work_sheets(tmp_path):
    book = make_book(tmp_path, page="# Title\n\n<!-- a -->\n\n![](b.svg)\n")
    (book / "lessons/l04").mkdir(parents=True)
    (book / "lessons/l04/worksheet.md").write_text("# Sheet\n\n<!-- a -->\n")
    with pytest.raises(PageError) as refused:
        find_pages(book)
    lines = [line.partition(": ")[0] for line in str(refused.value).splitlines()]
    names = ["page.md:5", "page.md:3", "lessons/l04/worksheet.md:3"]
    assert lines == [f"{book}/{name}" for name in names]
