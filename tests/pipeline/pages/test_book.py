"""What a book may not contain is refused with file, line and cure before anything is executed."""

import pytest
from tiny_book import LAB_FRONT, cell, make_book, notebook, raising

from robo_genesis.pipeline.pages.book import PACKAGE, PageError, find_pages


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
OPENED = cell('page = rg.open_page("l04", "lab")')
BAD = (  # the text of a page, the line that is named, and what is said of it
    # its front matter
    (notebook(front="robo_genesis: {lesson: l04}\n"), 1, "{lesson: l04, page: lab}"),
    (notebook(front="robo_genesis: lab\n"), 1, "{lesson: l04, page: lab}"),
    (
        notebook(front="robo_genesis: {lesson: l04, page: lab, alone: true}\n"),
        1,
        "page: lab}",
    ),
    (notebook(front="execution: {allow_errors: true}\n"), 1, "publish failing cells"),
    ("---\nfile_format: mystnb\n---\n# No kernel\n", 1, "the kernel is None"),
    (
        notebook().replace("python3", "ir"),
        1,
        "the kernel is 'ir'. Valid is `kernelspec: {name: py",
    ),
    (
        notebook().replace("{name: python3}", "python3"),
        3,
        "'python3' is not of type 'object'",
    ),
    (notebook(front="title: [a\n"), 4, "cannot be read"),
    ("---\ntitle: x\n\n# T\n", 1, "the front matter has no end"),
    ("# T\n\n```{code-cell}\n1\n```\n", 3, "the page begins with a front matter that"),
    (f"\n{notebook(cell('1'))}", 10, "the page begins with a front matter that"),
    (notebook(OPENED), 10, "opens l04/lab, which the front matter does not declare"),
    (
        notebook(OPENED, front="robo_genesis: {lesson: l04, page: more}\n"),
        11,
        "opens l04/lab, wh",
    ),
    # tags, options and code of a cell
    (
        notebook(cell("1", ":tags: [solutions]\n")),
        9,
        "the tag 'solutions' is unknown. Is it so",
    ),
    (
        notebook(cell("1", ":tags: [skip-execution]\n")),
        9,
        "unknown. Valid: after-yours, alone",
    ),
    (notebook(cell("1", ":tags: solution\n")), 10, "'solution' is not of type 'array'"),
    (
        notebook(cell("1", ":tag: [solution]\n")),
        9,
        "the option 'tag' is unknown. Is it tags",
    ),
    (
        notebook(cell("1", ":tags: [solution]\n:tags: [inputs]\n")),
        9,
        "the cell has tags twice",
    ),
    (notebook(cell("1", ":tags: [a\n")), 9, "cannot be read"),
    (
        notebook(cell("1", ":mystnb: {code_prompt_show: A solution}\n")),
        9,
        "is behind 'A solution'",
    ),
    (notebook(cell("1", ":mystnb: 1\n")), 9, "mystnb is 1. Valid is a mapping"),
    (notebook(cell("1", ":tags: [figure]\n")), 9, "a figure needs a text"),
    (
        notebook(cell("1", ":tags: [raises-exception]\n")),
        9,
        "the tag raises-exception needs",
    ),
    (
        notebook(cell("1", ':expects: "KeyError: a"\n')),
        9,
        "the tag raises-exception needs",
    ),
    (
        notebook(cell("one = 1\ntwo = = 2", ":tags: [inputs]\n")),
        12,
        "SyntaxError: invalid syntax",
    ),
    (
        notebook() + '+++ {"tags": ["solution"]}\n\nText.\n',
        8,
        "the tag 'solution' is unknown",
    ),
    # solutions
    (
        fold("One possible solution"),
        3,
        "{dropdown} “One possible solution” does not say whether",
    ),
    (
        fold("More", ":class-container: solutions\n"),
        3,
        "Add `:class-container: solution`, or `e",
    ),
    *(
        (fold("", kind=kind), 3, "does not say")
        for kind in ("toggle", "solution-start")
    ),
    (
        fold("Model answer", kind="admonition"),
        3,
        "does not say whether it is a solution. Add",
    ),
    (fold("Look", ":class: tip dropdown\n", "admonition"), 3, "does not say"),
    ("# T\n\n::::{tab-set}\n:::{tab-item} Answer\nIt.\n:::\n::::\n", 4, "does not say"),
    ("# T\n\n- a\n\n  ```{dropdown} Answer\n  It.\n  ```\n", 5, "does not say"),
    ("# T\n\n<details>\nIt.\n</details>\n", 3, "nothing leaves out '<details'"),
    ("# T\n\nThe [answer]{.solution}.\n", 3, "nothing leaves out '{.solution'"),
    (
        "# T\n\n<p class='a toggle'>It.</p>\n",
        3,
        'nothing leaves out "class=\'a toggle" with',
    ),
    ("# T\n\n```{include} other.md\n```\n", 3, "no rule reads what {include} does"),
    ("# T\n\nIt is {glue:text}`x`.\n", 3, "{glue} shows a value away from its cell"),
    # blocks without an end
    *(
        (f"# T\n\n{block}\nx\n", 3, f"the block {block} has no end")
        for block in ("```python", "~~~", ":::{note}", ":::")
    ),
    ("# T\n\n> ```\n> x\n\nText.\n", 3, "the block ``` has no end"),
    ("# T\n\n- a\n\n  ```\n  x\n- b\n", 5, "the block ``` has no end"),
    (
        "# T\n\n:::{note}\n:::{tip}\nx\n:::\n:::\n",
        3,
        "the block :::{note} has no end of its own",
    ),
    ("# T\n\n````{note}\n```\nx\n````\n", 4, "the block ``` has no end"),
    (
        notebook(cell("1")) + "\n```{code-cell}\n1\n",
        13,
        "the block ```{code-cell} has no end",
    ),
    (
        notebook() + fold("Answer", f"{MARKED}{cell('1')}"),
        10,
        "the block :::{dropdown} Answer has",
    ),
    (
        notebook() + f"````{{note}}\n{cell('1')}````\n",
        10,
        "nothing runs this code cell",
    ),
    ("# T\n\n$$\nx = 1\n\nText.\n", 3, "begins with $$ is not closed"),
    # what no editor shows
    (
        "# T\n<<<<<<< HEAD\n",
        2,
        "the mark <<<<<<< of a merge conflict. Keep one version",
    ),
    ("# T\n\nTitle\n=======\nText.\n", 4, "the mark ======= of a merge conflict"),
    ("\ufeff# T\n", 1, "the character U+FEFF. Remove it; save as UTF-8 without BOM"),
    ("# T\n\na\0b\n", 3, "U+0000"),
    ("# T\n\na\u2028b\n", 3, "U+2028"),
    ("# T\ra\n", 1, "U+000D"),
    ("# T\n\né\n".encode("latin1"), 3, "the byte 0xe9 is not UTF-8"),
    ("# T\n".encode("utf16"), 1, "the byte 0xff is not UTF-8"),
)


