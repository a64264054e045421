"""Links each term of the glossary at its first use on a page; the link's title is its definition.

Only words of running text become links. Headings, code, formulas, tables, captions and
other links stay unchanged, and a definition does not link to itself.
"""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml
from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.transforms.post_transforms import SphinxPostTransform
from sphinx.util import logging

from robo_genesis.site.evidence.origin import above

GLOSSARY = "glossary"

# File in the glossary's folder: further forms of its terms, and terms that are not
# linked.
FORMS = "glossary_forms.yml"

KEPT = (
    addnodes.pending_xref,
    nodes.caption,
    nodes.literal,
    nodes.literal_block,
    nodes.math,
    nodes.math_block,
    nodes.raw,
    nodes.reference,
    nodes.table,
    nodes.term,
    nodes.title,
)
KEPT_CLASSES = {
    "course-map",
    "planned-lessons",
    "evidence-badge",
    "lesson-status",
    "measured",
    "provenance",
}

logger = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Term:
    """The anchor of a term's entry in the glossary, and the first sentence of its definition."""

    anchor: str
    definition: str


@dataclass(frozen=True, slots=True)
class Forms:
    """Further forms of terms by the term's name, and the terms that are not linked."""

    forms: dict[str, list[str]]
    unlinked: list[str]


def read_forms(book: Path) -> Forms:
    """Return the forms that a book declares, empty where it declares none."""
    file = book / FORMS
    return (
        Forms(**yaml.safe_load(file.read_text("utf8")))
        if file.is_file()
        else Forms({}, [])
    )


def glossary_terms(env: BuildEnvironment) -> dict[str, Term]:
    """Return the terms of a book's glossary by name, none where a book has no glossary."""
    if GLOSSARY not in env.all_docs:
        return {}
    found = {}
    for entry in env.get_doctree(GLOSSARY).findall(nodes.definition_list_item):
        definition = entry.next_node(nodes.definition)
        first = (
            definition.next_node(nodes.paragraph) if definition is not None else None
        )
        text = (
            re.split(r"(?<=\.)\s", first.astext().replace("\n", " "))[0]
            if first
            else ""
        )
        for term in entry.findall(nodes.term):
            if term["ids"]:
                found[term.astext()] = Term(term["ids"][0], text)
    return found


def written_forms(terms: dict[str, Term], declared: Forms) -> dict[str, Term]:
    """Return each form that becomes a link, with its term."""
    forms = {
        name: term for name, term in terms.items() if name not in declared.unlinked
    }
    for name in declared.forms.keys() & terms.keys():  # check_forms names the others
        others = declared.forms[name]
        forms |= {other: terms[name] for other in others if other not in terms}
    return forms | {
        form[0].upper() + form[1:]: term
        for form, term in forms.items()
        if form[0].islower() and form[0].upper() + form[1:] not in forms
    }


def pattern(forms: dict[str, Term]) -> re.Pattern[str]:
    """Return a pattern that finds the forms as whole words, longer ones before their parts."""
    longest = sorted(forms, key=lambda form: (-len(form), form))
    words = "|".join(re.escape(form).replace(r"\ ", r"\s+") for form in longest)
    return re.compile(rf"(?<![\w-])(?:{words})(?![\w-])")


class LinkTerms(SphinxPostTransform):
    """Link terms at their first use."""

    default_priority = 410  # outputs of cells have been chosen, references are resolved

    def run(self, **kwargs: Any) -> None:
        """Replace each text that contains a first use by text and links."""
        terms = glossary_terms(self.env)
        if not terms:
            return
        forms = written_forms(terms, read_forms(Path(self.env.srcdir)))
        join_texts(self.document)
        words, seen = pattern(forms), set()
        for text in filter(is_prose, list(self.document.findall(nodes.Text))):
            parts: list[nodes.Node] = []
            at, string = 0, text.astext()
            for match in words.finditer(string):
                term = forms[re.sub(r"\s+", " ", match.group())]
                if term.anchor in seen or term.anchor in _own_anchors(text):
                    continue
                seen.add(term.anchor)
                parts += [
                    nodes.Text(string[at : match.start()]),
                    self.link(term, match.group()),
                ]
                at = match.end()
            if parts:
                text.parent.replace(text, [*parts, nodes.Text(string[at:])])

    def link(self, term: Term, words: str) -> nodes.reference:
        """Return the link from this page to a term's entry."""
        if self.env.docname == GLOSSARY:
            target = {"refid": term.anchor}
        else:
            page = self.app.builder.get_relative_uri(self.env.docname, GLOSSARY)
            target = {"refuri": f"{page}#{term.anchor}"}
        return nodes.reference(
            "",
            "",
            nodes.inline("", words),
            internal=True,
            classes=["term-link"],
            reftitle=term.definition,
            **target,
        )


def join_texts(document: nodes.document) -> None:
    """Join adjacent texts: the parser splits them at line ends, but a term may span two lines."""
    for text in list(document.findall(nodes.Text)):
        parent = text.parent
        at = parent.index(text)
        if at and isinstance(parent[at - 1], nodes.Text):
            joined = nodes.Text(parent[at - 1].astext() + text.astext())
            parent[at - 1 : at + 1] = [joined]


def is_prose(text: nodes.Text) -> bool:
    """Return whether a text is in a paragraph, and in no element that stays unchanged."""
    return any(above(text, nodes.paragraph)) and not any(
        isinstance(node, KEPT) or KEPT_CLASSES & set(node["classes"])
        for node in above(text)
    )


def _own_anchors(text: nodes.Text) -> set[str]:
    """Return the anchors of the glossary entry that contains a text."""
    entry = next(above(text, nodes.definition_list_item), None)
    terms = entry.findall(nodes.term) if entry else ()
    return {anchor for term in terms for anchor in term["ids"]}


def check_forms(app: Sphinx, env: BuildEnvironment) -> None:
    """Warn about declared names that are not in the glossary; a warning fails the build."""
    declared = read_forms(Path(env.srcdir))
    for name in sorted(
        {*declared.forms, *declared.unlinked} - glossary_terms(env).keys()
    ):
        message = (
            f"{FORMS} names {name!r}, which is not in the glossary. Add or correct it."
        )
        logger.warning(message, location=GLOSSARY)


def setup(app: Sphinx) -> None:
    """Register the links."""
    app.add_post_transform(LinkTerms)
    app.connect("env-check-consistency", check_forms)
