"""Links each term of the glossary at its first use on a page, its definition as the link's title.

Linked are words of running text. Headings, code, formulas, tables, captions and other links stay
as they are, and a definition does not link to itself.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.transforms.post_transforms import SphinxPostTransform
from sphinx.util import logging

GLOSSARY = "glossary"
OTHER_FORMS = {
    "actuator": ("actuators",),
    "backend": ("backends",),
    "badge": ("badges",),
    "bundle": ("bundles",),
    "chatter": ("chatters",),
    "clipping": ("clips", "clipped"),
    "constraint": ("constraints",),
    "critically damped": ("critical damping",),
    "damping ratio": ("damping ratios",),
    "degree of freedom": ("degrees of freedom",),
    "digest": ("digests",),
    "DOF": ("DOFs",),
    "Entity": ("Entities",),
    "force range": ("force ranges",),
    "integrator": ("integrators",),
    "Joint": ("Joints",),
    "kernel": ("kernels",),
    "Link": ("Links",),
    "margin": ("margins",),
    "metric": ("metrics",),
    "posture": ("postures",),
    "prediction": ("predictions",),
    "prismatic joint": ("prismatic",),
    "quaternion": ("quaternions",),
    "revolute joint": ("revolute",),
    "saturation": ("saturated",),
    "Scene": ("Scenes",),
    "settling time": ("settling",),
    "solver": ("solvers",),
    "stamp": ("stamps", "stamped", "time stamp", "time stamps"),
    "substep": ("substeps",),
    "tolerance": ("tolerances",),
    "trace": ("traces",),
}
"""Further forms in which a term stands in prose. One in small letters may also begin a sentence."""

UNLINKED = {"case", "check", "environment", "reset", "step"}
"""Terms that are common words, too, or have a second sense on some page."""

KEPT = (
    addnodes.pending_xref, nodes.caption, nodes.literal, nodes.literal_block, nodes.math,
    nodes.math_block, nodes.raw, nodes.reference, nodes.table, nodes.term, nodes.title,
)  # fmt: skip
KEPT_CLASSES = {"provenance", "lesson-status", "measured", "page-facts", "evidence-badge"}

logger = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Term:
    """A term as the glossary writes it, the page and anchor of its entry, and what it says."""

    name: str
    docname: str
    anchor: str
    definition: str


def glossary_terms(env: BuildEnvironment) -> dict[str, Term]:
    """Return the terms of a book's glossary by name, none where a book has no glossary."""
    if GLOSSARY not in env.all_docs:
        return {}
    found = {}
    for entry in env.get_doctree(GLOSSARY).findall(nodes.definition_list_item):
        definition = entry.next_node(nodes.definition)
        first = definition.next_node(nodes.paragraph) if definition is not None else None
        said = re.split(r"(?<=\.)\s", first.astext().replace("\n", " "))[0] if first else ""
        for term in entry.findall(nodes.term):
            if term["ids"] and term.astext() not in UNLINKED:
                found[term.astext()] = Term(term.astext(), GLOSSARY, term["ids"][0], said)
    return found


def written_forms(terms: dict[str, Term]) -> dict[str, Term]:
    """Return each form in which a term is written in prose, with the term."""
    forms = dict(terms)
    for name, others in OTHER_FORMS.items():
        if name in terms:
            forms |= {other: terms[name] for other in others if other not in terms}
    return forms | {
        form[0].upper() + form[1:]: term
        for form, term in forms.items()
        if form[0].islower() and form[0].upper() + form[1:] not in forms
    }


def pattern(forms: dict[str, Term]) -> re.Pattern[str]:
    """Return what finds the forms as whole words, longer ones before their parts."""
    longest = sorted(forms, key=lambda form: (-len(form), form))
    words = "|".join(re.escape(form).replace(r"\ ", r"\s+") for form in longest)
    return re.compile(rf"(?<![\w-])(?:{words})(?![\w-])")


class LinkTerms(SphinxPostTransform):
    """Link terms at their first use."""

    default_priority = 410  # outputs of cells have been chosen, references are resolved

    def run(self, **kwargs: Any) -> None:
        """Replace the text that holds a first use by text and links."""
        terms = glossary_terms(self.env)
        if not terms:
            return
        forms = written_forms(terms)
        words, seen = pattern(forms), set()
        for text in list(self.document.findall(nodes.Text)):
            if not is_prose(text):
                continue
            parts: list[nodes.Node] = []
            at, string = 0, text.astext()
            for match in words.finditer(string):
                term = forms[re.sub(r"\s+", " ", match.group())]
                if term.anchor in seen or term.anchor in _own_anchors(text):
                    continue
                seen.add(term.anchor)
                parts += [nodes.Text(string[at : match.start()]), self.link(term, match.group())]
                at = match.end()
            if parts:
                text.parent.replace(text, [*parts, nodes.Text(string[at:])])

    def link(self, term: Term, words: str) -> nodes.reference:
        """Return the link from this page to a term's entry."""
        builder = self.app.builder
        page = builder.get_relative_uri(self.env.docname, term.docname)
        uri = {"refuri": f"{page}#{term.anchor}"}
        if self.env.docname == term.docname:
            uri = {"refid": term.anchor}
        return nodes.reference(
            "", "", nodes.inline("", words), internal=True, classes=["term-link"],
            reftitle=term.definition, **uri,
        )  # fmt: skip


def is_prose(text: nodes.Text) -> bool:
    """Return whether a text stands in a paragraph, and in nothing that is kept as it is."""
    above = list(_above(text))
    return any(isinstance(node, nodes.paragraph) for node in above) and not any(
        isinstance(node, KEPT) or KEPT_CLASSES & set(node["classes"]) for node in above
    )


def _above(node: nodes.Node) -> Iterator[nodes.Element]:
    while node.parent is not None:
        node = node.parent
        yield node


def _own_anchors(text: nodes.Text) -> set[str]:
    """Return the anchors of the glossary's entry that a text stands in."""
    for node in _above(text):
        if isinstance(node, nodes.definition_list_item):
            return {anchor for term in node.findall(nodes.term) for anchor in term["ids"]}
    return set()


def check_forms(app: Sphinx, env: BuildEnvironment) -> None:
    """Warn of declared forms whose term the glossary does not have."""
    terms = glossary_terms(env)
    for name in sorted(OTHER_FORMS.keys() - terms.keys()) if terms else []:
        logger.warning(f"OTHER_FORMS names {name!r}, which is no term.", location=GLOSSARY)


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the links."""
    app.add_post_transform(LinkTerms)
    app.connect("env-check-consistency", check_forms)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
