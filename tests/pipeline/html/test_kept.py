"""A render that keeps doctrees and pages publishes the same bytes as a render from nothing."""

import os
import pickle
import re
from pathlib import Path
from types import SimpleNamespace

import nbformat
import pytest
import yaml
from small_book import as_executed
from tiny_book import cell, contents, make_book, notebook, paragraphs

from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.html import kept
from robo_genesis.pipeline.html.draft import Draft
from robo_genesis.pipeline.html.kept import State
from robo_genesis.pipeline.html.render import render
from robo_genesis.pipeline.html.sphinx_process import DOCTREES, SphinxProcess
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.page_folder import RECORD
from robo_genesis.pipeline.pages.page_index import PageIndex
from robo_genesis.site.frame.incremental import forget_own_pictures

GLOSSARY = "# Glossary\n\n```{glossary}\ngain\n  A factor. More words.\n```\n"
LAW = "# Law\n\n(spring)=\n## The spring\n\nA gain of two, and a rareword.\n\n{ref}`text <there>`\n"
TEXT = "# Text\n\n(there)=\n## There\n\nSee [](law.md) and {ref}`spring`.\n\n![A drawing](a.svg)\n"
TEXT += "\n```{lesson-status} l04\n```\n"
FIGURE = "\n```{figure} a.svg\n%s\nA drawing\n```\n"
CITING = "# Citing\n\nSee {numref}`drawn` and {eq}`force`.\n"
DRAWN = "# Drawn\n" + FIGURE % ":name: drawn" + "\n$$\nF = k x\n$$ (force)\n"
DRAWING = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"/>'
SOME = State("a", {"one": "1", "two": "2"})


def publish(folder: Path, built: PageIndex, keep: bool = True) -> dict[str, bytes]:
    """Render a book and return its files."""
    kept_folder = folder / "kept" if keep else None
    sphinx = SphinxProcess(folder / "book", folder / "log")
    return contents(render(sphinx, folder / "staging", built, kept_folder).html)


def ran(folder: Path, printed: str) -> PageIndex:
    """Return the book's executed page with an output, without a run."""
    (page,) = find_pages(folder / "book")
    (code,) = (c for c in page.notebook.cells if c.cell_type == "code")
    code.outputs = [nbformat.v4.new_output("stream", name="stdout", text=printed)]
    return PageIndex.of([as_executed(page, folder / f"run {printed}", [1.0])])


def replace(page: Path, *pairs: tuple[str, str]) -> None:
    for old, new in pairs:
        assert old in page.read_text()
        page.write_text(page.read_text().replace(old, new))


def edit_prose(book: Path) -> None:
    """Edit a page and make its file look older than its last render."""
    replace(book / "law.md", ("rareword", "frequent word"))
    os.utime(book / "law.md", (0, 0))


def edit_what_others_show(book: Path) -> None:
    """Change a title, a term, a target's heading, and the picture of another page."""
    replace(
        book / "law.md", ("# Law", "# Hooke"), ("## The spring", "## The stiff spring")
    )
    replace(book / "glossary.md", ("A factor", "A measured factor"))
    replace(book / "text.md", ("\n\n![A drawing](a.svg)", ""))


def edit_numbers(book: Path) -> None:
    """Add a figure before the one that another page cites by its number."""
    page = book / "law.md"
    page.write_text(page.read_text() + FIGURE % "")


def edit_contents(book: Path) -> None:
    """Remove a page, and add one."""
    (book / "extra.md").rename(book / "added.md")
    toc = yaml.safe_load((book / "_toc.yml").read_text())
    toc["chapters"][-1] = {"file": "added"}
    (book / "_toc.yml").write_text(yaml.safe_dump(toc))


