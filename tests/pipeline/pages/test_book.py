"""What a book may not contain is refused with file, line and cure before anything is executed."""

import pytest
from tiny_book import LAB_FRONT, cell, make_book, notebook, raising

from robo_genesis.pipeline.pages.book import PageError, find_pages


def test_executed_pages_are_the_notebooks_of_the_table_of_contents(tmp_path):
    lab, lecture = notebook(cell("1"), front=LAB_FRONT), notebook(cell("1"))
    book = make_book(tmp_path, text="# Text\n", lab=lab, lecture=lecture)
    (book / "_parts").mkdir()
    (book / "_parts/outside.md").write_text(notebook(cell("2")))
    (book / "lecture.md").write_bytes(lecture.replace("\n", "\r\n").encode())
    first, second = find_pages(book)
    assert (first.docname, first.path) == ("lab", book / "lab.md")
    assert (first.lesson, first.page, first.declares_bundle) == ("l04", "lab", True)
    assert (second.lesson, second.page, second.declares_bundle) == (None, None, False)
    assert first.code.digests == second.code.digests


BAD = (  # the text of a page, the line that is named, and what is said of it
    (notebook(front="robo_genesis: lab\n"), 1, "{lesson: l04, page: lab}"),
    # tags and options of a cell
    (
        notebook(cell("1", ":tags: [solutions]\n")),
        9,
        "'solutions' is unknown. Valid: after",
    ),
    (notebook(cell("1", ":tag: [solution]\n")), 9, "'tag' is unknown. Valid: tags"),
    (notebook(cell("1", ":tags: [figure]\n")), 9, "a figure needs a text"),
    (notebook(raising("1", None)), 9, "the tag raises-exception needs"),
    (notebook(cell("1", ':expects: "KeyError: a"\n')), 9, "the tag raises-exception"),
    (notebook() + '+++ {"tags": ["solution"]}\n\nText.\n', 8, "'solution' is unknown"),
)


@pytest.mark.parametrize(("text", "line", "said"), BAD)
def test_a_page_is_refused_with_its_line_and_a_cure(tmp_path, text, line, said):
    book = make_book(tmp_path, bad=text)
    with pytest.raises(PageError) as refused:
        find_pages(book)
    where = f"{book}/bad.md:{line}: "
    lines = [each for each in str(refused.value).splitlines() if where in each]
    assert any(said in each for each in lines), refused.value


def test_magics_and_expected_syntax_errors_are_accepted(tmp_path):
    text = notebook(cell("await f()\n%time 1\n!ls"), raising("1 = 2", "SyntaxError"))
    find_pages(make_book(tmp_path, good=text))


def test_one_report_names_all_bad_pages(tmp_path):
    unread = notebook(cell("1", ":tags: [a\n"))
    again = {name: notebook(cell("1"), front=LAB_FRONT) for name in ("first", "second")}
    book = make_book(tmp_path, one=unread, good="# T\n", gone="", **again)
    (book / "gone.md").unlink()
    with pytest.raises(PageError) as refused:
        find_pages(book)
    for said in (
        f"{book}/one.md cannot be read: ",
        f"{book}/gone.md cannot be read: ",
        f"{book}/second.md:1: it declares the lesson and page that {book}/first.md",
    ):
        assert said in str(refused.value)


@pytest.mark.parametrize("text", ["format: [", "root: index\nnoise: 1\n"])
def test_a_bad_table_of_contents_is_refused(tmp_path, text):
    book = make_book(tmp_path)
    (book / "_toc.yml").write_text(text)
    with pytest.raises(PageError, match=r"_toc\.yml cannot be read"):
        find_pages(book)
