"""A page's reading time below its title, its history from git at its end, and its description."""

import shutil
import textwrap
from dataclasses import dataclass
from functools import lru_cache
from html import escape
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx

from robo_genesis.core.git import git_or_none
from robo_genesis.site.evidence.origin import above

WORDS_A_MINUTE = 200
"""Slow reading, as technical prose asks for; code, tables and formulas are not counted."""
COMMITS = 6
"""How many of the latest commits of a page are listed."""
DESCRIPTION = 200
"""Letters of a description at most: about what is shown of one elsewhere."""
UNCOUNTED = (nodes.literal_block, nodes.table, nodes.math, nodes.math_block, nodes.raw)


@dataclass(frozen=True, slots=True)
class History:
    """Latest commits of a file as (date, subject), the newest first.

    `unknown` says why nothing is known; `changed` whether the file has changes since.
    """

    commits: tuple[tuple[str, str], ...] = ()
    unknown: str = ""
    changed: bool = False


def count_words(document: nodes.document) -> int:
    """Return the words of a page's running text, headings and captions included."""
    return sum(
        len(text.astext().split())
        for text in document.findall(nodes.Text)
        if not any(isinstance(node, UNCOUNTED) for node in above(text))
    )


def reading_time(words: int) -> str:
    """Return the words as a time, in whole minutes, with what it was computed from."""
    minutes = max(1, round(words / WORDS_A_MINUTE))
    return f"About {minutes} min to read: {words:,} words of text at {WORDS_A_MINUTE} a minute."


@lru_cache(maxsize=8)
def _why_unknown(folder: Path) -> str:
    """Return why a folder's history cannot be read, nothing where it can."""
    if shutil.which("git") is None:
        return "Git is not installed where this site was built."
    shallow = git_or_none(folder, "rev-parse", "--is-shallow-repository")
    if shallow is None:
        return "Git knows no history of this page where this site was built."
    if shallow.strip() == "true":
        return "This site was built from a shallow clone, which holds no history."
    return ""


def history(file: Path) -> History:
    """Return the latest commits that touched a file."""
    unknown = _why_unknown(file.parent)
    if unknown:
        return History(unknown=unknown)
    form = ("log", f"-n{COMMITS}", "--format=%cs%x09%s", "--", file.name)
    lines = (git_or_none(file.parent, *form) or "").splitlines()
    commits = tuple((day, said) for day, _, said in (line.partition("\t") for line in lines))
    if not commits:
        return History(unknown="The page is in no commit yet.")
    return History(
        commits, changed=bool(git_or_none(file.parent, "status", "--porcelain", "--", file.name))
    )


def history_html(found: History) -> str:
    """Return a history as a fold."""
    rows = "".join(
        f'<li><time datetime="{day}">{day}</time> {escape(said)}</li>'
        for day, said in found.commits
    )
    changed = "<p>And changes that are in no commit yet.</p>" if found.changed else ""
    said = f"<p>Not known. {escape(found.unknown)}</p>" if found.unknown else f"<ul>{rows}</ul>"
    return (
        '<details class="page-history"><summary>History of this page</summary>'
        f"{said}{changed}</details>"
    )


def add_facts(app: Sphinx, document: nodes.document, docname: str) -> None:
    """Put the time below the title, but of the home page, and the history at the end."""
    section = document.next_node(nodes.section)
    if section is None:
        return
    if docname != app.config.root_doc:
        time = reading_time(count_words(document))
        section.insert(1, nodes.paragraph("", time, classes=["page-facts"]))
    fold = history_html(history(Path(app.env.doc2path(docname))))
    section += nodes.raw("", fold, format="html")


def keep_description(app: Sphinx, document: nodes.document) -> None:
    """Keep the beginning of a page's first paragraph for search engines and links elsewhere."""
    section = document.next_node(nodes.section)
    if section is None:
        return
    for node in section.children:
        if isinstance(node, nodes.paragraph):
            text = textwrap.shorten(node.astext(), DESCRIPTION, placeholder=" …")
            app.env.metadata[app.env.docname]["og:description"] = text
            return


def write_description(
    app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: Any
) -> None:
    """Put the description into the page's head."""
    text = app.env.metadata.get(page, {}).get("og:description")
    if text:
        context["metatags"] += f'<meta name="description" content="{escape(text)}" />'


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the additions."""
    app.connect("doctree-read", keep_description)
    app.connect("html-page-context", write_description, priority=400)  # read by others at 500
    app.connect("doctree-resolved", add_facts)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
