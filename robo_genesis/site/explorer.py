"""The step explorer on a page that did not run its grid: ```` ```{explorer} l04/batch ````.

All runs of the grid come from the bundle of the page that ran them.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robo_genesis.core import project
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.files import derived
from robo_genesis.core.shown import ShownError, find
from robo_genesis.evidence import bundle
from robo_genesis.pipeline.pages.bound import accepted_experiment
from robo_genesis.pipeline.pages.built import page_outputs
from robo_genesis.site.evidence.measured import BACKEND


class ExplorerDirective(SphinxDirective):
    """Show the runs of a page's bundle of this build, one at a time."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return the explorer.

        Errors: the page has no bundle, or its lesson has no explorer.
        """
        lesson_page = self.arguments[0]
        folder = bundle_of(self, lesson_page)
        try:
            html = explorer_html(lesson_page.split("/")[0], folder)
        except ShownError as error:
            raise self.error(f"explorer: {lesson_page}: {error}") from error
        run = f"{lesson_page}/{BACKEND}"
        block = nodes.container(classes=["explorer-block"], evidence_runs=(run,))
        block += nodes.raw("", html, format="html")
        return [block]


def bundle_of(directive: SphinxDirective, lesson_page: str) -> Path:
    """Return the folder of the bundle that a page wrote in this build.

    Raises:
        DirectiveError: it has none.
    """
    folder = page_outputs(lesson_page) / BACKEND
    if not (folder / "manifest.json").is_file():
        raise directive.error(f"{directive.name}: {lesson_page} has no bundle on {BACKEND}.")
    return folder


def of_lesson(directive: SphinxDirective, function: str) -> tuple[Path, Experiment, Any]:
    """Return what a directive shows whose arguments are a page and a name: `l05/cameras world`.

    Args:
        directive: the directive.
        function: in the lesson's `explorer`; it gets the experiment and the name.

    Returns:
        The folder of the page's bundle, its experiment, and the result of the function.

    Raises:
        DirectiveError: there is no bundle, function, or thing of this name.
    """
    lesson_page, name = directive.arguments
    folder = bundle_of(directive, lesson_page)
    try:
        found = find(f"robo_genesis.lessons.{lesson_page.split('/')[0]}.explorer.{function}")
        experiment = accepted_experiment(folder, bundle.read_manifest(folder))
        return folder, experiment, found(experiment, name)
    except (ShownError, LookupError, ValueError) as error:
        raise directive.error(f"{directive.name}: {lesson_page} {name}: {error}") from error


def explorer_html(lesson: str, folder: Path) -> str:
    """Return the markup of a lesson's explorer for the experiment of an accepted bundle.

    Raises:
        ShownError: the lesson has no explorer.
    """
    markup = find(f"robo_genesis.lessons.{lesson}.explorer.markup")

    def make() -> bytes:
        experiment = accepted_experiment(folder, bundle.read_manifest(folder))
        return str(markup(experiment)).encode()

    return derived("explorer", inputs(folder), make).decode()


def inputs(folder: Path) -> Iterator[bytes]:
    """Yield everything that determines what is made of a bundle."""
    sources = (project.ROOT / "robo_genesis").rglob("*.py")
    files = (path for path in folder.rglob("*") if path.is_file())
    for path in sorted([*files, *sources]):
        yield path.read_bytes()


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("explorer", ExplorerDirective)
