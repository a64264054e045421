"""Definitions of the glossary beside the words that authors write as {term}.

Such a word is a button, which shows its definition by touch, keyboard and mouse without
a script, and below the definition a link to the glossary.
"""

import re
from html import escape
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.transforms.post_transforms import SphinxPostTransform

from robo_genesis.site.evidence.plain_nodes import between

GLOSSARY = "glossary"


def glossary_terms(env: BuildEnvironment) -> dict[str, str]:
    """Return by anchor the first sentence of each definition, none without a glossary."""
    if GLOSSARY not in env.all_docs:
        return {}
    sentences = {}
    for entry in env.get_doctree(GLOSSARY).findall(nodes.definition_list_item):
        definition = entry.next_node(nodes.definition).astext().replace("\n", " ")
        for term in entry.findall(nodes.term):
            for anchor in term["ids"]:
                sentences[anchor] = re.split(r"(?<=\.)\s", definition)[0]
    return sentences


class DefineTerms(SphinxPostTransform):
    """Replace each link to a term by a button and a note with the definition."""

    default_priority = 11  # just after references are resolved

    def run(self, **kwargs: Any) -> None:
        """Replace the links."""
        links = [
            link
            for link in self.document.findall(nodes.reference)
            if any("std-term" in part["classes"] for part in link.findall(nodes.inline))
        ]
        sentences = glossary_terms(self.env) if links else {}
        for number, link in enumerate(links):
            address = link.get("refuri") or f"#{link['refid']}"
            sentence = sentences[address.partition("#")[2]]
            link.replace_self(defined(link, f"note-{number}", sentence, address))


def defined(
    link: nodes.reference, name: str, sentence: str, address: str
) -> nodes.Node:
    """Return the button of a term with the words of a link, and its note.

    Args:
        link: to the entry of the term.
        name: the identifier of the note, unique on the page.
        sentence: the definition.
        address: of the entry.
    """
    entry = f'<a href="{escape(address)}">Glossary</a>'
    note = (
        f'<span class="term-note" id="{name}" popover>{escape(sentence)} {entry}</span>'
    )
    button = f'<button class="term-link" popovertarget="{name}" type="button">'
    return between("", *link.children, opening=button, closing=f"</button>{note}")


def setup(app: Sphinx) -> None:
    """Register the definitions."""
    app.add_post_transform(DefineTerms)
