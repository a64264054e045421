"""Sphinx reads executed pages and runs nothing."""

from pathlib import Path

import myst_nb.sphinx_
from myst_nb.core.execute.base import NotebookClientBase
from nbformat import NotebookNode
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

from robo_genesis.pipeline.pages.book import code_cells, code_of
from robo_genesis.pipeline.pages.outputs import shown_outputs
from robo_genesis.pipeline.pages.page_index import executed_notebook

# Of each page that was read, the cells whose outputs but streams `page.show` displayed.
RECOMPUTED: dict[str, set[int]] = {}


class ExecutedPage(NotebookClientBase):
    """Takes a page's outputs from the execution stage; replaces every client of myst-nb.

    The cells keep their metadata (tags, captions, alt texts), which the page states
    today. `sources` is the folder of the pages.
    """

    sources: Path

    def start_client(self) -> None:
        """Copy the stored outputs and execution counts into the notebook.

        Raises:
            ExtensionError: the execution stage has no outputs for the page's code
                cells.
        """
        try:
            page = Path(self.path).relative_to(self.sources).with_suffix("")
            executed = executed_notebook(page.as_posix(), self.notebook)
        except KeyError:
            executed = None
        if not executed or code_of(executed).digests != code_of(self.notebook).digests:
            raise ExtensionError(
                f"{self.path} is not executed, and Sphinx executes nothing. Build with `make book`."
            )
        cells = zip(code_cells(self.notebook), executed.cells, strict=True)
        for cell, ran in cells:
            cell.outputs = [*map(without_stack, ran.outputs)]
            cell.execution_count = ran.execution_count
        RECOMPUTED[page.as_posix()] = {
            index
            for index, cell in enumerate(self.notebook.cells)
            if shown_outputs(cell)
            == [out for out in cell.get("outputs", []) if "data" in out]
        }
        if "language_info" in executed.metadata:
            self.notebook.metadata["language_info"] = executed.metadata["language_info"]


def without_stack(output: NotebookNode) -> NotebookNode:
    """Return an output; of an expected error only the last line, as its stack has private paths."""
    if output.output_type == "error":
        return NotebookNode(output | {"traceback": output.traceback[-1:]})
    return output


def setup(app: Sphinx) -> None:
    """Register the extension."""
    ExecutedPage.sources = Path(app.srcdir)
    myst_nb.sphinx_.create_client = lambda *arguments: ExecutedPage(*arguments[:4])
    # Jupyter Book always sets this value, also where sphinx_comments is not an
    # extension.
    app.add_config_value("comments_config", None, "html")
