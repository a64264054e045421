"""Accept or refuse a bundle: whatever can be recomputed from its arrays is recomputed.

An accepted bundle has the evidence key of the current checkout.
"""

import json
import os
import shutil
import tempfile
from datetime import datetime
from functools import lru_cache, partial
from glob import glob
from pathlib import Path
from typing import Any

from robo_genesis.core import project
from robo_genesis.core.comparison import differences
from robo_genesis.core.files import derived, derived_value
from robo_genesis.core.git import git, git_or_none
from robo_genesis.core.scene import SEED
from robo_genesis.core.text import quoted
from robo_genesis.evidence import bundle, bundle_files, manifest_rules
from robo_genesis.evidence.manifest_rules import CLOCKS, MANIFEST
from robo_genesis.evidence.recompute import as_judged_today, recompute
from robo_genesis.evidence.refusals import BundleRefused, expect, unexpected
from robo_genesis.lessons import find_page
from robo_genesis.pipeline.pages import sources, syntax
from robo_genesis.sim import session

# The files of a commit that decide `question`.
DECIDING = ("book", "robo_genesis", "pyproject.toml", "requirements.lock")

SQUASHED = (
    "Merge the branch that recorded it without squashing, or record the bundle again."
)


def question(lesson: str, page: str, root: Path, book: Path) -> dict[str, Any]:
    """Return the fields that `bundle.evidence_key` covers, with the values of a checkout.

    Args:
        lesson: as the front matter of the page declares it.
        page: likewise.
        root: the checkout, for pin, lock and modules.
        book: the folder of the pages.

    Raises:
        BundleRefused: `lesson`, the book has no such page.
    """
    try:
        measuring = find_page(lesson, page)
    except LookupError as error:
        raise BundleRefused("lesson", f"manifest.json: {error}") from error
    digest, imports = page_code(lesson, page, book)
    locked = project.locked_versions((root / "requirements.lock").read_text("utf8"))
    if "quadrants" not in locked:
        raise project.ProjectError(
            "requirements.lock lacks quadrants. Run `make lock`."
        )
    return {
        "schema_version": bundle.SCHEMA_VERSION,
        "lesson": lesson,
        "page": page,
        "engine": {
            "version": project.engine_pin(root),
            "quadrants_version": locked["quadrants"],
            "precision": session.PRECISION,
        },
        "seed": SEED,
        "parameters": json.loads(json.dumps(measuring.parameters())),
        "source": {
            "page": digest,
            "modules": sources.measuring_modules(lesson, imports, root),
        },
    }


def page_code(lesson: str, page: str, book: Path) -> tuple[str, list[str]]:
    """Return the digest of the code cells of a page in the book, and what they import.

    Raises:
        BundleRefused: `lesson`, the book has no such page.
    """
    files = _page_files(book)
    inputs = [path.relative_to(book).as_posix().encode() for path in files]
    readers = [Path(syntax.__file__).with_name("book.py"), Path(syntax.__file__)]
    inputs += [path.read_bytes() for path in (*files, *readers)]
    listed = json.loads(derived("page-code", inputs, partial(_read_codes, book)))
    found = {(lesson, page): (digest, names) for lesson, page, digest, names in listed}
    if (lesson, page) not in found:
        wanted, pages = f"{lesson}/{page}", " or ".join(sorted(map("/".join, found)))
        remedy = "Put the bundle into the folder of its own lesson."
        expect("lesson", "manifest.json", "lesson and page", wanted, pages, remedy)
    return found[lesson, page]


def _page_files(book: Path) -> list[Path]:
    """Return the table of contents and every file that may be a page, also in linked folders."""
    found = glob(
        "**/*.md", root_dir=book, recursive=True
    )  # follows links, skips hidden names
    pages = sorted(
        name for name in found if not name.startswith(f"{project.PUBLISHED}{os.sep}")
    )
    return [*book.glob("_toc.yml"), *(book / name for name in pages)]


def _read_codes(book: Path) -> bytes:
    """Return lesson, page, digest and imports of each page that declares a bundle, as JSON.

    The reader of pages is imported here, because MyST-NB and Jupyter take longer to
    load than a whole verification.
    """
    from robo_genesis.pipeline.pages import book as pages

    found = [page for page in pages.find_pages(book) if page.declares_bundle]
    codes = [(p.lesson, p.page, pages.code_digest(p), p.code.imports) for p in found]
    return json.dumps(codes).encode()


def changed(
    manifest: bundle.Manifest, root: Path, book: Path
) -> list[tuple[str, Any, Any]] | None:
    """Return (path, recorded, current) of what differs; None if a bundle has the current key.

    Raises:
        BundleRefused: `lesson`, the book has no such page.
    """
    predicate = manifest.predicate.model_dump()
    current = question(predicate["lesson"], predicate["page"], root, book)
    if predicate["evidence_key"] == bundle.evidence_key(current):
        return None
    recorded = {name: predicate[name] for name in current}
    recorded["engine"] = {name: recorded["engine"][name] for name in current["engine"]}
    return list(differences(recorded, current))


