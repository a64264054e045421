"""The book as bare Sphinx would build it: what `make bench` holds the course's own build against.

Bare is: MyST-NB, the table of contents, sphinx-design and the theme, on the same pages with the
same outputs, nothing executed. Left out is what the course adds: its directives and roles (their
bodies are rendered as they stand), evidence, ledger, replays, downloads, links of terms, MathML,
the mending of written pages, the archive and all checks of the site.
"""

import shutil
from pathlib import Path

import nbformat

from robo_genesis.page_cache import PageCache, notebooks_folder
from robo_genesis.pages import find_pages
from robo_genesis.sphinx_ext import fill_outputs

DIRECTIVES = (
    "cell-times", "choice", "course-map", "evidence", "glance", "ledger", "lesson-status",
    "replay", "takeaways",
)  # fmt: skip
ROLES = ("engine-release", "engine-source", "measured")
"""The course's own that its pages use. Sphinx runs with -W: one that is missing here fails it."""

CONFIG = f"""\
from docutils import nodes
from sphinx.util.docutils import SphinxDirective

project = "RoboGenesis"
author = copyright = "The RoboGenesis team"
language = "en"
extensions = ["myst_nb", "sphinx_external_toc", "sphinx_design", "sphinx_book_theme"]
html_theme = "sphinx_book_theme"
html_static_path = ["_static"]
exclude_patterns = ["_build", "_decisions"]
external_toc_path = "_toc.yml"
external_toc_exclude_missing = True
numfig = True
nb_execution_mode = "off"
nb_merge_streams = True
nb_render_markdown_format = "gfm"
myst_enable_extensions = [
    "amsmath", "attrs_block", "attrs_inline", "colon_fence", "deflist", "dollarmath",
    "substitution",
]
suppress_warnings = ["myst.xref_missing"]  # links to what the course's own directives make


class Body(SphinxDirective):
    has_content = True
    optional_arguments = 1
    final_argument_whitespace = True

    def run(self):
        node = nodes.container()
        self.state.nested_parse(self.content, self.content_offset, node)
        return [node]


def words(name, rawtext, text, lineno, inliner, options={{}}, content=[]):
    return [nodes.literal(rawtext, text)], []


def setup(app):
    for name in {DIRECTIVES}:
        app.add_directive(name, Body)
    for name in {ROLES}:
        app.add_role(name, words)
"""


def write_sources(book: Path, executed: Path, folder: Path) -> Path:
    """Write the sources of a bare build: the pages, executed ones as notebooks with their outputs.

    Args:
        book: the folder of the pages.
        executed: cache folder of the executed pages.
        folder: gets `conf.py`, the pages and what they include; it must not exist.

    Returns:
        The folder, which stands as far below its parent as `book` does, beside `robo_genesis`.

    Raises:
        KeyError: a page was not executed.
    """
    shutil.copytree(book, folder, ignore=shutil.ignore_patterns("_build*", "_decisions"))
    shutil.copytree(book.parent / "robo_genesis", folder.parent / "robo_genesis")
    cache = PageCache(notebooks_folder(executed))
    for page in find_pages(book):
        outputs = cache.get_cache_bundle(cache.match_cache_notebook(page.notebook).pk).nb
        fill_outputs(page.notebook, outputs)
        bare = folder / page.path.relative_to(book)
        nbformat.write(page.notebook, bare.with_suffix(".ipynb"))
        bare.unlink()
    (folder / "conf.py").write_text(CONFIG, "utf8")
    return folder
