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


def fold(first: str, options: str = "", kind: str = "dropdown") -> str:
    return f"# T\n\n:::{{{kind}}} {first}\n{options}In it.\n:::\n"


MARKED = ":class-container: solution\n"
BAD = (  # the text of a page, the line that is named, and what is said of it
    (notebook(front="robo_genesis: {lesson: l04}\n"), 1, "{lesson: l04, page: lab}"),
    (notebook(front="robo_genesis: lab\n"), 1, "{lesson: l04, page: lab}"),
    (notebook(front="title: [a\n"), 4, "cannot be read"),
    # tags and options of a cell
    (
        notebook(cell("1", ":tags: [solutions]\n")),
        9,
        "'solutions' is unknown. Is it so",
    ),
    (notebook(cell("1", ":tags: [skip-execution]\n")), 9, "unknown. Valid: after"),
    (notebook(cell("1", ":tag: [solution]\n")), 9, "'tag' is unknown. Is it tags"),
    (notebook(cell("1", ":tags: [a\n")), 9, "cannot be read"),
    (notebook(cell("1", ":tags: [figure]\n")), 9, "a figure needs a text"),
    (notebook(raising("1", None)), 9, "the tag raises-exception needs"),
    (notebook(cell("1", ':expects: "KeyError: a"\n')), 9, "the tag raises-exception"),
    (notebook() + '+++ {"tags": ["solution"]}\n\nText.\n', 8, "'solution' is unknown"),
    # solutions
    (fold("One more"), 3, "{dropdown} “One more” does not say whether"),
    (fold("More", ":class-container: solutions\n"), 3, "solution`, or `explanation`"),
    (fold("", kind="toggle"), 3, "does not say"),
    (fold("Look", ":class: tip dropdown\n", "admonition"), 3, "does not say"),
    ("# T\n\n- a\n\n  ```{dropdown} Answer\n  It.\n  ```\n", 5, "does not say"),
    # blocks without an end
    ("# T\n\n:::{note}\nx\n", 3, "the block :::{note} has no end"),
    ("# T\n\n```python\nx\n", 3, "the block ```python has no end"),
    ("# T\n\n:::{note}\n:::{tip}\nx\n:::\n:::\n", 3, "the block :::{note} has no end"),
    (notebook(cell("1")) + "\n```{code-cell}\n1\n", 13, "{code-cell} has no end"),
    (notebook() + fold("A", f"{MARKED}{cell('1')}"), 10, "block :::{dropdown} A has"),
)


@pytest.mark.parametrize(("text", "line", "said"), BAD)
def test_a_page_is_refused_with_its_line_and_a_cure(tmp_path, text, line, said):
    book = make_book(tmp_path, bad=text)
    with pytest.raises(PageError) as refused:
        find_pages(book)
    where = f"{book}/bad.md:{line}: "
    lines = [each for each in str(refused.value).splitlines() if where in each]
    assert any(said in each for each in lines), refused.value


GOOD = (
    fold("Answer", MARKED),
    fold("Answer", ":class-container: explanation\n"),
    fold("Answer", ":class: tip solution\n", "admonition"),
    fold("A tip", kind="admonition"),
    "# T\n\n> ```\n> x\n> ```\n\n- a\n\n  ~~~\n  x\n  ~~~\n- b\n\n```python\n```\n",
    "# T\n\n````\n```{dropdown}\n```\n````\n",
    "# T\n\n::::{note}\n:::{tip}\nx\n:::\n::::\n",
    notebook(cell("await f()\n%time 1\n!ls"), raising("1 = 2", "SyntaxError")),
)


@pytest.mark.parametrize("text", GOOD)
def test_what_looks_like_a_mistake_and_is_none_is_accepted(tmp_path, text):
    find_pages(make_book(tmp_path, good=text))


def test_one_report_names_all_bad_pages(tmp_path):
    unread = notebook(cell("1", ":tags: [a\n"))
    again = {name: notebook(cell("1"), front=LAB_FRONT) for name in ("first", "second")}
    book = make_book(tmp_path, one=unread, good="# T\n", gone="", **again)
    (book / "gone.md").unlink()
    (book / "draft.ipynb").touch()
    with pytest.raises(PageError) as refused:
        find_pages(book)
    report = str(refused.value)
    for place in (
        "draft.ipynb:1: no line of _toc.yml names",
        "one.md:9: ",
        "_toc.yml:4: there is no ",
        f"second.md:4: the front matter declares l04/lab, as {book}/first.md does",
    ):
        assert f"{book}/{place}" in report


GLOBS = "format: jb-book\nroot: index\nchapters:\n- glob: '*'\n"
TWICE = "format: jb-book\nroot: index\nchapters:\n- file: a\n- file: a\n"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("format: [", ":1: it cannot be read"),
        ("root: index\nnoise: 1\n", ":1: it cannot be read"),
        (TWICE, ":1: it cannot be read"),
        (GLOBS, "List every page"),
    ],
)
def test_a_bad_table_of_contents_is_refused(tmp_path, text, said):
    book = make_book(tmp_path)
    (book / "_toc.yml").write_text(text)
    with pytest.raises(PageError, match=f"_toc.yml.*{said}"):
        find_pages(book)
