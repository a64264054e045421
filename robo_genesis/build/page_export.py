"""Executed pages as files, so that one machine executes them and another builds the site.

<page>/page.json        which page, fingerprint, code and run, and a digest of each other file
<page>/executed.ipynb   the page's code cells with their outputs
<page>/outputs/         what the run left beside them: the evidence bundle and the page's own files
"""

import os
import shutil
import stat
from pathlib import Path

import nbformat

from robo_genesis.build.page_cache import PageCache, notebooks_folder, outputs_folder
from robo_genesis.build.page_results import PageResult
from robo_genesis.core.files import NEXT, beside, settle, swap
from robo_genesis.evidence.bundle import RunId, Sha256, Strict, sha256
from robo_genesis.lessons.book_pages import Page, code_digest

RECORD, NOTEBOOK, OUTPUTS = "page.json", "executed.ipynb", "outputs"
SIZE_LIMIT = 64 * 2**20
"""Bytes of one file; those of a lesson have under 2 MiB."""
FILES_LIMIT = 500


class HandoverError(Exception):
    """Executed pages cannot be handed over or taken over; nothing was changed."""


class Record(Strict):
    """`page.json`: what was executed, and the files that it left.

    `fingerprint` names all that decides outputs apart from the page's own code, `code` is the
    digest of that, `seconds` what the execution took, `files` maps names to their digests.
    """

    docname: str
    fingerprint: str
    code: Sha256
    run_id: RunId
    seconds: float | None
    files: dict[str, Sha256]


def hand_over(result: PageResult, folder: Path, to: Path) -> Path:
    """Write one executed page as files, whole or not at all.

    Args:
        result: what came of the page; it did not fail.
        folder: the cache folder of the pages, named by their fingerprint.
        to: gets a folder named by the page, in the place of an older one.

    Returns:
        The page's folder.

    Raises:
        HandoverError: something else stands there.
        OSError: it cannot be written.
    """
    page, place = result.page, to / result.page.docname.replace("/", "--")
    if place.exists() and not (place / RECORD).is_file():
        raise HandoverError(
            f"{place} is no executed page. Move it away, or name another TO=folder."
        )
    to.mkdir(parents=True, exist_ok=True)
    cache = PageCache(notebooks_folder(folder))
    cached = cache.get_cache_bundle(cache.match_cache_notebook(page.notebook).pk)
    settle(place)
    fresh = beside(place, NEXT)
    try:
        fresh.mkdir()
        nbformat.write(cached.nb, fresh / NOTEBOOK)
        if page.declares_bundle:
            shutil.copytree(
                own_outputs(outputs_folder(folder), page), own_outputs(fresh / OUTPUTS, page)
            )
        record = Record(
            docname=page.docname,
            fingerprint=folder.name,
            code=code_digest(page),
            run_id=result.run_id,
            seconds=cached.record.data.get("execution_seconds"),
            files={name: sha256(fresh / name) for name in sorted(plain_files(fresh))},
        )
        (fresh / RECORD).write_text(record.model_dump_json(indent=1), encoding="utf8")
        swap(place)
    finally:
        settle(place)
    return place


def plain_files(folder: Path) -> list[str]:
    """Return the names of the files below a folder.

    Raises:
        HandoverError: one is no plain file or too big, or they are too many. None was opened.
    """
    names: list[str] = []
    for here, folders, files in os.walk(folder):
        for path in (Path(here, name) for name in (*folders, *files)):
            found, name = path.lstat(), path.relative_to(folder).as_posix()
            if stat.S_ISDIR(found.st_mode):
                continue
            if not stat.S_ISREG(found.st_mode):
                raise HandoverError(
                    f"{name} is a link or device. Only plain files are handed over."
                )
            if found.st_size > SIZE_LIMIT or len(names) == FILES_LIMIT:
                raise HandoverError(
                    f"{name} is too much: at most {FILES_LIMIT} files are handed over, of at most "
                    f"{SIZE_LIMIT} bytes each. Let the page leave less."
                )
            names.append(name)
    return names


def own_outputs(outputs: Path, page: Page) -> Path:
    """Return where a page with a bundle leaves its files, below the outputs of all pages."""
    return outputs / str(page.lesson) / str(page.page)
