"""Publish a rendered site in one move: built beside the old one, swapped in by renames."""

import os
import shutil
from collections.abc import Callable, Iterable
from pathlib import Path

from robo_genesis.core.files import replaced
from robo_genesis.core.project import PUBLISHED
from robo_genesis.pipeline.pages.results import PageResult

from .archive import pack


def publish(
    book: Path,
    rendered: Path,
    results: Iterable[PageResult],
    finish: Callable[[Path], None],
) -> Path:
    """Replace the published site and its pages' bundles by new ones, which everybody may read.

    A web server has a user of its own, so the modes do not depend on the umask.

    Args:
        book: the folder that holds `_build`.
        rendered: the pages as Sphinx wrote them.
        results: the executed pages. Their bundles are published beside the site: those
            of labs as `evidence/<lesson>/<backend>`, others as
            `pages/<lesson>/<page>/<backend>`.
        finish: called with the complete folder before it is put in place; what it
            raises leaves the old site.

    Returns:
        The folder of the published site's HTML.
    """
    with replaced(book / PUBLISHED) as site:
        # Sphinx's note for its next build
        html = shutil.copytree(
            rendered, site / "html", ignore=shutil.ignore_patterns(".buildinfo")
        )
        for result in results:
            if bundle := result.bundle:
                lesson, page = result.page.lesson, result.page.page
                own = (
                    f"evidence/{lesson}" if page == "lab" else f"pages/{lesson}/{page}"
                )
                shutil.copytree(bundle, site / own / bundle.name)
        # Without it, GitHub leaves out folders that begin with an underscore.
        (html / ".nojekyll").touch()
        pack(html)
        finish(site)
        for here, _, files in os.walk(site):
            os.chmod(here, 0o755)
            for name in files:
                os.chmod(os.path.join(here, name), 0o644)
    return book / PUBLISHED / "html"
