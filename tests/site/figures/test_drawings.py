"""Drawings become elements of their page, follow its theme, and stay what they are elsewhere."""

import pytest
from bs4 import BeautifulSoup

from robo_genesis.site.figures.drawings import inline_drawings
from robo_genesis.site.frame.accessibility import stack_tables

SVG = """<?xml version="1.0"?><svg width="90pt" height="60pt" viewBox="0 0 90 60">
<metadata><b/></metadata><title>No</title><!-- a note --><defs><style>*{x: y}</style>
<path id="m1" style="fill: #0072b2"/></defs><g id="axes_1"><use xlink:href="#m1"/></g>
<g clip-path="url(#m1)" stroke="#7a7a7a"
transform="translate(12.345678 0.5) scale(0.015625)"/></svg>"""


def inlined(folder, *names: str) -> BeautifulSoup:
    images = (
        f'<img src="{name}" alt="Two &amp; more" id="i{name[0]}"/>' for name in names
    )
    links = (f'<a class="image-reference" href="a.svg">{image}</a>' for image in images)
    page = BeautifulSoup(f"<article>{''.join(links)}</article>", "html.parser")
    inline_drawings(page, folder)
    return BeautifulSoup(str(page), "html.parser")


def test_a_drawing_is_an_element_with_variables_and_names_of_its_own(tmp_path):
    for name in ("a.svg", "b.svg"):
        (tmp_path / name).write_text(SVG)
    first, second = inlined(tmp_path, "a.svg", "b.svg").select("article > svg")
    assert (first["aria-label"], first["role"], first["id"]) == (
        "Two & more",
        "img",
        "ia",
    )
    assert (first["width"], first["height"], first["data-file"]) == (
        "120",
        "80",
        "a.svg",
    )
    assert first.path["style"] == "fill: var(--case-g1, #0072b2)"
    assert first.select_one("[stroke]")["stroke"] == "var(--figure-line, #7a7a7a)"
    assert (
        first.select_one("[stroke]")["transform"]
        == "translate(12.34 0.5) scale(0.015625)"
    )
    for number, drawn in enumerate((first, second)):
        own = f"drawing-{number}-m1"
        assert [tag["id"] for tag in drawn.select("[id]")] == [own]
        assert drawn.use["href"] == f"#{own}"
        assert drawn.select_one("[clip-path]")["clip-path"] == f"url(#{own})"
    assert not first.select("metadata, title, style")


def test_camera_frames_and_missing_files_stay_images(tmp_path):
    (tmp_path / "a.svg").write_text(SVG.replace("<use", "<image/><use"))
    page = inlined(tmp_path, "a.svg", "gone.svg")
    assert len(page.select("img")) == 2
    assert not page.select("svg")


WORD, LONG = "twelve chars", "unbreakable_" * 3


@pytest.mark.parametrize(
    ("cells", "rows", "stacks"),
    [
        (["a", "b", "c"], 1, False),
        ([WORD * 9, WORD * 9, WORD], 2, False),  # its words break into lines
        (
            ["<code>a b c d e f g h i j k l m n o p q r s t u v w x</code>", LONG],
            1,
            True,
        ),
        (["a"] * 13, 3, True),
        (["a"] * 13, 41, False),  # a list of samples
        (['<p class="case-mark">G1</p>', WORD * 2, WORD], 2, False),
    ],
)
def test_a_table_that_a_phone_cannot_show_is_stacked(cells, rows, stacks):
    heads = "".join(f"<th>{k} [m]</th>" for k in range(len(cells)))
    row = f"<tr>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"
    table = f"<table><thead><tr>{heads}</tr></thead><tbody>{row * rows}</tbody></table>"
    page = BeautifulSoup(f"<article>{table}</article>", "html.parser")
    stack_tables(page)
    assert bool(page.select("table.stacks[role=table]")) == stacks
    named = [cell.get("data-head") for cell in page.select("tbody tr")[0].select("td")]
    assert named == [f"{k} [m]" if stacks else None for k in range(len(cells))]
    assert len(page.select("[role=cell]")) == (rows * len(cells) if stacks else 0)