def test_each_edit_publishes_the_same_bytes_as_a_render_from_nothing(tmp_path):
    pages = {
        "glossary": GLOSSARY,
        "law": LAW,
        "text": TEXT,
        "run": notebook(cell("print(7)")),
    }
    pages |= {"drawn": DRAWN, "citing": CITING}
    book = make_book(tmp_path, **pages, extra="# Extra\n\nMore.\n")
    (book / "a.svg").write_text(DRAWING)
    built = ran(tmp_path, "seven")
    publish(tmp_path, built)
    said = []
    for edit in (edit_prose, edit_what_others_show, edit_numbers, edit_contents):
        edit(book)
        if edit is edit_contents:
            built = ran(tmp_path, "eight")
        found = publish(tmp_path, built)
        log = (tmp_path / "log").read_text()
        said.append(re.search(r"(\d+) added, (\d+) changed", log).groups())
        expected = publish(tmp_path, built, keep=False)
        assert found.keys() == expected.keys()
        assert [name for name in found if found[name] != expected[name]] == []
    assert said == [("0", "1"), ("0", "3"), ("0", "1"), ("8", "0")]


def test_the_home_page_is_written_again_only_if_it_shows_a_change(tmp_path):
    book = make_book(tmp_path, text="# Text\n\nWords.\n")
    home = tmp_path / "kept/_build/html/index.html"
    publish(tmp_path, PageIndex())
    text = book / "text.md"
    for change, is_written in (("\nMore words.\n", False), ("\n## A heading\n", True)):
        text.write_text(text.read_text() + change)
        before = home.stat().st_mtime_ns
        found = publish(tmp_path, PageIndex())
        assert (home.stat().st_mtime_ns != before) == is_written
        assert found == publish(tmp_path, PageIndex(), keep=False)


NUMBERED = paragraphs(
    "# Numbered",
    "```{figure} a.svg\n```",
    "````{note}\n```{figure} a.svg\n:name: drawn\nA drawing\n```",
    "```{code-block} python\n:caption: Code\n:name: code\npass\n```\n````",
    "```{list-table} Rows\n:name: rows\n* - one\n  - two\n```",
)


def test_figures_tables_and_code_with_captions_are_numbered_wherever_they_are(tmp_path):
    (make_book(tmp_path, page=NUMBERED) / "a.svg").write_text(DRAWING)
    publish(tmp_path, PageIndex())
    with open(tmp_path / "kept" / DOCTREES / "environment.pickle", "rb") as stream:
        numbers = pickle.load(stream).toc_fignumbers["page"]
    kinds = {"figure": "drawn", "code-block": "code", "table": "rows"}
    assert numbers == {kind: {name: (1,)} for kind, name in kinds.items()}


def test_the_figures_of_each_page_are_numbered_from_one(tmp_path):
    pages = {name: f"# {name}\n" + 2 * (FIGURE % "") for name in ("one", "two")}
    (make_book(tmp_path, **pages) / "a.svg").write_text(DRAWING)
    for keep in (True, True, False):
        found = publish(tmp_path, PageIndex(), keep)
        for name in pages:
            assert re.findall(r"Fig. (\d)", found[f"{name}.html"].decode()) == [
                "1",
                "2",
            ]


def test_a_page_does_not_depend_on_pictures_that_reading_another_page_writes_again(
    tmp_path,
):
    written = "../.cache/render/_build/jupyter_execute/71f4.svg"
    files = {
        written,
        "a.svg",
        "text.md",
        str(tmp_path / "book/map.yml"),
        "../.cache/other.svg",
    }
    env = SimpleNamespace(
        docname="text", dependencies={"text": set(files), "law": {written}}
    )
    html = str(tmp_path / ".cache/render/_build/html")
    app = SimpleNamespace(outdir=html, srcdir=str(tmp_path / "book"), env=env)
    forget_own_pictures(app, None)
    assert env.dependencies == {"text": files - {written}, "law": {written}}


