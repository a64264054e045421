"""Definitions of the glossary as titles of the links to it, which authors write as {term}."""

import re
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.transforms.post_transforms import SphinxPostTransform

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


class TitleTerms(SphinxPostTransform):
    """Write the definition of a term into the title of its link."""

    default_priority = 11  # just after references are resolved

    def run(self, **kwargs: Any) -> None:
        """Add titles, and the class that style sheets name."""
        links = [
            link
            for link in self.document.findall(nodes.reference)
            if any("std-term" in part["classes"] for part in link.findall(nodes.inline))
        ]
        sentences = glossary_terms(self.env) if links else {}
        for link in links:
            anchor = link.get("refid") or link["refuri"].partition("#")[2]
            link["reftitle"] = sentences[anchor]
            link["classes"].append("term-link")


def setup(app: Sphinx) -> None:
    """Register the titles."""
    app.add_post_transform(TitleTerms)
