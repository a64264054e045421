"""Puts drawings into their pages as elements, with the palette of the reader's theme.

Figures of cells and illustrations are SVG files in the colours of the light theme. In a
page, each colour becomes a variable of `palette.css`, with the colour itself as its
fallback. The file stays in the site as the run produced it, and the ledger has its
digest.
"""

import re
from html import escape
from pathlib import Path
from urllib.parse import unquote, urlsplit

import imagesize
from bs4 import BeautifulSoup
from bs4.element import PreformattedString

from robo_genesis.core.palette import COLOUR, MARKS, PARTS, css_name

# What takes the place of each colour.
VARIABLES = {
    **{
        mark.light: f"var(--{css_name(name)}, {mark.light})"
        for name, mark in MARKS.items()
    },
    **{
        part.light: f"var(--figure-{name}, {part.light})"
        for name, part in PARTS.items()
    },
}

DRAWING = re.compile(r"\.svg$")

# What a page gets no part of; a style sheet, for example, would apply to all of it.
DROPPED = re.compile(
    r'(?is)<!--.*?-->|<(metadata|style|title|script|foreignObject)\b.*?</\1\s*>|\s+xmlns:\w+="[^"]*"'
)
REFERENCE = re.compile(r'(?<=url\(#)[^)]+|(?<=href="#)[^"]+')
IDENTIFIER = re.compile(r'\s+id="([^"]*)"')

# Digits beyond a hundredth of a coordinate; a scale is smaller than one and keeps all.
FRACTION = re.compile(r"\b([1-9]\d*\.\d\d)\d+")
SIZE = re.compile(r'\s(?:width|height|version|role|style|class)="[^"]*"')

# Matplotlib's own style sheet, which would apply to the whole page.
LINES = "stroke-linejoin: round; stroke-linecap: butt"


def inline_drawings(page: BeautifulSoup, folder: Path) -> None:
    """Replace the drawings of an article by elements, in place.

    Drawings that contain a picture of a camera stay files: they are large, and have no
        colours of
    the palette. A link around a drawing to its own file is removed.

    Args:
        page: the complete page.
        folder: the folder that the page's addresses are relative to.
    """
    images = page.article.find_all("img", src=DRAWING) if page.article else []
    for number, image in enumerate(images):
        address = str(image["src"])
        file = folder / unquote(urlsplit(address).path)
        text = file.read_text("utf8") if file.is_file() else "<image"
        if "<image" not in text:
            width, height = image_size(file)
            attributes = {
                "class": "drawing",
                "role": "img",
                "aria-label": str(image.get("alt", "")),
                "data-file": address,
                "width": str(width),
                "height": str(height),
                "style": f"--natural: {width}px; {LINES}",
            }
            if image.has_attr("id"):  # the anchor of a figure without caption
                attributes["id"] = str(image["id"])
            link = image.find_parent("a", class_="image-reference")
            (link or image).replace_with(
                PreformattedString(element(text, f"drawing-{number}-", attributes))
            )


def image_size(file: Path) -> tuple[int, int]:
    """Return an image's width and height [CSS px].

    Raises:
        ValueError: it states none.
    """
    width, height = imagesize.get(file)
    if width < 0:
        raise ValueError(
            f"{file.name} states no size. Give its root a width and height."
        )
    return round(width), round(height)


def element(drawing: str, prefix: str, attributes: dict[str, str]) -> str:
    """Return a drawing as an element of a page.

    Args:
        drawing: the content of an SVG file.
        prefix: of its identifiers, which are unique on the page.
        attributes: of the element.
    """
    drawing = DROPPED.sub("", drawing[drawing.index("<svg") :])
    drawing = drawing.replace("xlink:href", "href")
    used = {*REFERENCE.findall(drawing)}
    drawing = IDENTIFIER.sub(
        lambda found: f' id="{prefix}{found[1]}"' if found[1] in used else "", drawing
    )
    drawing = REFERENCE.sub(lambda found: prefix + found[0], drawing)
    drawing = FRACTION.sub(r"\1", drawing)
    drawing = COLOUR.sub(lambda found: found[1] + VARIABLES[found[2]], drawing)
    start, rest = drawing.split(">", 1)
    given = "".join(f' {name}="{escape(value)}"' for name, value in attributes.items())
    return f"{SIZE.sub('', start)}{given}>{rest.strip()}"
