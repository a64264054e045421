"""The state of evidence; only this module decides it."""

from dataclasses import dataclass
from pathlib import Path

from robo_genesis.core import project
from robo_genesis.core.comparison import HELD, outcome
from robo_genesis.evidence.bundle import (
    Manifest,
    by_full_name,
    read_metrics,
)
from robo_genesis.evidence.compare import claims_of
from robo_genesis.evidence.refusals import BundleRefused

from .verify import verify_bundle

# The page whose bundles are recorded on accelerators and kept in the repository.
RECORDED_PAGE = "lab"

# State by the code of a refusal; every other code is `refused`.
STATE_OF_CODE = {"stale": "stale", "older-schema": "stale", "failed": "failed"}

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
    "engine.version": RECORDED_WITH.format(name="Genesis"),
    "engine.quadrants_version": RECORDED_WITH.format(name="Quadrants"),
    "source.page": "the page's code changed since",
    "source.modules": "the course's code changed since",
    "parameters": "the parameters changed since",
    "seed": "the seed changed since",
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

    `reason` names the found and
    the expected value; `summary` is the short form for a reader of the site.
    """

    state: str
    backend: str
    reason: str
    manifest: Manifest | None
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
        run, renderer = self.manifest, self.manifest.render.renderer
        by_make = run.command.startswith("make ")
        kernel = "Lab in a clean notebook kernel" if by_make else "Lab run by hand"
        camera = f"camera frames by {renderer}" if renderer else "camera SKIP"
        more = f" {self.summary}" if self.summary else ""
        return (
            f"{kernel}, Genesis {run.engine.version}, {run.passed} checks passed, {camera}, "
            f"measured {run.started[:10]}.{more}"
        )


def recorded_status(book: Path, lesson: str, backend: str) -> Status:
    """Return the state of the recorded bundle of a lab on a backend; see `bundle_status`.

    Args:
        book: the folder of the pages.
        lesson: of the lab.
        backend: names the folder of the bundle.
    """
    absent = f"No run on this backend is recorded for Genesis {project.engine_pin()}."
    folder = book / "evidence" / lesson / backend
    return bundle_status(folder, lesson, RECORDED_PAGE, absent, book)


def bundle_status(
    folder: Path,
    lesson: str | None = None,
    page: str | None = None,
    absent: str = "There is no such folder.",
    book: Path = project.BOOK,
    *,
    once: bool = False,
) -> Status:
    """Return the state of the bundle in a folder that is named after its backend.

    Args:
        folder: of the bundle, which may be missing.
        lesson: the required lesson, None for any.
        page: the required page, None for any.
        absent: the reason if there is no bundle.
        book: the folder of the pages.
        once: see `verify_bundle`.

    Raises:
        ProjectError, PageError: the checkout itself cannot be read.
    """
    backend = folder.name
    if not folder.exists():
        return Status("missing", backend, absent, None)
    try:
        manifest = verify_bundle(folder, lesson=lesson, page=page, book=book, once=once)
    except BundleRefused as refusal:
        state = STATE_OF_CODE.get(refusal.code, "refused")
        summary = SUMMARIES.get(refusal.code, UNREADABLE)
        if refusal.code == "stale":
            summary = why_stale(refusal)
        return Status(state, backend, str(refusal), None, summary)
    lines = not_shown(folder, manifest)
    if not lines:
        return Status("verified", backend, "", manifest)
    reason = f"Not shown of what the lesson claims: {'; '.join(lines)}."
    return Status("inconclusive", backend, reason, manifest, reason)


def not_shown(folder: Path, manifest: Manifest) -> list[str]:
    """Return a line for each claimed ordering that an accepted bundle does not show."""
    numbers, lines = by_full_name(read_metrics(folder)), []
    for relation in claims_of(manifest.lesson, manifest.page):
        (first, second), metric, claim, _ = relation
        held, values = outcome(numbers, relation)
        if held != HELD:
            lines.append(
                f"{metric} {claim} in {second} than in {first} is {held} ({values})"
            )
    return lines


def why_stale(refusal: BundleRefused) -> str:
    """Return, for a reader of the site, what changed since a stale bundle was recorded."""
    texts: dict[str, str] = {}
    for path, here, there in refusal.differing:
        for start in filter(path.startswith, CHANGES):
            texts.setdefault(start, CHANGES[start].format(here, there))
    text = "; ".join(texts[start] for start in CHANGES if start in texts)
    return f"{text[0].upper()}{text[1:]}." if text else "It answers an older question."


def recorded_folders(book: Path) -> list[Path]:
    """Return the recorded bundles of a book: `evidence/<lesson>/<backend>`."""
    return sorted((book / "evidence").glob("*/[!.]*/"))


def refused_records(book: Path) -> list[str]:
    """Return a line for each recorded bundle of a book with which a build must not continue."""
    return [
        f"{path.relative_to(book)}: the recorded bundle is {status.state}: {status.reason}"
        for path in recorded_folders(book)
        if (status := recorded_status(book, *path.parts[-2:])).state
        in ("failed", "refused")
    ]
