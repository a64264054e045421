import shutil
from pathlib import Path

import pytest
from bs4 import BeautifulSoup
from tiny_book import WRITE_BUNDLE, cell, make_book, notebook

from robo_genesis.build.execute import execute_pages
from robo_genesis.build.render import RenderError, render
from robo_genesis.lessons.book_pages import find_pages

TEXT = """\
# Text

```{math}
:label: law
\\tau = k_p q
```

See {eq}`law` and $x^2$.
"""


@pytest.fixture(scope="module")
def executed(tmp_path_factory):
    """A book whose one notebook is executed; tests change copies of it."""
    folder = tmp_path_factory.mktemp("render")
    book = make_book(folder, text=TEXT, page=notebook(cell("print('measured ' + '7')")))
    (result,) = execute_pages(find_pages(book), folder / "cache")
    assert result.status == "executed"
    return folder


@pytest.fixture
def folder(executed, tmp_path):
    return Path(shutil.copytree(executed, tmp_path / "copy"))


def build(folder: Path) -> Path:
    return render(folder / "book", folder / "staging", folder / "cache", folder / "render.log")


def test_outputs_numbers_and_math_need_no_script_from_elsewhere(folder):
    (folder / "staging").mkdir()
    (folder / "staging" / "stale").touch()
    html = build(folder)
    assert not (folder / "staging" / "stale").exists()
    assert "measured 7" in (html / "page.html").read_text()
    text = BeautifulSoup((html / "text.html").read_text(), "html.parser")
    assert len(text.select("article math")) == 2
    assert text.select_one("#equation-law .eqno").get_text().startswith("(1)")
    assert text.select_one('p a[href="#equation-law"]').get_text() == "(1)"
    sources = [script["src"] for script in text.find_all("script", src=True)]
    assert sources
    assert not [src for src in sources if "//" in src or "mathjax" in src.lower()]
    assert "thebe" not in str(text).lower()


def test_metadata_come_from_the_page_and_outputs_from_the_cache(folder):
    page = folder / "book/page.md"
    page.write_text(
        page.read_text().replace("```{code-cell}", "```{code-cell}\n:tags: [hide-input]")
    )
    shown = (build(folder) / "page.html").read_text()
    assert "tag_hide-input" in shown
    assert "measured 7" in shown


@pytest.mark.parametrize("front", ["", "mystnb: {execution_mode: force}\n"])
def test_sphinx_executes_nothing_and_names_the_page(folder, front):
    """A page that the execution stage has not seen would leave a file behind if it were run."""
    trace = folder / "was executed"
    text = notebook(cell(f"open({str(trace)!r}, 'w')"), front=front)
    (folder / "book/page.md").write_text(text)
    with pytest.raises(RenderError, match=r"page\.md is not executed, and Sphinx executes nothing"):
        build(folder)
    assert not trace.exists()


@pytest.mark.parametrize(
    ("markdown", "said"),
    [
        ("$\\foo{x}$", r"uses \\foo, which latex2mathml does not know"),
        ("{doc}`nowhere`", "nowhere"),
        ("[missing](#nowhere)", "nowhere"),
        ("{py:func}`nowhere`", "reference target not found: nowhere"),
        ("{nosuchrole}`x`", "nosuchrole"),
    ],
)
def test_a_warning_fails_the_build_and_is_shown_with_page_and_line(folder, markdown, said):
    with (folder / "book/text.md").open("a") as file:
        file.write(f"\n{markdown}\n")
    with pytest.raises(RenderError, match=said) as caught:
        build(folder)
    assert "text.md:10" in str(caught.value)
    assert str(folder / "render.log") in str(caught.value)


CLAIMS = "status: amdgpu-verified\nbadge: cpu-verified\n"
LAB = "robo_genesis: {lesson: l04, page: lab, state: verified, status: verified}\n"


def test_no_front_matter_or_bundle_s_word_can_set_a_badge(tmp_path):
    """The lab's bundle is a manifest that says it was verified, and nothing more."""
    said = WRITE_BUNDLE.replace('"predicate": {', '"state": "verified", "predicate": {')
    shown = "\n```{lesson-status} l04\n```\n\n{lesson-state}`l04`\n"
    lab = notebook(cell(said), front=CLAIMS + LAB) + shown
    text = f"---\n{CLAIMS}---\n# Text\n{shown}"
    book = make_book(tmp_path, text=text, lab=lab)
    (result,) = execute_pages(find_pages(book), tmp_path / "cache")
    assert result.status == "executed"
    html = build(tmp_path)
    for name in ("text", "lab"):
        page = BeautifulSoup((html / f"{name}.html").read_text(), "html.parser")
        badges = [badge.get_text() for badge in page.select("article .evidence-badge")]
        assert badges == ["cpu-refused", "amdgpu-missing"] * 2
