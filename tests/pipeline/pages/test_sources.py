"""Which changes of the package change the evidence keys and the fingerprints of which pages."""

import ast
import os
import re
import shutil
from contextlib import suppress
from copy import deepcopy
from dataclasses import replace
from importlib import import_module
from inspect import isfunction
from operator import attrgetter
from unittest.mock import patch

import pytest
from tiny_book import LAB_FRONT, cell, make_book, notebook

from robo_genesis.core.project import BOOK, ROOT
from robo_genesis.lessons import LESSONS, find_page
from robo_genesis.pipeline.pages import sources
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.sources import (
    Tree,
    measuring_modules,
    page_fingerprint,
)
from robo_genesis.pipeline.pages.syntax import read_code, read_module

PACKAGE = ROOT / "robo_genesis"
PAGES = find_pages(BOOK)
LECTURES = [page for page in PAGES if page.page == "lecture"]
ALL, NONE = LESSONS, ()


@pytest.fixture
def root(tmp_path):
    """A checkout with a package; `used` reaches `deep` and `lazy` by relative imports."""
    package = tmp_path / "robo_genesis"
    (package / "evidence").mkdir(parents=True)
    texts = {
        "__init__.py": "",
        "used.py": "import numpy\nfrom robo_genesis.evidence import record\n",
        "sphinx_ext.py": "import robo_genesis.used\n",
        "evidence/__init__.py": "",
        "evidence/record.py": "def f():\n    from .deep import g\n    from .. import lazy\n",
        "evidence/deep.py": "",
        "lazy.py": "",
    }
    for name, text in texts.items():
        (package / name).write_text(text)
    (tmp_path / "requirements.lock").write_text("numpy==2.0\n")
    return tmp_path


CODE = "%matplotlib inline\nfrom robo_genesis.used import thing"


@pytest.fixture
def page(root):
    (found,) = find_pages(make_book(root, lab=notebook(cell(CODE), front=LAB_FRONT)))
    return found


def key(page, root, **variables):
    with patch.dict(os.environ, variables, clear=True):
        return page_fingerprint(page, Tree(root))


@pytest.mark.parametrize(
    ("file", "line", "counts"),
    [
        ("robo_genesis/lazy.py", "X = 1", True),
        ("robo_genesis/evidence/deep.py", "X = 1", True),
        ("robo_genesis/lazy.py", "# a comment", False),
        ("robo_genesis/lazy.py", "X = (", True),  # no longer Python: its text counts
        ("robo_genesis/core/data.json", "1", True),
        ("robo_genesis/lessons/l04/arm.xml", "1", True),
        ("robo_genesis/lessons/l04/data/arm", "1", True),
        ("robo_genesis/lessons/l04/deep/spec.py", "X = 1", True),
        ("robo_genesis/lessons/l03/data.csv", "1", False),
        ("robo_genesis/lessons/l04/arm.xml~", "1", False),
        ("robo_genesis/lessons/l04/.arm.xml.swp", "1", False),
        ("robo_genesis/lessons/l04/__pycache__/spec.cpython-311.pyc", "1", False),
        ("robo_genesis/maintain/template.tmpl", "1", False),
        ("requirements.lock", "# a comment", True),
        ("robo_genesis/sphinx_ext.py", "X = 1", False),  # no page imports it
    ],
)
def test_a_file_that_the_page_uses_counts(root, page, file, line, counts):
    for lesson in ("l03", "l04"):
        write(root, f"robo_genesis/lessons/{lesson}/__init__.py")
    found = [key(page, root)]
    for _ in ("added", "changed"):
        write(root, file, f"{line}\n")
        found.append(key(page, root))
    assert len({*found}) == (3 if counts else 1)


def write(root, name, text=""):
    """Append to a file, which is made if it is missing."""
    (root / name).parent.mkdir(parents=True, exist_ok=True)
    with (root / name).open("a") as opened:
        opened.write(text)


def test_data_of_the_lesson_and_of_what_the_page_imports_is_in_its_evidence_key(
    root, monkeypatch
):
    """Of other lessons only with a module of theirs, and none of what measures nothing."""
    read = []
    monkeypatch.setattr(
        sources, "sha256", lambda path: read.append(path.parent.name) or path.name
    )
    data = [
        "core/a.bin",
        "sim/arm/a",
        "lessons/l04/a/b.xml",
        "lessons/l03/a.csv",
        "site/a.json",
    ]
    for name in (
        *data,
        "pipeline/a.csv",
        "lessons/l03/__init__.py",
        "lessons/l03/run.py",
    ):
        write(root, f"robo_genesis/{name}")
    imports, other = (
        ["robo_genesis.lessons.l03.run"],
        {"lessons.l03.run", "lessons/l03/a.csv"},
    )
    assert measuring_modules("l04", [], root).keys() == {*data[:3]}
    assert "l03" not in read  # a page that read it would be refused
    assert measuring_modules("l04", imports, root).keys() == {*data[:3]} | other


