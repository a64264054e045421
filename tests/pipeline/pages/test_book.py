import pytest
from tiny_book import LAB_FRONT, cell, make_book, notebook

from robo_genesis.pipeline.pages.book import PageError, find_pages


def test_executed_pages_are_the_notebooks_of_the_table_of_contents(tmp_path):
    lab, lecture = notebook(cell("1"), front=LAB_FRONT), notebook(cell("1"))
    book = make_book(tmp_path, text="# Text\n", lab=lab, lecture=lecture)
    (book / "outside.md").write_text(notebook(cell("2")))
    first, second = find_pages(book)
    assert (first.docname, first.path) == ("lab", book / "lab.md")
    assert (first.lesson, first.page, first.declares_bundle) == ("l04", "lab", True)
    assert (second.lesson, second.page, second.declares_bundle) == (None, None, False)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (notebook(front="robo_genesis: {lesson: l04}\n"), "lesson: l04, page: lab"),
        (notebook(front="robo_genesis: lab\n"), "lesson: l04, page: lab"),
        (notebook(front="robo_genesis: {lesson: l04, page: lab, alone: true}\n"), "page: lab"),
        ("---\nfile_format: mystnb\n---\n# No kernel\n", "kernelspec"),
        (notebook(cell("1", ":tags: [a\n")), r"cannot be read: .*\n(.*\n)*Correct .*bad\.md"),
        (notebook(front="title: [a\n"), "cannot be read"),
    ],
)
def test_a_bad_page_is_refused_with_its_name(tmp_path, text, reason):
    with pytest.raises(PageError, match=rf"^bad: .*{reason}"):
        find_pages(make_book(tmp_path, bad=text))


def test_one_report_names_all_bad_pages(tmp_path):
    unread, incomplete = notebook(cell("1", ":tags: [a\n")), notebook(front="robo_genesis: lab\n")
    with pytest.raises(PageError, match=r"(?s)^one: ((?!good).)*\ntwo: ((?!good).)*$"):
        find_pages(make_book(tmp_path, one=unread, good=notebook(cell("1")), two=incomplete))


GLOBS = "format: jb-book\nroot: index\nchapters:\n- glob: '*'\n"
LACKING = "format: jb-book\nroot: index\nchapters:\n- file: gone\n"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        *((text, "contents .*_toc.yml cannot be read") for text in ("format: [", "- a list\n", "")),
        ("root: index\nnoise: 1\n", "contents .*_toc.yml cannot be read"),
        (GLOBS, "List every page"),
        (LACKING, "names 'gone'"),
    ],
)
def test_a_bad_table_of_contents_is_refused(tmp_path, text, reason):
    book = make_book(tmp_path)
    (book / "_toc.yml").write_text(text)
    with pytest.raises(PageError, match=reason):
        find_pages(book)
