"""The style sheet has the palette for both themes, and names of cases on pages are marked."""

import pytest
from docutils import nodes
from docutils.utils import new_document

from robo_genesis.site.figures import palette_css


def test_a_mark_has_one_colour_everywhere():
    assert ".case-g2 {\n  --ink: var(--case-g2);\n}" in palette_css.css()


def marked(*children: nodes.Node) -> tuple[str, list[tuple[str, list[str]]]]:
    """The text of a page, and the text and classes of each element that was marked in it."""
    document = new_document("page")
    document += children
    palette_css.MarkCases(document).run()
    found = document.findall(nodes.inline)
    return document.astext(), [(node.astext(), node["classes"]) for node in found]


TEXT = (
    "The baseline, then KP is doubled (G1 → G2): G2's overshoot, not G22's or pushed."
)


@pytest.mark.parametrize(
    ("node", "names"),
    [
        (nodes.paragraph("", TEXT), ["G1", "G2", "G2"]),
        (nodes.paragraph("", "", nodes.strong("", "G3")), ["G3"]),
        (nodes.figure("", nodes.caption("", "joint4 in G1")), ["G1"]),
        (
            nodes.paragraph("", "", nodes.literal("", "G1"), nodes.reference("", "G1")),
            [],
        ),
        (nodes.section("", nodes.title("", "G1, G2, G3: one factor at a time")), []),
    ],
)
def test_names_in_running_text_are_marked_and_the_text_stays(node, names):
    text = node.astext()
    assert marked(node) == (
        text,
        [(n, ["case-name", f"case-{n.lower()}"]) for n in names],
    )


def test_a_cell_that_is_a_name_or_its_words_gets_the_line_instead():
    cells = {
        "G1": "case-g1",
        "baseline": "case-baseline",
        "after G2": "",
        "KP doubled": "case-g1",
    }
    paragraphs = [nodes.paragraph("", text) for text in cells]
    _, found = marked(*(nodes.entry("", paragraph) for paragraph in paragraphs))
    marks = [["case-mark", name] if name else [] for name in cells.values()]
    assert [p["classes"] for p in paragraphs] == marks
    assert [name for name, _ in found] == ["G2"]
