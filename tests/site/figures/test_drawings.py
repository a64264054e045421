"""Drawings become elements of their page, follow its theme, and stay what they are elsewhere."""

import re

import pytest
from bs4 import BeautifulSoup

from robo_genesis.core import plotting
from robo_genesis.core.palette import MARKS, PARTS
from robo_genesis.core.project import BOOK, ROOT
from robo_genesis.site.figures.drawings import WIDE, element, image_size, inline_drawings
from robo_genesis.site.frame.accessibility import stack_tables

SVG = """<?xml version="1.0"?><svg width="90pt" height="60pt" viewBox="0 0 90 60">
<metadata><b/></metadata><title>No</title><!-- a note --><defs><style>*{x: y}</style>
<path id="m1" style="fill: #0072b2"/></defs><g id="axes_1"><use xlink:href="#m1"/></g>
<g clip-path="url(#m1)" stroke="#7a7a7a"/></svg>"""

ON_A_PHONE = 342
"""Width of a drawing on a phone that is 390 pixels wide [CSS px]."""


def inlined(folder, *names: str) -> BeautifulSoup:
    images = "".join(f'<img src="{name}" alt="Two &amp; more" id="i{name[0]}"/>' for name in names)
    page = BeautifulSoup(f"<article>{images}</article>", "html.parser")
    inline_drawings(page, folder)
    return BeautifulSoup(str(page), "html.parser")


def test_a_drawing_is_an_element_with_variables_and_names_of_its_own(tmp_path):
    for name in ("a.svg", "b.svg"):
        (tmp_path / name).write_text(SVG)
    first, second = inlined(tmp_path, "a.svg", "b.svg").select("svg")
    assert (first["aria-label"], first["role"], first["id"]) == ("Two & more", "img", "ia")
    assert (first["width"], first["height"], first["data-file"]) == ("120", "80", "a.svg")
    assert first.path["style"] == "fill: var(--case-g1, #0072b2)"
    assert first.select_one("[stroke]")["stroke"] == "var(--figure-line, #7a7a7a)"
    for number, drawn in enumerate((first, second)):
        own = f"drawing-{number}-m1"
        assert [tag["id"] for tag in drawn.select("[id]")] == [own]
        assert drawn.use["href"] == f"#{own}"
        assert drawn.select_one("[clip-path]")["clip-path"] == f"url(#{own})"
    assert not first.select("metadata, title, style")
    assert "note" not in str(first)


def test_digits_that_nobody_sees_are_left_out():
    drawing = '<svg><g transform="translate(12.345678 0.5) scale(0.015625)"/></svg>'
    assert "translate(12.34 0.5) scale(0.015625)" in element(drawing, "a-", {})


def test_a_drawing_is_not_a_link_to_its_file(tmp_path):
    (tmp_path / "a.svg").write_text(SVG)
    link = '<a class="reference image-reference" href="a.svg"><img src="a.svg" alt="A"/></a>'
    page = BeautifulSoup(f"<article>{link}</article>", "html.parser")
    inline_drawings(page, tmp_path)
    assert [tag.name for tag in BeautifulSoup(str(page), "html.parser").article] == ["svg"]


def test_camera_frames_and_missing_files_stay_images(tmp_path):
    (tmp_path / "a.svg").write_text(SVG.replace("<use", "<image/><use"))
    page = inlined(tmp_path, "a.svg", "gone.svg")
    assert len(page.select("img")) == 2
    assert not page.select("svg")


def test_a_colour_outside_the_palette_is_refused():
    with pytest.raises(ValueError, match=r"has the colour #123456, which would not follow the th"):
        element(SVG.replace("#0072b2", "#123456"), "a-", {})


@pytest.mark.parametrize(
    "file", sorted((ROOT / "book").glob("[!_]*/**/*.svg")), ids=lambda f: f.name
)
def test_illustrations_are_drawn_with_the_palette(file):
    assert "var(--figure-text" in element(file.read_text("utf8"), "a-", {})


def test_all_that_the_style_draws_has_a_colour_of_the_palette(tmp_path):
    with plotting.course_style():
        figure = plotting.figure(3)
        ax = figure.subplots()
        for mark in MARKS:
            ax.plot([0, 1], [0, 1], label=mark, **plotting.look(mark))
        ax.axhspan(0, 0.5, color=plotting.BAND)
        plotting.finish(ax, "Title", "y")
        figure.savefig(tmp_path / "a.svg")
    drawn = element((tmp_path / "a.svg").read_text(), "a-", {})
    colours = {mark.light for mark in (*MARKS.values(), *PARTS.values())}
    assert {*re.findall(r"var\(--[\w-]+, (#\w+)\)", drawn)} == colours
    assert not re.search(r"[:\"] ?#[0-9a-f]{3,8}[;\"]", drawn)


WORD, LONG = "twelve chars", "unbreakable_" * 3


@pytest.mark.parametrize(
    ("cells", "rows", "stacks"),
    [
        (["a", "b", "c"], 1, False),
        ([WORD * 9, WORD * 9, WORD], 2, False),  # its words break into lines
        ([LONG, LONG], 2, True),
        (["<code>a b c d e f g h i j k l m n o p q r s t u v w x</code>", LONG], 1, True),
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


@pytest.mark.parametrize("file", sorted(BOOK.glob("lessons/*/*.svg")), ids=lambda file: file.name)
def test_an_illustration_fits_on_a_phone_with_letters_that_can_be_read(file):
    width, _ = image_size(file)
    letters = re.findall(r'font-size="([\d.]+)"', file.read_text("utf8"))
    assert width <= WIDE
    assert min(map(float, letters)) * ON_A_PHONE / width >= 11