# What a measuring module may call that is in no evidence key: places, words and
# judgements, and what makes cases, which `parameters()` has.
OUTSIDE_OF_KEYS = re.compile(
    r"core\.(project|text)|sim\.(\w+\.)?laws|lessons\.(l07\.spec\.lift_of|l08\.spec\.starts)"
)


def test_what_measures_calls_nothing_that_is_in_no_evidence_key():
    tree, called = Tree(), set()
    for path in PACKAGE.rglob("*.py"):
        name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
        if not tree.measures(name, path):
            continue
        for node in ast.walk(ast.parse(path.read_text())):
            with suppress(AttributeError):  # of what is no call of a known function
                function = attrgetter(ast.unparse(node.func))(import_module(name))
                home = function.__module__.removeprefix("robo_genesis.")
                of_us = isfunction(function) and home != function.__module__
                if of_us and not tree.measures(home, tree.module(function.__module__)):
                    called.add(f"{home}.{function.__name__}")
    assert [name for name in called if not OUTSIDE_OF_KEYS.match(name)] == []


def test_whatever_else_decides_a_measurement_counts(root, page, monkeypatch):
    names = (
        "ROBO_GENESIS_RENDER",
        "ROBO_GENESIS_BACKEND",
        "QD_FAST_MATH",
        "LD_LIBRARY_PATH",
    )
    alone = deepcopy(page.notebook)
    alone.cells[1].metadata["tags"] = ["alone"]
    found = [key(page, root), key(replace(page, notebook=alone), root)]
    found += [key(page, root, **{name: "0"}) for name in names]
    for module, name, value in (
        (sources.project, "installed", [("", "mujoco-0.1.dist-info", 0)]),
        (sources.platform, "python_version", "3.99.0"),
    ):
        monkeypatch.setattr(module, name, lambda *given, value=value: value)
        found.append(key(page, root))
    assert len({*found}) == len(found)
    for name in ("HOME", "QD_OFFLINE_CACHE_FILE_PATH", "OMP_NUM_THREADS"):
        assert key(page, root, **{name: "/elsewhere"}) == found[-1]


@pytest.mark.parametrize(
    ("code", "counts"),
    [
        (f"{CODE}  # a comment", False),
        (CODE.replace("inline", "agg"), True),
        (f"{CODE}\nthing", True),
        (f"{CODE};", True),  # hides the output of the cell
        (f"{CODE}; # quiet", True),
        (f"{CODE}\n'shown'", True),
    ],
)
def test_a_changed_cell_counts_and_a_comment_does_not(root, page, code, counts):
    lab = notebook(cell(code), front=LAB_FRONT, title="Another title")
    (changed,) = find_pages(make_book(root, lab=lab))
    assert (key(changed, root) != key(page, root)) == counts


TIMES = "throughput.measure("


def test_a_page_that_runs_alone_records_elapsed_times():
    alone = {page.docname: page for page in PAGES if page.alone}
    timed = {p.docname for p in PAGES for code in p.code.sources if TIMES in code}
    assert timed
    assert timed <= {*alone}
    for name, page in alone.items():  # a tag at another cell is noticed
        code = page.code.sources[page.alone - 1]
        assert any(word in code for word in (TIMES, "step_time", "perf_counter()")), (
            name
        )
    for name in timed:
        groups = find_page(alone[name].lesson, alone[name].page).groups(True).values()
        assert any(group.kind == "performance" for group in groups), name


