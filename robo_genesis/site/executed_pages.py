"""Sphinx reads executed pages and runs nothing; math is MathML; no page asks a third party."""

import os
import re
from typing import Any

import myst_nb.sphinx_
from myst_nb.core.execute.base import NotebookClientBase
from nbformat import NotebookNode
from sphinx.application import Sphinx
from sphinx.config import Config
from sphinx.errors import ExtensionError

from robo_genesis.build.page_cache import PageCache
from robo_genesis.site import mathml

PAGE_CACHE = "ROBO_GENESIS_PAGE_CACHE"
BUILD_OUTPUTS = "ROBO_GENESIS_BUILD_OUTPUTS"
ELSEWHERE = re.compile(r"^(?:[a-z]+:)?//", re.IGNORECASE)


class ExecutedPage(NotebookClientBase):
    """Takes a page's outputs from the execution stage; stands in for all clients of myst-nb.

    myst-nb's own cache client would start a kernel where outputs are missing, and would replace the
    cells' metadata (tags, captions, alt texts) by those of the day the page was executed.
    """

    def start_client(self) -> None:
        """Put the cached outputs into the notebook.

        Raises:
            ExtensionError: the execution stage has no outputs for the page's code cells.
        """
        cache = PageCache(self.nb_config.execution_cache_path)
        try:
            record = cache.match_cache_notebook(self.notebook)
            executed = cache.get_cache_bundle(record.pk).nb
        except KeyError:
            raise ExtensionError(
                f"{self.path} is not executed, and Sphinx executes nothing. "
                "Build with `make book`; if you did, a code cell is nested in another directive."
            ) from None
        fill_outputs(self.notebook, executed)
        self.exec_metadata = {
            "mtime": record.created.timestamp(),
            "runtime": record.data.get("execution_seconds"),
            "method": "cache",
            "succeeded": True,
            "error": None,
            "traceback": None,
        }


def fill_outputs(notebook: NotebookNode, executed: NotebookNode) -> None:
    """Copy outputs and execution counts into a notebook with the same code cells, in place."""
    ran = iter(executed.cells)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            source = next(ran)
            cell.outputs, cell.execution_count = source.outputs, source.execution_count
            if "raises-exception" in cell.metadata.get("tags", []):
                for output in cell.outputs:
                    shorten_traceback(output)
    if "language_info" in executed.metadata:
        notebook.metadata["language_info"] = executed.metadata["language_info"]


def shorten_traceback(output: NotebookNode) -> None:
    """Keep the exception's own line of an expected error; its stack names paths of the builder."""
    if output.output_type == "error":
        output.traceback = output.traceback[-1:]


def read_executed_page(
    notebook: NotebookNode, source: str, nb_config: Any, logger: Any, read_fmt: Any = None
) -> NotebookClientBase:
    """Return the client for a page; takes the place of myst-nb's `create_client`."""
    return ExecutedPage(notebook, source, nb_config, logger, read_fmt=read_fmt)


def use_executed_pages(app: Sphinx, config: Config) -> None:
    """Point myst-nb to the execution stage's folder, which the build names in the environment.

    Raises:
        ExtensionError: the environment names no folder.
    """
    if PAGE_CACHE not in os.environ:
        raise ExtensionError(f"{PAGE_CACHE} is not set. Build the site with `make book`.")
    config.nb_execution_mode = "cache"
    config.nb_execution_cache_path = os.environ[PAGE_CACHE]


def drop_third_parties(
    app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: Any
) -> None:
    """Remove scripts and styles with an address elsewhere that other extensions registered."""
    for name in ("script_files", "css_files"):
        files = context.get(name, [])
        context[name] = [file for file in files if not ELSEWHERE.match(address(file))]


def address(file: Any) -> str:
    """Return where a script or style comes from; Sphinx has plain strings and asset objects."""
    return str(getattr(file, "filename", file) or "")


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the extension; see the module's summary."""
    myst_nb.sphinx_.create_client = read_executed_page
    # Jupyter Book sets this one always, also where sphinx_comments is left out.
    app.add_config_value("comments_config", None, "html")
    app.connect("config-inited", use_executed_pages)
    app.connect("html-page-context", drop_third_parties, priority=900)
    mathml.register(app)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
