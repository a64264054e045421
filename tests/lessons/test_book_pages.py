from pathlib import Path

import pytest
from tiny_book import LAB_FRONT, cell, make_book, notebook

from robo_genesis.core.project import ROOT
from robo_genesis.lessons.book_pages import (
    PageError,
    cell_sources,
    code_digest,
    find_pages,
    fingerprint,
    imported_modules,
)


@pytest.fixture
def root(tmp_path):
    """A checkout with a package of five modules; `used` reaches `deep` by a relative import."""
    package = tmp_path / "robo_genesis"
    (package / "evidence").mkdir(parents=True)
    sources = {
        "__init__.py": "",
        "used.py": "import numpy\nfrom robo_genesis.evidence import record\n",
        "sphinx_ext.py": "import robo_genesis.used\n",
        "evidence/__init__.py": "",
        "evidence/record.py": "def f():\n    from .deep import g\n    from .. import lazy\n",
        "evidence/deep.py": "",
        "lazy.py": "",
    }
    for name, text in sources.items():
        (package / name).write_text(text)
    (tmp_path / "requirements.lock").write_text("numpy==2.0\n")
    return tmp_path


@pytest.fixture
def pages(root):
    code = "%matplotlib inline\nfrom robo_genesis.used import thing"
    return find_pages(make_book(root, lab=notebook(cell(code), front=LAB_FRONT)))


def test_executed_pages_are_the_notebooks_of_the_table_of_contents(tmp_path):
    book = make_book(tmp_path, text="# Text\n", lab=notebook(cell("1"), front=LAB_FRONT))
    (book / "outside.md").write_text(notebook(cell("2")))
    (page,) = find_pages(book)
    assert (page.docname, page.lesson, page.page) == ("lab", "l04", "lab")
    assert page.declares_bundle
    assert page.path == book / "lab.md"


def test_a_page_without_declaration_leaves_no_bundle(tmp_path):
    (page,) = find_pages(make_book(tmp_path, lecture=notebook(cell("1"))))
    assert (page.lesson, page.page, page.declares_bundle) == (None, None, False)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (notebook(front="robo_genesis: {lesson: l04}\n"), "lesson: l04, page: lab"),
        (notebook(front="robo_genesis: {lesson: ../x, page: lab}\n"), "plain words"),
        (notebook(front="robo_genesis: lab\n"), "lesson: l04, page: lab"),
        (notebook(front="execution: {allow_errors: true}\n"), "allow_errors"),
        ("---\nfile_format: mystnb\n---\n# No kernel\n", "kernelspec"),
    ],
)
def test_bad_front_matter_is_refused_with_the_page(tmp_path, text, reason):
    with pytest.raises(PageError, match=reason) as caught:
        find_pages(make_book(tmp_path, bad=text))
    assert str(caught.value).startswith("bad: ")


@pytest.mark.parametrize(
    "text",
    [
        notebook(cell("1", ":tags: [a\n")),
        notebook(front="title: [a\n"),
        notebook(cell("1", ":load: no_such_file.py\n")),
    ],
    ids=["cell header", "front matter", "loaded file"],
)
def test_a_page_that_cannot_be_read_is_refused_with_its_name(tmp_path, text):
    with pytest.raises(
        PageError, match=r"^bad: the page cannot be read: .*\n(.*\n)*Mend .*bad\.md"
    ):
        find_pages(make_book(tmp_path, bad=text))


def test_all_bad_pages_stand_in_one_report(tmp_path):
    unread, incomplete = notebook(cell("1", ":tags: [a\n")), notebook(front="robo_genesis: lab\n")
    with pytest.raises(PageError) as caught:
        find_pages(make_book(tmp_path, one=unread, good=notebook(cell("1")), two=incomplete))
    report = str(caught.value)
    assert report.startswith("one: ")
    assert "\ntwo: " in report
    assert "good" not in report


@pytest.mark.parametrize("text", ["format: [", "- a list\n", "root: index\nnoise: 1\n", ""])
def test_a_broken_table_of_contents_is_refused_with_its_path(tmp_path, text):
    book = make_book(tmp_path)
    (book / "_toc.yml").write_text(text)
    with pytest.raises(PageError, match=f"contents {book / '_toc.yml'} cannot be read"):
        find_pages(book)