@pytest.mark.parametrize(("text", "line", "said"), BAD)
def test_a_page_is_refused_with_its_line_and_a_cure(tmp_path, text, line, said):
    book = make_book(tmp_path, bad="")
    (book / "bad.md").write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(PageError) as refused:
        find_pages(book)
    where = f"{book}/bad.md:{line}: "
    found = [of for of in str(refused.value).splitlines() if of.startswith(where)]
    assert any(said in of for of in found), refused.value


GOOD = (
    fold("Answer", MARKED),
    fold("Answer", ":class-container: explanation\n"),
    fold("Answer", ":class: tip solution\n", "admonition"),
    fold("A tip", kind="admonition"),
    "# T\n\n> ```\n> x\n> ```\n\n- a\n\n  ~~~\n  x\n  ~~~\n- b\n\n```python\n```\n",
    "# T\n\n````\n```{dropdown}\n```\n````\n\n`<details>` costs `$$`, $$x$$\n\n$$\nx\n$$ (eq)\n",
    "# T\n\n::::{note}\n:::{tip}\nx\n:::\n::::\n",
    notebook(cell("await f()\n%time 1\n!ls"), raising("1 = 2", "SyntaxError")),
)


@pytest.mark.parametrize("text", GOOD)
def test_what_looks_like_a_mistake_and_is_none_is_accepted(tmp_path, text):
    find_pages(make_book(tmp_path, good=text))