def keys(root, pages):
    """Return fingerprint and modules of the evidence key of some pages of the course."""
    tree = Tree(root)
    fingerprints = {(p.lesson, p.page): page_fingerprint(p, tree) for p in pages}
    modules = {
        (p.lesson, p.page): measuring_modules(p.lesson, p.code.imports, root)
        for p in pages
    }
    return fingerprints, modules


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of the package and the lock, to change and to restore, and its keys."""
    root = tmp_path_factory.mktemp("checkout")
    shutil.copytree(
        PACKAGE, root / "robo_genesis", ignore=shutil.ignore_patterns("__pycache__")
    )
    shutil.copy(ROOT / "requirements.lock", root)
    return root, keys(root, PAGES)


DOCSTRING, CONSTANT = ('"""', '"""Also: '), ("\n\n\n", "\n\nCHANGED = 1\n\n\n")


CHANGES = [
    ("core/trace", DOCSTRING, NONE, NONE),
    ("core/trace", CONSTANT, ALL, ALL),
    ("core/project", CONSTANT, ALL, NONE),
    ("evidence/recorder", CONSTANT, ALL, NONE),
    ("pipeline/stages", CONSTANT, NONE, NONE),
    ("lessons/l04/theory", CONSTANT, ("l04",), ("l04",)),
    (
        "lessons/l04/spec",
        ('"rad": (1e-4, 1e-3)', '"rad": (1e-3, 1e-2)'),
        ("l04",),
        NONE,
    ),
    ("lessons/l04/pages", ('filmed="the Franka"', 'filmed="the arm"'), ("l04",), NONE),
    ("lessons/l02/plots", CONSTANT, ("l02",), NONE),
    ("lessons/l02/checks", ('"""The engine\'s mass', '"""The mass'), ("l02",), NONE),
    ("lessons/l02/checks", ('"""Named checks', '"""The checks'), NONE, NONE),
]
CONTACTS = ("l01", "l02", "l03", "l07", "l08")
if {*CONTACTS} <= {*LESSONS}:  # a lesson can be removed with its tests alone
    CHANGES.append(("sim/bodies/contacts", CONSTANT, CONTACTS, CONTACTS))


@pytest.mark.parametrize(("file", "change", "run_again", "stale"), CHANGES)
def test_a_change_reaches_the_pages_that_use_it_alone(
    copy, file, change, run_again, stale
):
    root, before = copy
    path = root / "robo_genesis" / f"{file}.py"
    text = path.read_text("utf8")
    assert change[0] in text
    path.write_text(text.replace(*change, 1), "utf8")
    try:
        after = keys(root, LECTURES)
    finally:
        path.write_text(text, "utf8")
    changed = [
        {lesson for lesson, page in now if was[lesson, page] != now[lesson, page]}
        for was, now in zip(before, after, strict=True)
    ]
    expected = [{*run_again}, {*stale}]
    assert changed == expected


@pytest.mark.parametrize("lesson", LESSONS)
def test_a_module_that_computes_uses_none_that_presents(lesson):
    """Except the specification, whose values are parameters of the bundle or judge it."""
    tree = Tree()
    for name in measuring_modules(lesson, []):
        if "/" in name:  # a data file
            continue
        file = PACKAGE.joinpath(*name.split(".")).with_suffix(".py")
        names = read_code([file.read_text("utf8")]).imports
        used = {each: path for each in names if (path := tree.module(each))}
        shown = {
            each.rpartition(".")[2].rpartition("_")[2]
            for each, path in used.items()
            if path.name != "__init__.py" and not tree.measures(each, path)
        }
        allowed = {"spec", "project", "laws", "text"}
        if name == "lessons.l08.capstone":  # it asks which functions passed
            allowed.add("exercises")
        assert shown <= allowed, name


SAME = [
    ("x = 1", "x = 1  # one\n\n\n"),
    ("x = 1", '"""About."""\nx = 1\n"""About x."""'),
    ("class A:\n  x = 1", "class A:\n  'About A.'\n  x = 1\n  'About x.'"),
    ("x = f'a{y}b'", "x = f'a' f'{y}' 'b' ''"),
]
OTHERS = [
    ("x = 1", "x = 2"),
    ("x = 1", "x = True"),
    ("x = f'{y}'", "x = f'{y!r}'"),
    ("x = f'a{y}'", "x = f'{y}a'"),
    ("x = (", "x = [("),
]


PAIRS = [(*p, True) for p in SAME] + [(*p, False) for p in OTHERS]


@pytest.mark.parametrize(("one", "other", "same"), PAIRS)
def test_what_a_module_does_counts_and_not_how_it_is_written(one, other, same):
    assert (read_module(one).digest == read_module(other).digest) == same


@pytest.mark.parametrize(
    ("source", "digest"),
    [
        ('x = f"a{y!r:>{w}.{p}f}b" "c" f"{z}" ""', "329fb3f9bda1"),
        ("@d\ndef f(x, *args: *Ts): pass", "e171e48a512b"),
    ],
)
def test_every_version_of_python_gives_the_same_digest(source, digest):
    """The digests were computed with Python 3.11, 3.12 and 3.13."""
    assert read_module(source).digest.startswith(digest)
