"""Makes an incremental render equal to one from nothing; `build.site.kept` keeps its folder.

A page depends on its own source, on what is the same for all pages, and on this:

| while it is read | what happens |
|---|---|
| another page's source, included or read by a directive (`note_dependency`) | it is read again |

| while it is written | what happens |
|---|---|
| titles, contents, targets, equations, terms, ledger items of any page | all are written again |

A page does not depend on the pictures that Sphinx itself writes while it reads: they
follow from runs, whose change empties the folder. Reading another page may write an
equal picture again.

Files that pages leave beside the HTML are removed with the last page that left them.
"""

import hashlib
import os
import shutil
from collections.abc import Iterator, Mapping, Set
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.environment.collectors.toctree import TocTreeCollector

from robo_genesis.pipeline.html.kept import UNFIT
from robo_genesis.site.text.glossary import glossary_terms

REPLAYS, TAKEAWAYS = "replay", "takeaways"  # Folders of such files in the site

# Metadata of a page: see `keep_numbers` and `note_files`.
NUMBERS, FILES = "robo_genesis_numbers", "robo_genesis_files"

# Metadata of a page that no other page shows.
OWN = {"og:description", "source_map", "wordcount", NUMBERS, FILES}

# Attributes of the environment that pages show of one another, beside metadata and
# terms.
SHOWN = (
    "titles",
    "longtitles",
    "tocs",
    "toc_secnumbers",
    "toc_fignumbers",
    "toctree_includes",
    "domaindata",
)


def keep_numbers(app: Sphinx, doctree: nodes.document) -> None:
    """Keep the numbers of a page's figures, tables, code and equations, which begin at one."""
    kinds: dict[str, dict[str, tuple[int, ...]]] = {}
    for node in doctree.findall(
        lambda n: isinstance(n, nodes.Element) and bool(n["ids"])
    ):
        if kind := numbered_kind(app.env, node):
            numbers = kinds.setdefault(kind, {})
            numbers[node["ids"][0]] = (len(numbers) + 1,)
    app.env.metadata[app.env.docname][NUMBERS] = kinds


def numbered_kind(env: BuildEnvironment, node: nodes.Node) -> str | None:
    """Return as what a node is numbered; figures, tables and code are if they have a caption."""
    standard, math = env.domains["std"], env.domains["math"]
    captioned = standard.get_numfig_title(node) is not None
    return (standard if captioned else math).get_enumerable_node_type(node)


def number_by_page(collector: TocTreeCollector, env: BuildEnvironment) -> list[str]:
    """Number each page by itself; Sphinx counts through a book, and loads all doctrees for it."""
    pages = env.metadata.items()
    env.toc_fignumbers = {
        name: page[NUMBERS] for name, page in pages if NUMBERS in page
    }
    return []  # `outdated_pages` finds the pages that show other numbers


def including_pages(
    app: Sphinx,
    env: BuildEnvironment,
    added: Set[str],
    changed: Set[str],
    removed: Set[str],
) -> list[str]:
    """Return the pages that read the source of a changed page."""
    sources = {str(env.doc2path(name, base=False)) for name in (*added, *changed)}
    return [name for name, files in env.dependencies.items() if sources & files]


def forget_own_pictures(app: Sphinx, doctree: nodes.document) -> None:
    """Forget that a page depends on files that Sphinx wrote while it read the page."""
    folder, files = os.path.dirname(app.outdir), app.env.dependencies[app.env.docname]
    files -= {
        file
        for file in files
        if os.path.normpath(os.path.join(app.srcdir, file)).startswith(folder + os.sep)
    }


def note_reading(app: Sphinx, env: BuildEnvironment, names: list[str]) -> None:
    """Note which pages are read in this build."""
    vars(app.builder)["robo_genesis_reads"] = list(names)


def outdated_pages(app: Sphinx, env: BuildEnvironment) -> list[str]:
    """Choose the pages to write: those that were read, or all if one shows others something new."""
    shown = hashlib.sha256(repr(sorted(_shown(env))).encode()).hexdigest()
    before, vars(env)["robo_genesis_shown"] = vars(env).get("robo_genesis_shown"), shown
    reads: list[str] = vars(app.builder)["robo_genesis_reads"]
    pages = reads if before == shown else sorted(env.found_docs)
    # Without any page, Sphinx would write no style sheet.
    chosen = vars(app.builder)["robo_genesis_writes"] = pages or [env.config.root_doc]
    return chosen