def test_one_report_names_all_bad_pages(tmp_path):
    unread, incomplete = (
        notebook(cell("1", ":tags: [a\n")),
        notebook(front="robo_genesis: lab\n"),
    )
    again = {name: notebook(cell("1"), front=LAB_FRONT) for name in ("first", "second")}
    book = make_book(
        tmp_path, one=unread, two=incomplete, good="# T\n", gone="", **again
    )
    (book / "gone.md").unlink()
    for name in ("draft.MD", "draft.ipynb"):
        (book / name).touch()
    (book / "worksheet.md").write_text(fold("Answer", MARKED) + "\n```\n")
    with pytest.raises(PageError) as refused:
        find_pages(book)
    said = (
        "no line of _toc.yml names this file",
        "there is no ",
        f"as {book}/first.md does",
    )
    assert all(each in str(refused.value) for each in said)
    places = {
        of.partition(": ")[0]
        for of in str(refused.value).splitlines()
        if "/book/" in of
    }
    names = "draft.MD:1 draft.ipynb:1 worksheet.md:3 worksheet.md:8 one.md:9 two.md:1 second.md:4"
    assert places == {f"{book}/{name}" for name in (*names.split(), "_toc.yml:5")}


GLOBS = "format: jb-book\nroot: index\nchapters:\n- glob: '*'\n"
LACKING = "format: jb-book\nroot: index\nchapters:\n- file: {}\n"
TWICE = "format: jb-book\nroot: index\nchapters:\n- file: a\n- file: a\n"


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        *(
            ("_toc.yml", text, ":1: it cannot be read")
            for text in ("format: [", "- a list\n", "")
        ),
        ("_toc.yml", LACKING.format("gone"), ":4: there is no "),
        ("_toc.yml", LACKING.format("../book/index"), ":4: there is no "),
        ("_toc.yml", "root: index\nnoise: 1\n", ":1: it cannot be read"),
        ("_toc.yml", TWICE, ":1: it cannot be read"),
        ("_toc.yml", GLOBS, "List every page"),
        ("_toc.yml", "root: index\n=======\n", ":2: the file has the mark ======="),
        (
            "_config.yml",
            "title: a\nauthor: b: c\n",
            ":2: it cannot be read: mapping values are not",
        ),
        ("a.svg", "<svg>\n<path></svg>", ":2: it cannot be read: mismatched tag"),
        ("b.svg", '<svg fill="none" stroke="#123456"/>', ":1: the drawing has #123456"),
        ("c.svg", '<svg fill="red"/>', ":1: the drawing has red. A page draws in"),
    ],
)
def test_a_bad_contents_configuration_or_drawing_is_refused_at_once(
    tmp_path, name, text, said
):
    book = make_book(tmp_path)
    (book / name).write_text(text)
    with pytest.raises(PageError, match=f"{name}.*{said}"):
        find_pages(book)


@pytest.mark.parametrize(
    "place", ["course_map.yml", "_static/own.css", "a.svg", PACKAGE]
)
def test_each_file_that_a_site_is_made_from_is_examined(tmp_path, monkeypatch, place):
    book = make_book(tmp_path)
    path = book / place
    if place == PACKAGE:
        monkeypatch.setattr("robo_genesis.pipeline.pages.book.ROOT", tmp_path)
        path = tmp_path / PACKAGE / "lessons/l07/text.py"
        path.parent.mkdir(parents=True)
    path.write_text("\n>>>>>>> theirs\n")
    with pytest.raises(
        PageError, match=f"{path.name}:2: the file has the mark >>>>>>>"
    ):
        find_pages(book)
