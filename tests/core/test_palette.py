"""The palette is readable in both themes, and the same in plots and on pages."""

import re

import pytest
from docutils import nodes
from docutils.utils import new_document

from robo_genesis.core import plotting
from robo_genesis.core.palette import CASES, GROUNDS, MARKS, contrast, css_name, marks_of
from robo_genesis.site import palette_css

TEXT = 4.5
"""Least contrast of text, WCAG 2.2, 1.4.3; graphics ask for 3."""


@pytest.mark.parametrize(
    ("one", "other", "ratio"),
    [("#000000", "#ffffff", 21), ("#ffffff", "#ffffff", 1), ("#767676", "#ffffff", 4.54)],
)
def test_contrast_is_that_of_wcag(one, other, ratio):
    assert contrast(one, other) == contrast(other, one) == pytest.approx(ratio, abs=0.005)


@pytest.mark.parametrize("theme", GROUNDS)
@pytest.mark.parametrize("name", MARKS)
def test_each_mark_reads_as_text_on_each_ground(name, theme):
    colour = getattr(MARKS[name], theme)
    assert min(contrast(colour, ground) for ground in GROUNDS[theme]) >= TEXT


@pytest.mark.parametrize("field", ["light", "dark", "dashes"])
def test_no_two_marks_share_colour_or_dashes(field):
    assert len({getattr(mark, field) for mark in MARKS.values()}) == len(MARKS)


def test_dashes_and_gaps_alternate():
    assert all(len(mark.dashes) % 2 == 0 for mark in MARKS.values())


@pytest.mark.parametrize(
    ("case", "mark"), [*CASES.items(), ("another", "baseline"), ("target", "baseline")]
)
def test_plots_draw_the_palette_s_light_colours(case, mark):
    dashes = MARKS[mark].dashes
    drawn = {"color": MARKS[mark].light, "linestyle": (0, dashes) if dashes else "-"}
    assert plotting.style(case) == plotting.look(mark) == drawn


def test_each_case_drawn_with_others_has_a_mark_of_its_own():
    assert marks_of(("G2", "baseline")) == {"G2": "second", "baseline": "baseline"}
    assert marks_of(("slow", "G1", "fast")) == {"slow": "second", "G1": "first", "fast": "third"}
    assert [*marks_of("abcd").values()] == ["first", "second", "third", "baseline"]


def test_more_cases_than_marks_are_refused():
    with pytest.raises(ValueError, match=r"a, b, c, d, e are 5 cases; the palette has 4 marks"):
        marks_of("abcde")


def rules() -> dict[str, list[dict[str, str]]]:
    found: dict[str, list[dict[str, str]]] = {}
    for selector, body in re.findall(
        r"^([^\s}][^{\n]*) \{\n(.*?)^\}", palette_css.css(), re.M | re.S
    ):
        properties = dict(re.findall(r"^  ([\w-]+): (.*);$", body, re.M))
        found.setdefault(selector, []).append(properties)
    return found


def test_the_style_sheet_declares_each_colour_for_both_themes():
    light, dashes = rules()[":root"]
    (dark,) = rules()['html[data-theme="dark"]']
    assert light == {f"--{css_name(name)}": mark.light for name, mark in MARKS.items()}
    assert dark == {f"--{css_name(name)}": mark.dark for name, mark in MARKS.items()}
    assert dashes["--case-g2-dash"] == "12 4"
    assert dashes["--case-baseline-dash"] == "none"
    cases = {"--case-baseline", "--case-g1", "--case-g2", "--case-g3"}
    assert {*light} == cases | {"--target", "--limit", "--other", "--further"}


def test_the_mark_in_a_table_repeats_the_dashes_of_the_plot_whole():
    names = ("baseline", "g2", "g3")
    found = {name: rules()[f".case-mark.case-{name}::before"][0] for name in names}
    assert found["baseline"] == {"background": "var(--case-baseline)", "width": "1.9em"}
    assert found["g2"] == {
        "background": "repeating-linear-gradient(90deg, var(--case-g2) 0.00em 0.36em, "
        "transparent 0.36em 0.60em, var(--case-g2) 0.60em 0.96em)",
        "width": "1.92em",
    }
    assert found["g3"]["background"].count("transparent") == 2
    assert found["g3"]["width"] == "1.38em"


def page_of(*children: nodes.Node) -> nodes.document:
    document = new_document("page")
    document += children
    transform = palette_css.MarkCases(document)
    transform.run()
    return document


def marked(document: nodes.document) -> list[tuple[str, list[str]]]:
    return [(node.astext(), node["classes"]) for node in document.findall(nodes.inline)]


def test_names_in_running_text_are_marked_and_the_text_stays():
    text = "The baseline, then KP is doubled (G1 → G2): G2's overshoot, not G22's or BG1."
    document = page_of(nodes.paragraph("", text))
    assert document.astext() == text
    assert marked(document) == [(n, ["case-name", f"case-{n.lower()}"]) for n in ("G1", "G2", "G2")]


def test_names_in_emphasis_and_captions_are_marked():
    strong = nodes.paragraph("", "", nodes.strong("", "G3"))
    figure = nodes.figure("", nodes.caption("", "joint4 in G1"))
    assert [name for name, _ in marked(page_of(strong, figure))] == ["G3", "G1"]


@pytest.mark.parametrize(
    "node", [nodes.literal("", "G1"), nodes.reference("", "G1"), nodes.math("", "G1")]
)
def test_code_links_and_formulas_are_left_alone(node):
    assert marked(page_of(nodes.paragraph("", "", node))) == []


def test_titles_are_left_alone():
    section = nodes.section("", nodes.title("", "G1, G2, G3: one factor at a time"))
    assert marked(page_of(section)) == []


def test_a_cell_that_is_a_name_gets_the_line_instead():
    paragraphs = [nodes.paragraph("", text) for text in ("G1", "baseline", "after G2")]
    document = page_of(*(nodes.entry("", paragraph) for paragraph in paragraphs))
    assert [p["classes"] for p in paragraphs] == [
        ["case-mark", "case-g1"],
        ["case-mark", "case-baseline"],
        [],
    ]
    assert [name for name, _ in marked(document)] == ["G2"]