def test_a_missing_page_is_refused(tmp_path):
    book = make_book(tmp_path, gone="# Gone\n")
    (book / "gone.md").unlink()
    with pytest.raises(PageError, match=r"names 'gone'"):
        find_pages(book)


def test_globs_are_refused(tmp_path):
    book = make_book(tmp_path)
    (book / "_toc.yml").write_text("format: jb-book\nroot: index\nchapters:\n- glob: '*'\n")
    with pytest.raises(PageError, match="name every page"):
        find_pages(book)


def test_imports_are_followed_through_functions_and_relative_names(root, pages):
    modules = imported_modules(cell_sources(pages[0]), root)
    assert sorted(modules) == [
        "robo_genesis",
        "robo_genesis.evidence",
        "robo_genesis.evidence.deep",
        "robo_genesis.evidence.record",
        "robo_genesis.lazy",
        "robo_genesis.used",
    ]


def test_a_cell_that_does_not_parse_imports_nothing(root):
    assert imported_modules(["def ("], root) == {}


@pytest.mark.parametrize(
    "changed", ["used.py", "evidence/deep.py", "lazy.py", "evidence/data.json"]
)
def test_a_changed_line_in_an_imported_module_is_another_fingerprint(root, pages, changed):
    before = fingerprint(pages, root, {})
    with (root / "robo_genesis" / changed).open("a") as file:
        file.write("# one line\n")
    assert fingerprint(pages, root, {}) != before


def test_a_module_that_no_page_imports_does_not_count(root, pages):
    before = fingerprint(pages, root, {})
    (root / "robo_genesis" / "sphinx_ext.py").write_text("# another\n")
    assert fingerprint(pages, root, {}) == before


@pytest.mark.parametrize(
    ("name", "value"),
    [("ROBO_GENESIS_RENDER", "0"), ("ROBO_GENESIS_BACKEND", "auto"), ("QD_FAST_MATH", "0")],
)
def test_what_the_environment_asks_for_counts(root, pages, name, value):
    assert fingerprint(pages, root, {name: value}) != fingerprint(pages, root, {})


@pytest.mark.parametrize("name", ["HOME", "QD_OFFLINE_CACHE_FILE_PATH"])
def test_a_variable_that_changes_no_measurement_does_not_count(root, pages, name):
    assert fingerprint(pages, root, {name: "/elsewhere"}) == fingerprint(pages, root, {})


def test_the_lock_counts(root, pages):
    before = fingerprint(pages, root, {})
    (root / "requirements.lock").write_text("numpy==2.1\n")
    assert fingerprint(pages, root, {}) != before


def test_another_version_of_any_installed_package_counts(root, pages, monkeypatch):
    before = fingerprint(pages, root, {})
    monkeypatch.setattr(
        "robo_genesis.lessons.book_pages.installed_packages", lambda: ["mujoco==0.1"]
    )
    assert fingerprint(pages, root, {}) != before


def test_the_python_version_counts(root, pages, monkeypatch):
    before = fingerprint(pages, root, {})
    monkeypatch.setattr("platform.python_version", lambda: "3.99.0")
    assert fingerprint(pages, root, {}) != before


def test_the_code_digest_ignores_prose(tmp_path):
    texts = [notebook(cell("1")), notebook(cell("1"), title="Other"), notebook(cell("2"))]
    digests = []
    for number, text in enumerate(texts):
        (page,) = find_pages(make_book(tmp_path / str(number), page=text))
        digests.append(code_digest(page))
    assert digests[0] == digests[1] != digests[2]


def test_site_modules_are_not_part_of_what_the_course_pages_compute():
    book = ROOT / "book"
    sources = [source for page in find_pages(book) for source in cell_sources(page)]
    reached = {Path(path).stem for path in imported_modules(sources).values()}
    assert not reached & {"sphinx_ext", "render", "mathml", "site_checks", "publish", "build"}