def check_current(manifest: bundle.Manifest, root: Path, book: Path) -> None:
    """Require that a bundle has the evidence key of the checkout.

    Raises:
        BundleRefused: `stale`, with everything that differs; `lesson`.
    """
    found = changed(manifest, root, book)
    if found is None:
        return
    named = "; ".join(
        f"{path} is {quoted(here)}, expected {quoted(there)}"
        for path, here, there in found
    )
    raise BundleRefused(
        "stale",
        f"manifest.json: {named or 'evidence_key differs'}. The bundle answers an "
        f"older question. Record it again: `make evidence LESSON={manifest.predicate.lesson}`.",
    )


def check_commit(manifest: bundle.Manifest, root: Path) -> None:
    """Require that the commit that a bundle names is older than the run, and has its code.

    Code of a tree with changes is that of no commit. A shallow clone lacks older
    commits, and each clone those of a student's run on the CPU: these cannot be
    compared. A run of an accelerator is recorded at a commit of this repository.

    Raises:
        BundleRefused: `commit`; `time` for a run that ended before its commit.
    """
    predicate, recorded = manifest.predicate, manifest.predicate.git
    if recorded is None:
        return
    commit = recorded.commit
    shown = "--no-patch", "--format=format:%cI"
    made = git_or_none(root, "show", *shown, f"{commit}^{{commit}}", "--")
    if made is None:
        shallow = git_or_none(root, "rev-parse", "--is-shallow-repository")
        if shallow == "false\n" and predicate.backend.actual != "cpu":
            known = "one in the history of this repository"
            raise unexpected("commit", MANIFEST, "git.commit", commit, known, SQUASHED)
        return
    if datetime.fromisoformat(predicate.ended) < datetime.fromisoformat(made) - CLOCKS:
        raise unexpected(
            "time", MANIFEST, "ended", predicate.ended, f"after its commit, {made}"
        )
    if not recorded.dirty:
        inputs = [commit, predicate.evidence_key]
        found = derived_value(
            "commit", inputs, lambda: _changed_since(commit, manifest, root)
        )
        expect(
            "commit", MANIFEST, f"list of what differs from commit {commit}", found, []
        )


def _changed_since(commit: str, manifest: bundle.Manifest, root: Path) -> list[str]:
    """Return what is `changed` in a bundle since a commit."""
    if git_or_none(root, "diff", "--quiet", commit, "--", *DECIDING) is not None:
        return []
    with tempfile.TemporaryDirectory() as folder:
        archive, tree = Path(folder, "tree.zip"), Path(folder, "tree")
        git(root, "archive", "-0", f"--output={archive}", commit, "--", *DECIDING)
        shutil.unpack_archive(archive, tree)
        try:
            return [path for path, *_ in changed(manifest, tree, tree / "book") or ()]
        except (
            project.ProjectError,
            BundleRefused,
        ):  # today's code cannot read that tree
            return []


def verify_bundle(
    folder: Path,
    run_id: str | None = None,
    *,
    lesson: str | None = None,
    page: str | None = None,
    root: Path = project.ROOT,
    book: Path = project.BOOK,
    once: bool = False,
) -> bundle.Manifest:
    """Check one bundle against its files, the checkout and the pin.

    Damaged and false bundles are refused before `stale`, so that a stale bundle is
    sound.

    Args:
        folder: the bundle, named after its actual backend.
        run_id: the required run, None for any.
        lesson: the required lesson, None for any.
        page: the required page, None for any.
        root: the checkout, for pin, lock and modules.
        book: the folder of the pages.
        once: whether metrics and checks are not computed again if they were accepted
            before, with the same files of the bundle and the same code of the course.
            All other rules apply each time, and a refusal is not kept.

    Returns:
        The accepted manifest; its checks have today's verdicts.

    Raises:
        BundleRefused: with a code, and a message that names the found and the expected
            value.
        ProjectError, PageError: the checkout itself cannot be read.
    """
    present = bundle_files.scan(folder)
    manifest = bundle.read_manifest(folder)
    manifest_rules.check_identity(manifest, run_id, lesson, page)
    bundle_files.check_files(folder, present, manifest)
    if bundle.PRINTED in present:
        bundle.read_printed(folder)
    manifest_rules.check_circumstances(folder, manifest.predicate)
    manifest_rules.check_log(folder, manifest, root)
    check_current(manifest, root, book)
    check_commit(manifest, root)
    if once:
        contents = [(folder / name).read_bytes() for name in sorted(present)]
        inputs = [json.dumps(sorted(present)).encode(), *contents, _code()]
        derived("accepted", inputs, partial(recompute, folder, manifest))
    else:
        recompute(folder, manifest)
    return as_judged_today(manifest)


@lru_cache(maxsize=1)
def _code() -> bytes:
    """Return the whole code of the course and its data files."""
    files = sorted(
        path for path in (project.ROOT / "robo_genesis").rglob("*") if path.is_file()
    )
    return b"\0".join(
        path.read_bytes() for path in files if "__pycache__" not in path.parts
    )
