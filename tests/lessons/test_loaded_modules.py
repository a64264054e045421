"""Evidence keys cover what a page can load by its imports; a build compares what it does load."""

import pytest

from robo_genesis.core.project import BOOK
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.sources import Tree, measuring_modules
from robo_genesis.pipeline.pages.syntax import PACKAGE


@pytest.mark.parametrize(
    "page", find_pages(BOOK), ids=lambda page: f"{page.lesson}-{page.page}"
)
def test_whatever_a_page_may_import_is_known_to_its_key(page):
    """Except what only judges a finished run, and the geometry, which is drawn alone."""
    imports = page.code.imports
    left_out = ("laws", "visual_shape")
    reached = Tree().closure(
        [f"{PACKAGE}.lessons.{page.lesson}.pages", *imports],
        enter=lambda name, path: not name.endswith(left_out),
    )
    own = (f"{PACKAGE}.sim.", f"{PACKAGE}.lessons.{page.lesson}.")
    computing = {
        name.removeprefix(f"{PACKAGE}.")
        for name, path in reached.items()
        if name.startswith(own) and Tree().measures(name, path)
    }
    assert {f"lessons.{page.lesson}.metrics", "sim.session"} <= computing
    assert computing <= measuring_modules(page.lesson, imports).keys()
