"""The state of a lesson's evidence, computed in this one place and nowhere set by hand."""

from dataclasses import dataclass
from pathlib import Path

from robo_genesis import project
from robo_genesis.checks import CHECKS
from robo_genesis.evidence.bundle import BundleRefused, Manifest
from robo_genesis.evidence.verify import verify_bundle


@dataclass(frozen=True, slots=True)
class Status:
    """State of one page's bundle on one backend: verified, missing, or refused with a reason."""

    state: str
    backend: str
    reason: str
    manifest: Manifest | None

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


def page_status(outputs: Path, lesson: str, page: str, backend: str) -> Status:
    """Return the state of one bundle below the outputs folder of a build."""
    return _status(
        outputs / lesson / page / backend, f"No bundle was recorded for {lesson}/{page}."
    )


def recorded_status(book: Path, lesson: str, backend: str) -> Status:
    """Return the state of the lab's bundle that was recorded on another backend and committed."""
    return _status(
        book / "evidence" / lesson / backend,
        f"No run on this backend is recorded for Genesis {project.engine_pin()}.",
    )


def _status(folder: Path, absent: str) -> Status:
    if not folder.is_dir():
        return Status("missing", folder.name, absent, None)
    try:
        return Status("verified", folder.name, "", verify_bundle(folder))
    except BundleRefused as refusal:
        return Status("refused", folder.name, str(refusal), None)
