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
        (notebook(front="robo_genesis: {lesson: ../x, page: lab}\n"), "plain words"),
        (notebook(front="robo_genesis: lab\n"), "lesson: l04, page: lab"),
        (notebook(front="execution: {allow_errors: true}\n"), "allow_errors"),
        ("---\nfile_format: mystnb\n---\n# No kernel\n", "kernelspec"),
        (notebook(cell("1", ":tags: [a\n")), r"cannot be read: .*\n(.*\n)*Correct .*bad\.md"),
        (notebook(front="title: [a\n"), "cannot be read"),
        (notebook(cell("1", ":load: no_such_file.py\n")), "cannot be read"),
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


@pytest.mark.parametrize("source", ["def (", "from . import used"])
def test_a_cell_that_cannot_run_imports_nothing(root, source):
    assert imported_modules([source], root) == {}


@pytest.mark.parametrize(
    ("file", "counts"),
    [
        ("robo_genesis/used.py", True),
        ("robo_genesis/evidence/deep.py", True),
        ("robo_genesis/lazy.py", True),
        ("robo_genesis/evidence/data.json", True),
        ("requirements.lock", True),
        ("robo_genesis/sphinx_ext.py", False),  # no page imports it
    ],
)
def test_a_file_that_pages_use_counts(root, pages, file, counts):
    before = fingerprint(pages, root, {})
    with (root / file).open("a") as opened:
        opened.write("# one line\n")
    assert (fingerprint(pages, root, {}) != before) == counts


def test_the_environment_counts_if_it_changes_a_measurement(root, pages):
    before = fingerprint(pages, root, {})
    for name in ("ROBO_GENESIS_RENDER", "ROBO_GENESIS_BACKEND", "QD_FAST_MATH"):
        assert fingerprint(pages, root, {name: "0"}) != before
    for name in ("HOME", "QD_OFFLINE_CACHE_FILE_PATH"):
        assert fingerprint(pages, root, {name: "/elsewhere"}) == before


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("robo_genesis.lessons.book_pages.installed_packages", ["mujoco==0.1"]),
        ("platform.python_version", "3.99.0"),
    ],
)
def test_another_version_of_python_or_a_package_counts(root, pages, monkeypatch, name, value):
    before = fingerprint(pages, root, {})
    monkeypatch.setattr(name, lambda: value)
    assert fingerprint(pages, root, {}) != before


def test_the_code_digest_ignores_prose(tmp_path):
    texts = [notebook(cell("1")), notebook(cell("1"), title="Other"), notebook(cell("2"))]
    digests = []
    for number, text in enumerate(texts):
        (page,) = find_pages(make_book(tmp_path / str(number), page=text))
        digests.append(code_digest(page))
    assert digests[0] == digests[1] != digests[2]


def test_no_page_computes_with_modules_of_the_build_or_the_site():
    sources = [source for page in find_pages(ROOT / "book") for source in cell_sources(page)]
    packages = {".".join(name.split(".")[:2]) for name in imported_modules(sources)}
    assert "robo_genesis.evidence" in packages
    assert not packages & {f"robo_genesis.{name}" for name in ("build", "site", "maintain")}
