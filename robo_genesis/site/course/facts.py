"""A page's minutes below its title, its Git history at its end, and its description.

The minutes are counted when a page is read; the home page shows those of other pages.
"""

import textwrap
from dataclasses import dataclass
from functools import lru_cache
from html import escape
from itertools import islice
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx

from robo_genesis.core.git import git_or_none
from robo_genesis.site.evidence.origin import above
from robo_genesis.site.evidence.plain_nodes import html
from robo_genesis.site.text.question_nodes import question

WORDS_A_MINUTE = 200  # A slow pace, for technical prose; code, tables and formulas are not counted
LINES_A_MINUTE = 10  # The pace of somebody who runs and changes visible code
MINUTES_A_QUESTION = 2
MINUTES_A_FUNCTION = 10  # An estimate of the time to write a function until its test passes
MINUTES_A_RUN = 5
"""An estimate of the time of one run of a lab, in which the engine compiles its kernels."""
MINUTES_A_SHEET = 10  # An estimate of the time to fill in a work sheet
STUB = "raise NotImplementedError"  # Occurs in a cell with a function that the reader writes
COMMITS = 6  # Number of the latest commits of a page that are listed
DESCRIPTION = 200  # Longest description, in characters: search engines show about as many
SOURCE = "cell_code_source"  # What MyST-NB calls the code of a cell
HIDDEN = {"hide-cell", "hide-input", "remove-cell", "remove-input"}
"""Tags of cells whose code is not visible."""
LAB, WORK_SHEET = "lab", "worksheet.md"
"""The name of a lesson's lab, and the file with its work sheet."""
MINUTES = "minutes"  # The name of the time in a page's metadata
UNCOUNTED = (nodes.literal_block, nodes.table, nodes.math, nodes.math_block, nodes.raw)


def count_words(document: nodes.document) -> int:
    """Return the number of words in a page's running text, headings and captions included."""
    return sum(
        len(text.astext().split())
        for text in document.findall(nodes.Text)
        if not any(isinstance(node, UNCOUNTED) for node in above(text))
    )


def work_minutes(lines: int, questions: int, functions: int, sheet: bool) -> float:
    """Return the time for what a reader does on a page besides reading it [min].

    Args:
        lines: visible lines of code, which a reader runs and changes.
        questions: to answer.
        functions: to write; a page with any is also run.
        sheet: whether the page has a work sheet.
    """
    written = functions * MINUTES_A_FUNCTION + bool(functions) * MINUTES_A_RUN
    asked = questions * MINUTES_A_QUESTION + sheet * MINUTES_A_SHEET
    return lines / LINES_A_MINUTE + written + asked


def has_sheet(page: Path) -> bool:
    """Return whether a page is a lab with a work sheet in its folder."""
    return page.stem == LAB and page.with_name(WORK_SHEET).is_file()


@dataclass(frozen=True, slots=True)
class Minutes:
    """The time that a page takes, in whole minutes: to read it, and for its code and questions.

    `sheet` is true if the work includes a work sheet.
    """

    read: int
    work: int
    sheet: bool = False

    def __str__(self) -> str:
        total = self.read + self.work
        if self.sheet:
            return f"{5 * round(total / 5)} min with the work sheet"
        if self.work:
            return f"{total} min ({self.read} to read, {self.work} for code and questions)"
        return f"{total} min to read"


def count_minutes(document: nodes.document, page: Path) -> Minutes:
    """Return the time that a page takes.

    Args:
        document: the page as it was read.
        page: its source file.
    """
    lines = functions = 0
    for part in document.findall(nodes.container):
        if part.get("nb_element") != SOURCE:
            continue
        cells = (node for node in above(part) if "cell_metadata" in node)
        if not any(HIDDEN.intersection(cell["cell_metadata"].get("tags", ())) for cell in cells):
            lines += sum(bool(line.strip()) for line in part.astext().splitlines())
            functions += STUB in part.astext()
    questions, sheet = len(list(document.findall(question))), has_sheet(page)
    read = max(1, round(count_words(document) / WORDS_A_MINUTE))
    return Minutes(read, round(work_minutes(lines, questions, functions, sheet)), sheet)


@lru_cache(maxsize=8)
def _why_unknown(folder: Path) -> str:
    """Return why a folder's history cannot be read, an empty text where it can."""
    shallow = git_or_none(folder, "rev-parse", "--is-shallow-repository")
    if shallow is None:
        return "There was no Git, or no Git history of this page, where this site was built."
    if shallow.strip() == "true":
        return "This site was built from a shallow clone, which has no history."
    return ""


def history_html(file: Path) -> str:
    """Return the latest commits that touched a file as a fold, or why they are not known."""
    folder, name = file.parent, file.name
    unknown = _why_unknown(folder)
    log = ("log", f"-n{COMMITS}", "--format=%cs%x09%s", "--", name)
    commits = [] if unknown else (git_or_none(folder, *log) or "").splitlines()
    if commits:
        rows = (
            f'<li><time datetime="{day}">{day}</time> {escape(subject)}</li>'
            for day, _, subject in (line.partition("\t") for line in commits)
        )
        body = f"<ul>{''.join(rows)}</ul>"
        if git_or_none(folder, "status", "--porcelain", "--", name):
            body += "<p>The page has changes that are in no commit yet.</p>"
    else:
        body = f"<p>Not known. {unknown or 'The page is in no commit yet.'}</p>"
    return f'<details class="page-history"><summary>History of this page</summary>{body}</details>'


def add_facts(app: Sphinx, document: nodes.document, docname: str) -> None:
    """Insert the time below the title, except on the home page, and the history at the end."""
    section = document.next_node(nodes.section)
    if docname != app.config.root_doc:
        time = f"About {app.env.metadata[docname][MINUTES]}."
        section.insert(1, nodes.paragraph("", time, classes=["page-facts"]))
    section += html(history_html(Path(app.env.doc2path(docname))))


def keep_facts(app: Sphinx, document: nodes.document) -> None:
    """Keep the time that a page takes, before lines of provenance are added to its text.

    The beginning of its first paragraph is kept for search engines and link previews.
    """
    facts: dict[str, Any] = app.env.metadata[app.env.docname]
    facts[MINUTES] = count_minutes(document, Path(app.env.doc2path(app.env.docname)))
    section = document.next_node(nodes.section)
    paragraphs = (n for n in section or () if isinstance(n, nodes.paragraph))
    for node in islice(paragraphs, 1):
        facts["og:description"] = textwrap.shorten(node.astext(), DESCRIPTION, placeholder=" …")


def write_description(
    app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: Any
) -> None:
    """Write the description into the page's head."""
    if text := app.env.metadata.get(page, {}).get("og:description"):
        context["metatags"] += f'<meta name="description" content="{escape(text)}" />'


def setup(app: Sphinx) -> None:
    """Register the additions."""
    app.connect("doctree-read", keep_facts)
    app.connect("html-page-context", write_description, priority=400)  # read by others at 500
    app.connect("doctree-resolved", add_facts)
