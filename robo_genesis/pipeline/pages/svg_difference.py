"""Compare two drawings of Matplotlib: same structure, and points within a tenth of a pixel."""

import re
from itertools import zip_longest
from xml.etree import ElementTree

NEAR = 0.1
"""Difference up to which coordinates count as equal [px]: other processors round differently."""

LARGEST = 20_000_000
"""Most characters of a drawing that is read."""

NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
PLACES = {"d", "points", "x", "y", "x1", "x2", "y1", "y2", "cx", "cy", "width", "height", "viewBox"}
"""Attributes of coordinates; in `transform` only a translation is one."""

TRANSLATE = re.compile(r"(translate\()([^)]*)(\))")
REFERENCE = re.compile(r"url\(#([^)]*)\)|^#(.*)$")


def svg_difference(found: str, valid: str) -> str | None:
    """Return the first difference of two drawings, None if they count as equal.

    Args:
        found: a drawing from anywhere.
        valid: a drawing of Matplotlib.
    """
    if found == valid:
        return None
    if len(found) > LARGEST or "<!ENTITY" in found:
        return "it is longer than a drawing of this course, or declares entities"
    if _before_root(found) != _before_root(valid):
        return "it begins otherwise"
    try:
        pairs = zip_longest(*(list(ElementTree.fromstring(text).iter()) for text in (found, valid)))
    except ElementTree.ParseError as error:
        return f"it is not XML: {error}"
    names: tuple[dict[str, str], dict[str, str]] = ({}, {})
    for number, (one, other) in enumerate(pairs):
        if one is None or other is None or one.tag != other.tag or len(one) != len(other):
            return f"its element {number} is another one, or has other parts"
        texts = [(e.text or "").strip() + (e.tail or "").strip() for e in (one, other)]
        if texts[0] != texts[1] or one.attrib.keys() != other.attrib.keys():
            return f"its element {number} has another text or other attributes"
        for name, value in other.attrib.items():
            if not _equal(name, one.attrib[name], value, names):
                where = f"attribute {name} of its element {number}"
                return f"{where} is {one.attrib[name][:80]!r}, expected {value[:80]!r}"
    return None


def _before_root(text: str) -> str:
    return text[: text.find("<svg")]


def _equal(name: str, found: str, valid: str, names: tuple[dict[str, str], dict[str, str]]) -> bool:
    """Return whether two attributes agree; names that Matplotlib derives from points may differ."""
    if name == "id":
        return _same_name(found, valid, names)
    references = [REFERENCE.search(text) for text in (found, valid)]
    if references[0] and references[1]:
        one, other = (m[1] or m[2] for m in references if m)
        rest = [REFERENCE.sub("", text) for text in (found, valid)]
        return rest[0] == rest[1] and _same_name(one, other, names)
    if name in PLACES:
        return _near(found, valid)
    if name == "transform":
        kept = [TRANSLATE.sub(r"\1\3", text) for text in (found, valid)]
        moved = [[m[2] for m in TRANSLATE.finditer(text)] for text in (found, valid)]
        return kept[0] == kept[1] and all(map(_near, *moved))
    return found == valid


def _same_name(found: str, valid: str, names: tuple[dict[str, str], dict[str, str]]) -> bool:
    """Return whether two names belong to each other everywhere."""
    to_valid, to_found = names
    return to_valid.setdefault(found, valid) == valid and to_found.setdefault(valid, found) == found


def _near(found: str, valid: str) -> bool:
    """Return whether two texts are equal except for numbers, and these nearly equal."""
    if NUMBER.sub("#", found) != NUMBER.sub("#", valid):
        return False
    pairs = zip(NUMBER.findall(found), NUMBER.findall(valid), strict=True)
    return all(abs(float(a) - float(b)) <= NEAR for a, b in pairs)