def _shown(env: BuildEnvironment) -> Iterator[tuple[str, Any]]:
    for name in SHOWN:
        yield name, plain(vars(env).get(name))
    for page, metadata in env.metadata.items():
        yield (
            f"metadata {page}",
            plain({k: v for k, v in metadata.items() if k not in OWN}),
        )
    yield "terms", plain(glossary_terms(env))


def plain(value: Any) -> Any:
    """Return a value in a form whose text depends on nothing but its content."""
    if isinstance(value, nodes.Node):
        return value.pformat()
    if isinstance(value, Mapping):
        return sorted((repr(key), plain(item)) for key, item in value.items())
    if isinstance(value, Set):
        return sorted(map(repr, value))
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return repr(value)


def drop_static_files(app: Sphinx) -> None:
    """Remove the style sheets and scripts before any is written: pages contain their digests.

    An extension may write a sheet after the pages that name it, so a page that is
    written again would find the digest of a sheet that a page from nothing does not
    find.
    """
    shutil.rmtree(Path(app.outdir) / "_static", ignore_errors=True)


def drop_downloads(app: Sphinx, builder: Any) -> None:
    """Remove all downloads before pages are written: Sphinx and the ledger write all again."""
    shutil.rmtree(Path(builder.outdir) / "_downloads", ignore_errors=True)


def write_chosen(app: Sphinx, builder: Any) -> None:
    """Keep Sphinx from writing also the parents of a changed page, and always the home page."""

    def prepare(names: set[str]) -> None:
        names.intersection_update(vars(builder)["robo_genesis_writes"])
        type(builder).prepare_writing(builder, names)

    builder.prepare_writing = prepare


def finish(app: Sphinx, error: Exception | None) -> None:
    """Remove the pictures that no page shows any more, and report what cannot be kept.

    The names of pictures with equal file names depend on the order in which they were
    read.
    """
    if error is not None:
        return
    named = {name: file for file, (_, name) in app.env.images.items()}
    for path in (Path(app.outdir) / "_images").glob("*"):
        if path.is_file() and path.name not in named:
            path.unlink()
    if any(os.path.basename(file) != name for name, file in named.items()):
        (Path(app.outdir).parents[1] / UNFIT).touch()


def note_files(env: BuildEnvironment, *files: Path) -> None:
    """Note that the page that is read writes some files."""
    env.metadata[env.docname].setdefault(FILES, set()).update(map(str, files))


def remove_others(app: Sphinx, env: BuildEnvironment) -> list[str]:
    """Remove the files that no page writes any more, and folders that become empty."""
    noted = set().union(*(page.get(FILES, ()) for page in env.metadata.values()))
    for folder in (Path(app.outdir) / REPLAYS, Path(app.outdir) / TAKEAWAYS):
        for path in sorted(
            [*folder.rglob("*"), folder], reverse=True
        ):  # a folder comes last
            if path.is_file() and str(path) not in noted:
                path.unlink()
            elif path.is_dir() and not any(path.iterdir()):
                path.rmdir()
    return []


def setup(app: Sphinx) -> None:
    """Register the steps."""
    app.connect("env-updated", remove_others)
    app.connect("builder-inited", drop_static_files, priority=0)
    app.connect("env-get-outdated", including_pages)
    app.connect("env-before-read-docs", note_reading)
    app.connect(
        "doctree-read", forget_own_pictures, priority=900
    )  # after they are collected
    app.connect(
        "doctree-read", keep_numbers, priority=950
    )  # after the others, which may add ids
    TocTreeCollector.assign_figure_numbers = number_by_page  # type: ignore[assignment,method-assign]
    app.connect(
        "env-get-updated", outdated_pages, priority=900
    )  # after figures have numbers
    app.connect("write-started", drop_downloads)
    app.connect("write-started", write_chosen)
    app.connect("build-finished", finish)