def test_a_warning_is_repeated_until_its_cause_is_corrected(tmp_path):
    book = make_book(tmp_path, text="# Text\n\n{doc}`nowhere`\n")
    for _ in range(2):
        with pytest.raises(ProjectError, match=r"text\.md:3.*nowhere"):
            publish(tmp_path, PageIndex())
        assert not (tmp_path / "kept" / kept.STATE).exists()
    replace(book / "text.md", ("{doc}`nowhere`", "Words."))
    assert publish(tmp_path, PageIndex())
    (tmp_path / "kept" / kept.STATE).unlink()  # as after a kill
    publish(tmp_path, PageIndex())
    assert "2 added, 0 changed" in (tmp_path / "log").read_text()


def test_a_refusal_beside_sphinx_ends_it_and_a_render_without_changes_is_complete(
    tmp_path,
):
    def refuse(draft: Draft) -> None:
        raise ValueError("refused")

    sphinx = SphinxProcess(make_book(tmp_path, text="# Text\n"), tmp_path / "log")
    with pytest.raises(ValueError, match="refused"):
        render(sphinx, tmp_path / "staging", PageIndex(), tmp_path / "kept", refuse)
    assert sphinx.process.poll() is not None
    assert not (tmp_path / "kept" / kept.STATE).exists()
    assert publish(tmp_path, PageIndex()) == publish(tmp_path, PageIndex())
    assert "0 added, 0 changed" in (tmp_path / "log").read_text()


def test_equal_names_of_pictures_make_a_folder_unfit(tmp_path):
    """Sphinx gives them numbers in the order of reading."""
    book = make_book(
        tmp_path, one="# One\n\nWords.\n", two="# Two\n\n![Two](b/a.svg)\n"
    )
    for place in (book, book / "b"):
        place.mkdir(exist_ok=True)
        (place / "a.svg").write_text(DRAWING.replace("9", str(len(place.name))))
    publish(tmp_path, PageIndex())
    assert (tmp_path / "kept" / kept.STATE).exists()
    replace(book / "one.md", ("Words.", "![One](a.svg)"))
    assert publish(tmp_path, PageIndex()) == publish(tmp_path, PageIndex(), keep=False)
    assert not (tmp_path / "kept" / kept.STATE).exists()


@pytest.mark.parametrize(
    ("state", "usable", "left"),
    [
        (SOME, True, {"one", "two"}),
        (State("a", {"one": "1", "two": "other"}), True, {"one"}),
        (State("b", SOME.pages), False, set()),
    ],
)
def test_changed_pages_are_read_again_and_others_empty_the_folder(
    tmp_path, state, usable, left
):
    doctrees = tmp_path / DOCTREES
    doctrees.mkdir(parents=True)
    for name in SOME.pages:
        (doctrees / f"{name}.doctree").touch()
    kept.keep(tmp_path, SOME, State("a", {"one": "1", "two": "edited meanwhile"}))
    assert not (tmp_path / kept.STATE).exists()
    kept.keep(tmp_path, SOME, SOME)
    assert kept.prepare(tmp_path, state) == usable
    assert {path.stem for path in doctrees.glob("*")} == left
    assert not (tmp_path / kept.STATE).exists()
    (tmp_path / kept.STATE).write_text('{"others": 3}')
    assert not kept.prepare(tmp_path, SOME)


def test_the_state_has_sources_runs_and_everything_else(tmp_path, monkeypatch):
    book = make_book(tmp_path, text="# Text\n", run=notebook(cell("print(7)")))
    built = ran(tmp_path, "seven")
    found = [kept.read_state(book, built)]

    def changed() -> bool:
        """Whether anything but the pages changed since the last call."""
        found.append(kept.read_state(book, built))
        return found[-1].others != found[-2].others

    assert found[0].pages.keys() == {"index", "text", "run"}
    assert not changed()
    (book / "text.md").write_text("# Other\n")
    assert not changed()
    assert found[-1].pages != found[0].pages
    (built.folders["run"] / RECORD).write_text("another run")
    assert changed()
    (book / "glossary_forms.yml").write_text("")
    assert changed()
    monkeypatch.setenv("LANG", "an other")
    assert changed()
