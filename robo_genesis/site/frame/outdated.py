"""What makes Sphinx read or write pages again, beside their sources and noted dependencies.

| what changed since the last render | what Sphinx does |
|---|---|
| code, packages, variables, executed pages, recorded evidence | begins from nothing |
| a page came or went | reads all pages |
| titles, targets, numbers or terms of any page | writes all pages |
| style sheets, scripts, templates | writes all pages |

A directive that shows what other pages contain calls `env.note_reread()`: its page is
read in each render.
"""

import shutil
from collections.abc import Set
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx
from sphinx.environment import CONFIG_OK, BuildEnvironment
from sphinx.environment.collectors.toctree import TocTreeCollector

from robo_genesis.core import project
from robo_genesis.core.files import files_below, files_digest, json_digest
from robo_genesis.pipeline import up_to_date
from robo_genesis.pipeline.bundles.status import recorded_folders
from robo_genesis.pipeline.command import collect_rarely
from robo_genesis.pipeline.pages.page_folder import RECORD
from robo_genesis.pipeline.pages.page_index import page_index
from robo_genesis.site.text.glossary import glossary_terms

SHARED = "robo_genesis_shared"  # The environment's attribute with the last `shared`


def inputs_of_all_pages(book: Path) -> str:
    """Return the digest of what decides every page beside the sources of the book.

    Args:
        book: the folder of the pages.
    """
    runs = [folder / RECORD for folder in page_index().folders.values()]
    recorded = [path for place in recorded_folders(book) for path in files_below(place)]
    results = files_digest(Path("/"), [*runs, *recorded])
    return json_digest([up_to_date.inputs_beside_pages(project.ROOT), results])


def begin(app: Sphinx) -> None:
    """Remove what an earlier render left, all of it if every page is rendered again.

    Pages contain digests of the style sheets, some of which are written after the
    pages.
    """
    site = Path(app.outdir)
    shutil.rmtree(site / "_static", ignore_errors=True)
    if app.env.config_status != CONFIG_OK:
        shutil.rmtree(site, ignore_errors=True)
        site.mkdir(parents=True)


def pages_to_read(
    app: Sphinx,
    env: BuildEnvironment,
    added: Set[str],
    changed: Set[str],
    removed: Set[str],
) -> Set[str]:
    """Return all pages if one came or went: others link to it or say that there is none."""
    return env.found_docs - added if added or removed else set()


def pages_to_write(app: Sphinx, env: BuildEnvironment) -> Set[str]:
    """Return all pages if one shows the others something new.

    Without any page, Sphinx would not write the style sheets again.
    """
    before, now = getattr(env, SHARED, None), shared(env)
    setattr(env, SHARED, now)
    return {env.config.root_doc} if before == now else env.found_docs


def shared(env: BuildEnvironment) -> str:
    """Return what pages show of one another: names, targets, numbers and terms."""
    standard, math = env.domaindata["std"], env.domaindata["math"]
    titles = {name: title.pformat() for name, title in env.titles.items()}
    parts: list[dict[Any, Any]] = [titles, env.toctree_includes, env.toc_fignumbers]
    parts += [standard[name] for name in ("labels", "anonlabels", "objects", "terms")]
    parts += [math["objects"], glossary_terms(env)]
    return repr([sorted(part.items()) for part in parts])


COUNT_THROUGH = TocTreeCollector.assign_figure_numbers


def count_by_page(collector: TocTreeCollector, env: BuildEnvironment) -> list[str]:
    """Number figures, tables, code and equations of each page from one.

    `pages_to_write` finds the pages that show other numbers than before.
    """
    COUNT_THROUGH(collector, env)
    for kinds in env.toc_fignumbers.values():
        for numbers in kinds.values():
            numbers |= {name: (n,) for n, name in enumerate(numbers, 1)}
    return []


def setup(app: Sphinx) -> None:
    """Register the steps."""
    collect_rarely()
    book, static = Path(app.srcdir), Path(app.srcdir) / "_static"
    app.add_config_value("all_inputs", inputs_of_all_pages(book), "env")
    looks = files_digest(static, files_below(static))
    app.add_config_value("all_looks", looks, "html")
    app.connect("builder-inited", begin, priority=0)
    app.connect("env-get-outdated", pages_to_read)
    TocTreeCollector.assign_figure_numbers = count_by_page  # type: ignore[assignment,method-assign]
    app.connect("env-get-updated", pages_to_write, priority=900)  # after the numbers
