"""Formulas: LaTeX becomes MathML while the site is built, and its font is in a style sheet.

Pages need no script for MathML. The font is the part of STIX Two Math that the course
uses: few systems have a font with the tables that a browser needs to place accents,
bars and brackets. Without one the dot of a velocity is smaller than a pixel. The font
is inside the style sheet, so a page opened from disk may use it. A script in the head
asks for it before the first formula does: it is ready for the first frame, and nothing
moves.
"""

import base64
import io
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.math import get_node_equation_number

from robo_genesis.core.files import derived, write_whole
from robo_genesis.core.markup import filled
from robo_genesis.pipeline import npm

LOGGER = logging.getLogger(__name__)

# MathML Core, which browsers implement, has neither `columnalign` nor bold variants.
FOR_BROWSERS = {
    r'columnalign="(left|right|center)"': r'style="text-align: \1"',
    r'mathvariant="bold(?:-italic)?"': 'style="font-weight: bold"',
}

# Signs above a letter; marked as an accent it keeps its size and is not set as a limit.
ACCENTS = {*"˙¨^~¯→˘ˇ´`"}

# HTML knows `<math>` without it. A prefix is registered for a whole process, and
# pycollada, which the engine loads, takes the empty one.
NAMESPACE = ' xmlns="http://www.w3.org/1998/Math/MathML"'

PACKAGE = "@fontsource/stix-two-math"
FILE = f"{PACKAGE}/files/stix-two-math-latin-400-normal.woff"
LOAD = """document.fonts.load('1em "Course Math"')"""
STYLE, LICENCE = "math.css", "math-font-LICENSE.txt"
SHEET = Path(__file__).with_name(STYLE)  # Its template

# The characters that a formula may contain.
SHOWN = {
    *map(chr, range(0x20, 0x5C)),  # ASCII without `\\`, which is left of a command
    *map(chr, range(0x5D, 0x7F)),
    *"\N{NO-BREAK SPACE}¬¯±´·×÷ˆˇ˘˙˜–—‖…′″‴",
    *map(chr, range(0x0300, 0x0309)),  # accents
    *"ΑΒΓΔΕΖΗΘΙΚΛΜΝΞΟΠΡΣΤΥΦΧΨΩαβγδεζηθικλμνξοπρςστυφχψωϑϕϖϱϵ",
    *map(chr, range(0x2061, 0x2065)),  # operators that are not seen
    *"←↑→↓↔⇐⇑⇒⇓⇔",
    *"∀∂∃∅∆∇∈∉∏∑−∓∗∘√∝∞∠∣∥∧∨∩∪∫≈≔≠≡≤≥≪≫⊤⊥⋅⋮⋯⋱⌈⌉⌊⌋⟨⟩¨¸°",
    *map(chr, range(0x1D400, 0x1D434)),  # bold letters
}

# The letters that a browser shows for a variable of one letter; Unicode's italic h is
# Planck's.
ITALIC = {*map(chr, (*range(0x1D434, 0x1D468), *range(0x1D6E2, 0x1D71C)))} - {
    "\U0001d455"
} | {"ℎ"}


def to_mathml(latex: str, display: str) -> str:
    """Return a formula as one `<math>` element.

    Args:
        latex: the formula.
        display: `block` or `inline`.

    Raises:
        ValueError: the formula is not balanced, uses an unknown command, or a character
            that the site's math font lacks.
    """
    latex = latex.replace("{aligned}", "{split}")  # which latex2mathml knows
    braces = re.sub(r"\\.", "", latex)
    try:
        if braces.count("{") != braces.count("}"):
            raise ValueError("its braces are not balanced")
        tree = ElementTree.fromstring(
            convert(latex, display=display).replace(NAMESPACE, "")
        )
    except (
        Exception
    ) as error:  # the converter's parser leaks KeyError, IndexError and its own
        raise ValueError(
            f"{latex!r} is not valid: {type(error).__name__} {error}"
        ) from error
    for over in tree.iter("mover"):
        if over[1].text in ACCENTS:
            over.set("accent", "true")
    markup = ElementTree.tostring(tree, encoding="unicode")
    if lacking := {*"".join(tree.itertext())} - SHOWN - ITALIC - {"\n"}:
        raise ValueError(
            f"{latex!r} shows {' '.join(sorted(lacking))}, which the site's font for formulas does "
            "not have. Use another symbol, or add it to SHOWN in site/text/formulas.py. "
            "A \\ is left of a command that latex2mathml does not know."
        )
    for pattern, replacement in FOR_BROWSERS.items():
        markup = re.sub(pattern, replacement, markup)
    return markup


