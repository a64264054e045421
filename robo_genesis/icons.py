"""The icons' font, cut down to the icons that this site shows.

The theme brings all of Font Awesome Free, most of a page's weight. Its licence for fonts, the SIL
Open Font License 1.1, keeps the name "Font Awesome" for the complete font; the cut one has
another.
"""

import re
from collections.abc import Iterable
from importlib.metadata import distribution
from pathlib import Path

from fontTools import subset

FONTS = Path("_static/vendor/fontawesome/webfonts")
WHOLE, CUT = "fa-solid-900.ttf", "course-icons.woff"
LICENCE = "OFL.txt"
NOTICE = Path("_static/scripts/fontawesome.js.LICENSE.txt")
"""The theme's copy of the makers' own words on copyright and licence."""

OFL = re.compile(
    r"^-{20,}\nSIL OPEN FONT LICENSE Version 1\.1 .*?(?=^={3,}$|\Z)", re.DOTALL | re.MULTILINE
)
NAME = "Course icons"
NAMING = {1, 3, 4, 6, 16, 18, 20}
"""The entries of a font's name table that name the font itself; licence and makers are others."""

CLASS = re.compile(r"\bfa-[a-z0-9-]+")
ICON = re.compile(r'((?:\.fa-[a-z0-9-]+:before,?)+)\{content:"\\([0-9a-f]+)"\}')
FACE = re.compile(
    r"url\([^()]*fa-solid-900\.woff2\)[^,;}]*,\s*url\([^()]*fa-solid-900\.ttf\)[^;}]*"
)
OTHER_FACE = re.compile(r"@font-face\s*\{[^{}]*fa-(?:regular|brands)-400[^{}]*\}")
OTHER_ICON = re.compile(r"""class=["'][^"']*(?<![\w-])(?:fab|far|fa-brands|fa-regular)(?![\w-])""")
"""An icon of the two fonts that the site does not ship."""

ESCAPED = re.compile(r'"\\([ef][0-9a-f]{3})"')
PRIVATE = re.compile("[\ue000-\uf8ff]")


def cut_icons(html: Path) -> Path:
    """Replace the icons' font of a site by one with the icons in use.

    Args:
        html: the folder of the site.

    Returns:
        The font; its licence stands beside it.

    Raises:
        LookupError: the theme's style sheet names the font in a way that is not known here, or a
            page shows an icon of the theme's other two fonts, which are taken out.
    """
    texts = [path.read_text("utf8") for kind in ("html", "js") for path in html.rglob(f"*.{kind}")]
    if any(OTHER_ICON.search(path.read_text("utf8")) for path in html.rglob("*.html")):
        raise LookupError("A page shows a regular or brand icon. The site ships solid ones alone.")
    sheets = {path: path.read_text("utf8") for path in html.rglob("*.css")}
    font = html / FONTS / CUT
    write_font(html / FONTS / WHOLE, icons_used(texts, sheets.values()), font)
    faces = [path for path, sheet in sheets.items() if FACE.search(sheet)]
    if len(faces) != 1:
        raise LookupError(f"{len(faces)} style sheets load {WHOLE}. See FACE in {__name__}.")
    own = f'url(../vendor/fontawesome/webfonts/{CUT}) format("woff")'
    faces[0].write_text(OTHER_FACE.sub("", FACE.sub(own, sheets[faces[0]])), "utf8")
    notice = (html / NOTICE).read_text("utf8").strip()
    font.with_name(LICENCE).write_text(f"{notice}\n\n{open_font_licence()}", "utf8")
    return font


def open_font_licence() -> str:
    """Return the text of the SIL Open Font License 1.1, which fontTools brings for its own fonts.

    Raises:
        LookupError: it is not where this version of fontTools has it.
    """
    texts = distribution("fonttools").read_text("licenses/LICENSE.external") or ""
    found = OFL.search(texts)
    if found is None:
        raise LookupError("fontTools' LICENSE.external lacks the Open Font License. See OFL.")
    return found[0].strip() + "\n"


def icons_used(texts: Iterable[str], sheets: Iterable[str]) -> set[int]:
    """Return the characters of all icons that a site may show.

    Args:
        texts: pages and scripts; they name icons by class.
        sheets: style sheets; they say which character a class stands for, and hold some of their
            own.
    """
    names = {name for text in texts for name in CLASS.findall(text)}
    used: set[int] = set()
    for sheet in sheets:
        for selectors, character in ICON.findall(sheet):
            if names.intersection(CLASS.findall(selectors)):
                used.add(int(character, 16))
        rest = ICON.sub("", sheet)
        used |= {int(character, 16) for character in ESCAPED.findall(rest)}
        used |= {ord(character) for character in PRIVATE.findall(rest)}
    return used


def write_font(whole: Path, characters: Iterable[int], cut: Path) -> None:
    """Write a font of some characters of another, under a name of its own.

    Args:
        whole: the complete font.
        characters: code points; those that the font lacks are left out.
        cut: the file to write, as WOFF.
    """
    options = subset.Options(flavor="woff", name_IDs=["*"], layout_features=[], hinting=False)
    font = subset.load_font(str(whole), options)
    subsetter = subset.Subsetter(options)
    subsetter.populate(unicodes=characters)
    subsetter.subset(font)
    for record in font["name"].names:
        if record.nameID in NAMING:
            record.string = NAME
    subset.save_font(font, str(cut), options)
