"""The state of evidence; only this module decides it."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from robo_genesis.core import project
from robo_genesis.core.checks import FAILED
from robo_genesis.core.comparison import HELD, outcome
from robo_genesis.evidence import copies
from robo_genesis.evidence.bundle import (
    Manifest,
    by_full_name,
    read_manifest,
    read_metrics,
)
from robo_genesis.evidence.compare import specification
from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.pipeline.bundles.verify import changed, verify_bundle
from robo_genesis.pipeline.pages.guards import contradicted
from robo_genesis.sim.backends import BACKENDS

# The page whose bundles are recorded on accelerators and kept in the repository.
RECORDED_PAGE = "lab"

# State by the code of a refusal; every other code is `refused`.
STATE_OF_CODE = {"stale": "stale", "older-schema": "stale", "failed": "failed"}

# States with which a build continues; a lesson shows the figures of a verified run
# only.
PASSING = ("verified", "inconclusive", "missing", "stale")

UNREADABLE = (
    "The bundle was refused. The command make verify shows the found and "
    "the expected value."
)

# What a reader of the site learns about a refusal, by its code.
SUMMARIES = {
    "older-schema": "It was recorded in an older form of the bundle.",
    "failed": "Its own checks did not all pass.",
}

RECORDED_WITH = "it was recorded with {name} {{}}; this site uses {{}}"

# What a stale bundle's change is called, by the beginning of its path in the evidence
# key.
CHANGES = {
    "engine.version": ("engine", RECORDED_WITH.format(name="Genesis")),
    "engine.quadrants_version": ("engine", RECORDED_WITH.format(name="Quadrants")),
    "source.page": ("page", "the {page}'s code changed since"),
    "source.modules": ("modules", "the course's code changed since"),
    "parameters": ("parameters", "the parameters changed since"),
    "seed": ("seed", "the seed changed since"),
}


@dataclass(frozen=True, slots=True)
class Status:
    """State of one page's bundle on one backend.

    | state | means |
    |---|---|
    | `verified` | accepted; `manifest` is given |
    | `inconclusive` | accepted, but it does not show every ordering that the lesson claims |
    | `missing` | there is no bundle |
    | `stale` | sound, but of an older form, or the answer to an older question |
    | `failed` | sound, but its own checks did not all pass |
    | `refused` | damaged, mislabelled, incomplete or of an unknown form |

    `code` is the code of the refusal, None without one. `reason` names the found and
    the expected value; `summary` is the short form for a reader of the site.
    """

    state: str
    backend: str
    reason: str
    manifest: Manifest | None
    code: str | None = None
    summary: str = ""

    @property
    def badge(self) -> str:
        """The text of the badge: backend and state."""
        return f"{self.backend}-{self.state}"

    @property
    def sentence(self) -> str:
        """The text beside the badge: how the bundle was made, or why there is none."""
        if self.manifest is None:
            return self.summary or self.reason
        predicate, render = self.manifest.predicate, self.manifest.predicate.render
        by_make = predicate.command.startswith("make ")
        kernel = "Lab in a clean notebook kernel" if by_make else "Lab run by hand"
        passed = sum(check.passed for check in predicate.checks)
        camera = (
            f"camera frames by {render.renderer}"
            if render.mode == "camera"
            else "camera SKIP"
        )
        more = f" {self.summary}" if self.summary else ""
        return (
            f"{kernel}, Genesis {predicate.engine.version}, "
            f"{passed} of {len(predicate.checks)} checks passed, {camera}, "
            f"measured {predicate.started[:10]}.{more}"
        )


def recorded_status(
    book: Path,
    lesson: str,
    backend: str,
    *,
    labs: Mapping[str, Path | None] = MappingProxyType({}),
    root: Path = project.ROOT,
) -> Status:
    """Return the state of the recorded bundle of a lab on a backend; see `bundle_status`.

    Args:
        book: the folder of the pages.
        lesson: of the lab.
        backend: names the folder of the bundle.
        labs: by lesson, the bundle of a build's lab, of which it must not be a copy,
            nor of the recorded run on the CPU.
        root: the checkout, for pin, lock and modules.
    """
    absent = (
        f"No run on this backend is recorded for Genesis {project.engine_pin(root)}."
    )
    folder = book / "evidence" / lesson / backend
    if folder.parent.is_symlink():
        reason = f"evidence/{lesson} is a link, expected a folder. Replace the link."
        return Status("refused", backend, reason, None, "path", UNREADABLE)
    runs = [folder.with_name("cpu"), *([lab] if (lab := labs.get(lesson)) else [])]
    return bundle_status(
        folder, lesson, RECORDED_PAGE, absent, book, root=root, cpu_runs=runs
    )


def bundle_status(
    folder: Path,
    lesson: str | None = None,
    page: str | None = None,
    absent: str = "There is no such folder.",
    book: Path = project.BOOK,
    *,
    root: Path = project.ROOT,
    cpu_runs: Sequence[Path] = (),
    once: bool = False,
) -> Status:
    """Return the state of the bundle in a folder that is named after its backend.

    Args:
        folder: of the bundle, which may be missing.
        lesson: the required lesson, None for any.
        page: the required page, None for any.
        absent: the reason if there is no bundle.
        book: the folder of the pages.
        root: the checkout, for pin, lock and modules.
        cpu_runs: bundles of CPU runs, of which one of an accelerator must not be a
            copy.
        once: see `verify_bundle`.

    Raises:
        ProjectError, PageError: the checkout itself cannot be read.
    """
    backend = folder.name
    if not os.path.lexists(folder):
        return Status("missing", backend, absent, None)
    try:
        manifest = verify_bundle(
            folder, lesson=lesson, page=page, root=root, book=book, once=once
        )
        copies.require_own_run(folder, cpu_runs)
    except BundleRefused as refusal:
        code, reason = refusal.code, str(refusal)
        summary = SUMMARIES.get(code, UNREADABLE)
        if code in ("stale", FAILED):  # both are sound
            refused = read_manifest(folder)
            about = f"{refused.predicate.lesson}/{refused.predicate.page}"
            if code == "stale":
                summary = why_stale(refused, book, root)
            else:
                reason += contradicted(book, about, reason)
        state = STATE_OF_CODE.get(code, "refused")
        return Status(state, backend, reason, None, code, summary)
    lines = not_shown(folder, manifest)
    if not lines:
        return Status("verified", backend, "", manifest)
    reason = f"Not shown of what the lesson claims: {'; '.join(lines)}."
    return Status("inconclusive", backend, reason, manifest, summary=reason)


def not_shown(folder: Path, manifest: Manifest) -> list[str]:
    """Return a line for each claimed ordering that an accepted bundle does not show."""
    numbers, lines = by_full_name(read_metrics(folder)), []
    for claimed in specification(
        manifest.predicate.lesson, manifest.predicate.page
    ).relations:
        (first, second), metric, claim, _ = claimed
        held, values = outcome(numbers, claimed)
        if held != HELD:
            lines.append(
                f"{metric} {claim} in {second} than in {first} is {held} ({values})"
            )
    return lines


def why_stale(manifest: Manifest, book: Path, root: Path = project.ROOT) -> str:
    """Return, for a reader of the site, what changed since a stale bundle was recorded.

    Args:
        manifest: of a bundle that was refused as stale.
        book: the folder of the pages.
        root: the checkout, for pin, lock and modules.
    """
    found = changes(manifest, book, root)
    text = "; ".join(text for _, text in found) or "it answers an older question"
    return f"{text[0].upper()}{text[1:]}."


def changes(
    manifest: Manifest, book: Path, root: Path = project.ROOT
) -> list[tuple[str, str]]:
    """Return (kind, words) of each change since a bundle was recorded; see `why_stale`.

    The kinds are those of `advice.BY_CHANGE`.
    """
    found = changed(manifest, root, book) or []
    return [
        (kind, words.format(here, there, page=manifest.predicate.page))
        for start, (kind, words) in CHANGES.items()
        for path, here, there in [of for of in found if of[0].startswith(start)][:1]
    ]


def recorded_folders(book: Path) -> list[Path]:
    """Return the recorded bundles of a book: `evidence/<lesson>/<backend>`.

    Anything with the name of a backend counts, so that a file or link is refused rather
    than overlooked.
    """
    return [
        path
        for path in sorted((book / "evidence").glob("*/[!.]*"))
        if path.is_dir() or path.is_symlink() or path.name in BACKENDS
    ]


def refused_records(book: Path, labs: Mapping[str, Path | None]) -> list[str]:
    """Return a line for each recorded bundle of a book with which a build must not continue.

    Args:
        book: the folder of the pages.
        labs: see `recorded_status`.
    """
    return [
        f"{path.relative_to(book)}: the recorded bundle is {status.state}: {status.reason}"
        for path in recorded_folders(book)
        if (status := recorded_status(book, *path.parts[-2:], labs=labs)).state
        not in PASSING
    ]
