"""The state of a lesson's evidence, computed in this one place and nowhere set by hand."""

import os
from dataclasses import dataclass
from pathlib import Path

from robo_genesis import project
from robo_genesis.checks import CHECKS
from robo_genesis.evidence.bundle import BundleRefused, Manifest
from robo_genesis.evidence.verify import verify_bundle

RECORDED_PAGE = "lab"
"""Only labs are recorded on accelerators and kept in the repository."""

STATE_OF_CODE = {"stale": "stale", "older-schema": "stale", "failed": "failed"}
"""Refusals that are a state of their own; every other code is `refused`."""

PASSING = ("verified", "missing", "stale")
"""States that a build goes on with; without `verified` a panel stands in the figures' place."""


@dataclass(frozen=True, slots=True)
class Status:
    """State of one page's bundle on one backend.

    | state | means |
    |---|---|
    | `verified` | accepted; `manifest` is given |
    | `missing` | no bundle stands there |
    | `stale` | honest, but of an older form, or the answer to an older question |
    | `failed` | sound, and its own checks did not pass |
    | `refused` | damaged, mislabelled, incomplete or of an unknown form |

    `code` is that of the refusal, None where there was none; `reason` names expected and found.
    """

    state: str
    backend: str
    reason: str
    manifest: Manifest | None
    code: str | None = None

    @property
    def sentence(self) -> str:
        """Say what was run, for a reader."""
        if self.manifest is None:
            return f"{self.backend}: {self.state}. {self.reason}"
        predicate = self.manifest.predicate
        render = predicate.render
        kernel = "Clean kernel" if predicate.command.startswith("make ") else "Run by hand"
        passed = sum(check.passed for check in predicate.checks)
        camera = f"camera frames by {render.renderer}" if render.mode == "camera" else "camera SKIP"
        return (
            f"{self.backend}: {self.state}. {kernel}, Genesis {predicate.engine.version}, "
            f"{passed} of {len(CHECKS)} checks passed, {camera}, measured {predicate.started[:10]}."
        )


def page_status(
    outputs: Path, lesson: str, page: str, backend: str, book: Path = project.BOOK
) -> Status:
    """Return the state of one bundle below the outputs folder of a build of a book."""
    absent = f"No bundle was recorded for {lesson}/{page}."
    return bundle_status(outputs / lesson / page / backend, lesson, page, absent, book)


def recorded_status(book: Path, lesson: str, backend: str) -> Status:
    """Return the state of the lab's bundle that was recorded on a backend and committed."""
    absent = f"No run on this backend is recorded for Genesis {project.engine_pin()}."
    folder = book / "evidence" / lesson / backend
    return bundle_status(folder, lesson, RECORDED_PAGE, absent, book)


def bundle_status(
    folder: Path,
    lesson: str | None = None,
    page: str | None = None,
    absent: str = "There is no such folder.",
    book: Path = project.BOOK,
) -> Status:
    """Return the state of the bundle in a folder that is named by its backend.

    Args:
        folder: where the bundle stands, or would.
        lesson: whose it must be, where that is known.
        page: the page that it must come from, where that is known.
        absent: the reason that is given where there is none.
        book: the pages that it must come from.

    Raises:
        ProjectError, PageError: the checkout itself cannot be read.
    """
    if not os.path.lexists(folder):
        return Status("missing", folder.name, absent, None)
    try:
        manifest = verify_bundle(folder, lesson=lesson, page=page, book=book)
    except BundleRefused as refusal:
        state = STATE_OF_CODE.get(refusal.code, "refused")
        return Status(state, folder.name, str(refusal), None, refusal.code)
    return Status("verified", folder.name, "", manifest)


def recorded_folders(book: Path) -> list[Path]:
    """Return what stands where recorded bundles do: `evidence/<lesson>/<backend>` of a book."""
    return [
        path
        for path in sorted((book / "evidence").glob("*/*"))
        if (path.is_dir() or path.is_symlink()) and not path.name.startswith(".")
    ]


def refused_records(book: Path) -> list[str]:
    """Return a line for each recorded bundle that a build must not go on with.

    Args:
        book: the folder that holds `evidence`.
    """
    found = [(path, recorded_status(book, *path.parts[-2:])) for path in recorded_folders(book)]
    return [
        f"{path.relative_to(book)}: the recorded bundle is {status.state}: {status.reason}"
        for path, status in found
        if status.state not in PASSING
    ]
