"""Converts LaTeX math to MathML while the site is built, so that pages need no script for it."""

import re
import xml.etree.ElementTree as ElementTree
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.util import logging
from sphinx.util.math import get_node_equation_number

from robo_genesis.site.math_font import missing

LOGGER = logging.getLogger(__name__)

# latex2mathml knows `split` and `align*`, which align the same way; the numbers are Sphinx's own.
ENVIRONMENTS = {"aligned": "split", "align": "align*", "equation": "equation*"}

# MathML Core, which browsers implement, has neither `columnalign` nor bold variants.
FOR_BROWSERS = {
    r'columnalign="(left|right|center)"': r'style="text-align: \1"',
    r'mathvariant="bold(?:-italic)?"': 'style="font-weight: bold"',
}

ACCENTS = {*"˙¨^~¯→˘ˇ´`"}
"""Signs above a letter; marked as an accent it keeps its size and is not set as a limit."""

NAMESPACE = "http://www.w3.org/1998/Math/MathML"
ElementTree.register_namespace("", NAMESPACE)


def to_mathml(latex: str, display: str) -> str:
    """Return a formula as one `<math>` element.

    Args:
        latex: the formula.
        display: `block` or `inline`.

    Raises:
        ValueError: the formula is not balanced, uses an unknown command, or a character that the
            site's math font lacks.
    """
    for name, known in ENVIRONMENTS.items():
        latex = re.sub(rf"\\(begin|end)\{{{name}\}}", rf"\\\1{{{known}}}", latex)
    try:
        tree = ElementTree.fromstring(convert(latex, display=display))
    except Exception as error:  # the converter's parser leaks KeyError, IndexError and its own
        raise ValueError(f"{latex!r} is not valid: {type(error).__name__} {error}") from error
    for over in tree.iter(f"{{{NAMESPACE}}}mover"):
        if over[1].text in ACCENTS:
            over.set("accent", "true")
    markup = ElementTree.tostring(tree, encoding="unicode")
    unknown = re.search(r"\\[A-Za-z]*", markup)
    if unknown:
        raise ValueError(f"{latex!r} uses {unknown[0]}, which latex2mathml does not know.")
    if lacking := missing("".join(tree.itertext())):
        raise ValueError(
            f"{latex!r} shows {lacking}, which the site's font for formulas does not have. Use "
            "another symbol, or add it to SHOWN in robo_genesis/site/math_font.py."
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
