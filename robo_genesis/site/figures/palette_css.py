"""The palette in style sheets, and a mark of its line beside a case's name in a table.

`_static/palette.css` is written by each build. It declares, for both themes, each
mark's colour (`--case-g1`, `--target`) and the colours of a figure's other parts
(`--figure-text`).
"""

import re
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.transforms.post_transforms import SphinxPostTransform

from robo_genesis.core.files import write_whole
from robo_genesis.core.markup import filled
from robo_genesis.core.palette import MARKS, PARTS, css_name
from robo_genesis.lessons import course_marks
from robo_genesis.site.evidence.origin import above

from . import case_labels

# Its template. Paper has the light theme
SHEET = Path(__file__).with_name("palette.css")
# A case's name in prose: "pushed" and "baseline" are ordinary words there.
NAMES = sorted(name for name in course_marks() if not name.isalpha())
NAME = re.compile(rf"\b({'|'.join(map(re.escape, NAMES))})\b")
OTHER_TEXT = (
    nodes.literal,
    nodes.literal_block,
    nodes.math,
    nodes.raw,
    nodes.reference,
)


def css() -> str:
    """Return the style sheet of the palette."""
    marks = {css_name(name): mark for name, mark in MARKS.items()}
    colours = marks | {f"figure-{name}": part for name, part in PARTS.items()}
    return filled(SHEET, marks=marks, colours=colours)


class MarkCases(SphinxPostTransform):
    """Mark each case that is named.

    A cell of a table that holds a case's name or its words, and nothing else, gets the
    line of the plots beside it. In running text the name has the case's colour, unless
    it is an ordinary word.
    """

    default_priority = 400  # outputs of cells have been chosen by then

    def run(self, **kwargs: Any) -> None:
        """Mark cells, then what is left of the text."""
        for entry in self.document.findall(nodes.entry):
            name = entry.astext()
            paragraph = entry.next_node(nodes.paragraph)
            if name in case_labels.MARKS and paragraph is not None:
                paragraph["classes"] += ["case-mark", css_name(case_labels.MARKS[name])]
        for text in list(self.document.findall(nodes.Text)):
            if NAME.search(text) and _is_running(text):
                text.parent.replace(text, _named(text))


def _is_running(text: nodes.Text) -> bool:
    """Whether a text is in a paragraph or a caption, and is neither code, link nor marked."""
    inside = next(above(text, (nodes.paragraph, nodes.caption)), None)
    other = any(above(text, OTHER_TEXT))
    return inside is not None and "case-mark" not in inside["classes"] and not other


def _named(text: nodes.Text) -> list[nodes.Node]:
    """Return a text with each case's name in an element of its own."""
    marks = course_marks()
    return [
        nodes.inline(part, part, classes=["case-name", css_name(marks[part])])
        if number % 2
        else nodes.Text(part)
        for number, part in enumerate(NAME.split(text))
        if part
    ]


def write_css(app: Sphinx) -> None:
    """Write the style sheet where Sphinx collects the site's own."""
    write_whole(Path(app.outdir) / "_static" / "palette.css", css().encode())


def setup(app: Sphinx) -> None:
    """Register style sheet and marks."""
    app.add_post_transform(MarkCases)
    app.add_css_file("palette.css", priority=400)  # before the sheets that use it
    app.connect("builder-inited", write_css)