def checked(node: nodes.Element, display: str) -> str:
    """Return a node's formula as MathML; a warning for an invalid one fails the build (-W)."""
    try:
        return to_mathml(node.astext(), display)
    except ValueError as error:
        LOGGER.warning("math: %s", error, location=node, type="math")
        return ""


def visit_inline(self: Any, node: nodes.Element) -> None:
    """Write an inline formula."""
    opening = self.starttag(node, "span", "", CLASS="math notranslate nohighlight")
    self.body.append(f"{opening}{checked(node, 'inline')}</span>")
    raise nodes.SkipNode


def visit_block(self: Any, node: nodes.Element) -> None:
    """Write a displayed formula with the number and anchor of its references."""
    self.body.append(self.starttag(node, "div", CLASS="math notranslate nohighlight"))
    if node["number"]:
        number = get_node_equation_number(self, node)
        self.body.append(f'<span class="eqno">({number})')
        self.add_permalink_ref(node, "Link to this equation")
        self.body.append("</span>")
    self.body.append(checked(node, "block") + "</div>\n")
    raise nodes.SkipNode


def font() -> bytes:
    """Return the part of the font for `SHOWN` as WOFF; the same bytes each time."""
    whole = npm.published(FILE)
    return derived("font", [whole, Path(__file__).read_bytes()], lambda: cut(whole))


def cut(font: bytes) -> bytes:
    """Return the part of a font for `SHOWN` as WOFF."""
    from fontTools import subset  # most builds find the part in the cache
    from fontTools.ttLib import TTFont

    whole = TTFont(io.BytesIO(font), recalcTimestamp=False)
    options = subset.Options(
        layout_features=["ssty"],  # the forms for superscripts
        drop_tables=["GPOS", "GDEF", "gasp"],
        name_IDs=[0, 1, 2, 13, 14],  # copyright, name, licence
        hinting=False,
        glyph_names=False,
        notdef_outline=True,
    )
    subsetter = subset.Subsetter(options)
    subsetter.populate(unicodes=map(ord, SHOWN | ITALIC))
    subsetter.subset(whole)
    whole.flavor = "woff"
    stream = io.BytesIO()
    whole.save(stream)
    return stream.getvalue()


def css() -> str:
    """Return the style sheet; it raises accents, which browsers set close enough to touch."""
    about, data = npm.locked(PACKAGE), base64.b64encode(font()).decode()
    facts = {name: about[name] for name in ("version", "license")}
    return filled(SHEET, package=PACKAGE, file=LICENCE, font=data, **facts)


def write_css(app: Sphinx) -> None:
    """Write style sheet and licence where Sphinx collects the site's own."""
    folder = Path(app.outdir) / "_static"
    write_whole(folder / STYLE, css().encode())
    write_whole(folder / LICENCE, npm.published(f"{PACKAGE}/LICENSE"))


def add_css(
    app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: Any
) -> None:
    """Load the style sheet and its font on a page with a formula."""
    if app.env.domaindata["math"]["has_equations"].get(page):
        app.add_css_file(STYLE)
        app.add_js_file(None, body=LOAD)


def setup(app: Sphinx) -> None:
    """Register the renderer, which `html_math_renderer` chooses, and the style sheet."""
    inline, block = (visit_inline, None), (visit_block, None)
    app.add_html_math_renderer("mathml", inline, block)
    app.connect("builder-inited", write_css)
    app.connect("html-page-context", add_css)
