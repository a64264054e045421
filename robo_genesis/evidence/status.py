"""The state of a lesson's evidence, computed in this one place and nowhere set by hand."""

import os
from dataclasses import dataclass
from pathlib import Path

from robo_genesis.core import project
from robo_genesis.evidence import bundle, evidence_key
from robo_genesis.evidence.bundle import BundleRefused, Manifest
from robo_genesis.evidence.claims import not_shown
from robo_genesis.evidence.compare import specification
from robo_genesis.evidence.manifest_rules import AGREEMENT
from robo_genesis.evidence.verify import verify_bundle

RECORDED_PAGE = "lab"
"""Only labs are recorded on accelerators and kept in the repository."""

STATE_OF_CODE = {"stale": "stale", "older-schema": "stale", "failed": "failed"}
"""Refusals that are a state of their own; every other code is `refused`."""

STATES = ("verified", "inconclusive", "missing", "stale", "failed", "refused")

PASSING = ("verified", "inconclusive", "missing", "stale")
"""States that a build goes on with; without a manifest a panel stands in the figures' place."""

UNREADABLE = "The bundle was refused; `make verify` says what it found and what it expected."


@dataclass(frozen=True, slots=True)
class Status:
    """State of one page's bundle on one backend.

    | state | means |
    |---|---|
    | `verified` | accepted; `manifest` is given |
    | `inconclusive` | accepted, but it does not show every ordering that the lesson claims |
    | `missing` | no bundle stands there |
    | `stale` | honest, but of an older form, or the answer to an older question |
    | `failed` | sound, and its own checks did not pass |
    | `refused` | damaged, mislabelled, incomplete or of an unknown form |

    `code` is that of the refusal, None where there was none; `reason` names expected and found,
    `summary` says the same to a reader of the site.
    """

    state: str
    backend: str
    reason: str
    manifest: Manifest | None
    code: str | None = None
    summary: str = ""

    @property
    def badge(self) -> str:
        """The one word that the site shows: backend and state."""
        return f"{self.backend}-{self.state}"

    @property
    def sentence(self) -> str:
        """Say what was run, for a reader who sees the badge beside it."""
        if self.manifest is None:
            return self.summary or self.reason
        predicate = self.manifest.predicate
        render = predicate.render
        kernel = (
            "Lab in a clean notebook kernel"
            if predicate.command.startswith("make ")
            else "Lab run by hand"
        )
        passed = sum(check.passed for check in predicate.checks)
        camera = f"camera frames by {render.renderer}" if render.mode == "camera" else "camera SKIP"
        more = f" {self.summary}" if self.summary else ""
        return (
            f"{kernel}, Genesis {predicate.engine.version}, "
            f"{passed} of {len(predicate.checks)} checks passed, {camera}, "
            f"measured {predicate.started[:10]}.{more}"
        )


def page_status(
    outputs: Path,
    lesson: str,
    page: str,
    backend: str,
    book: Path = project.BOOK,
    *,
    root: Path = project.ROOT,
) -> Status:
    """Return the state of one bundle below the outputs folder of a build of a book."""
    absent = f"No bundle was recorded for {lesson}/{page}."
    return bundle_status(outputs / lesson / page / backend, lesson, page, absent, book, root=root)


def recorded_status(book: Path, lesson: str, backend: str, *, root: Path = project.ROOT) -> Status:
    """Return the state of the lab's bundle that was recorded on a backend and committed."""
    absent = f"No run on this backend is recorded for Genesis {project.engine_pin(root)}."
    folder = book / "evidence" / lesson / backend
    if folder.parent.is_symlink():
        reason = f"evidence/{lesson} is a link, expected the folder itself. Put the folder there."
        return Status("refused", backend, reason, None, "path", UNREADABLE)
    return bundle_status(folder, lesson, RECORDED_PAGE, absent, book, root=root)


def bundle_status(
    folder: Path,
    lesson: str | None = None,
    page: str | None = None,
    absent: str = "There is no such folder.",
    book: Path = project.BOOK,
    *,
    root: Path = project.ROOT,
) -> Status:
    """Return the state of the bundle in a folder that is named by its backend.

    Args:
        folder: where the bundle stands, or would.
        lesson: whose it must be, where that is known.
        page: the page that it must come from, where that is known.
        absent: the reason that is given where there is none.
        book: the pages that it must come from.
        root: the checkout, for pin, lock and modules.

    Raises:
        ProjectError, PageError: the checkout itself cannot be read.
    """
    if not os.path.lexists(folder):
        return Status("missing", folder.name, absent, None)
    try:
        manifest = verify_bundle(folder, lesson=lesson, page=page, root=root, book=book)
    except BundleRefused as refusal:
        state = STATE_OF_CODE.get(refusal.code, "refused")
        summary = {
            "stale": lambda: why_stale(bundle.read_manifest(folder), book, root),
            "older-schema": lambda: "It was recorded in an older form of the bundle.",
            "failed": lambda: "Its own checks did not all pass.",
        }.get(refusal.code, lambda: UNREADABLE)()
        return Status(state, folder.name, str(refusal), None, refusal.code, summary)
    return _shown(folder, manifest)


def _shown(folder: Path, manifest: Manifest) -> Status:
    """Return the state of an accepted bundle: whether it shows what its lesson claims."""
    metrics = bundle.read_metrics(folder)
    numbers = {f"{group}.{name}": m for group, of in metrics.items() for name, m in of.items()}
    run = manifest.predicate
    open_ones = not_shown(numbers, specification(run.lesson, run.page).relations)
    if not open_ones:
        return Status("verified", folder.name, "", manifest)
    reason = f"Not shown of what the lesson claims: {'; '.join(open_ones)}."
    return Status("inconclusive", folder.name, reason, manifest, summary=reason)


def why_stale(manifest: Manifest, book: Path, root: Path = project.ROOT) -> str:
    """Say to a reader what changed since a bundle was recorded.

    Args:
        manifest: of a bundle that was refused as stale.
        book: the pages of this checkout.
        root: the checkout, for pin, lock and modules.
    """
    found = manifest.predicate.model_dump()
    asked = evidence_key.question(found["lesson"], found["page"], root, book)
    versions = (("Genesis", "version"), ("Quadrants", "quadrants_version"))
    changed = [
        f"it was recorded with {name} {found['engine'][key]}; this site uses {asked['engine'][key]}"
        for name, key in versions
        if found["engine"][key] != asked["engine"][key]
    ]
    for what, here, there in (
        (f"the {found['page']}'s code", found["source"]["page"], asked["source"]["page"]),
        ("the course's code", found["source"]["modules"], asked["source"]["modules"]),
        ("the parameters", found["parameters"], asked["parameters"]),
        ("the seed", found["seed"], asked["seed"]),
    ):
        changed += [f"{what} changed since"] if here != there else []
    text = "; ".join(changed) or "it answers an older question"
    return f"{text[0].upper()}{text[1:]}."


def recorded_folders(book: Path) -> list[Path]:
    """Return what stands where recorded bundles do: `evidence/<lesson>/<backend>` of a book.

    A backend's name on something that is no folder counts: it must be refused, not overlooked.
    """
    return [
        path
        for path in sorted((book / "evidence").glob("*/*"))
        if (path.is_dir() or path.is_symlink() or path.name in AGREEMENT)
        and not path.name.startswith(".")
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
