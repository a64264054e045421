"""The state of a lesson's evidence, computed in this one place and nowhere set by hand."""

from dataclasses import dataclass
from pathlib import Path

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
        camera = f"camera frames by {render.renderer}" if render.mode == "camera" else "camera SKIP"
        return (
            f"{self.backend}: verified. Clean kernel, Genesis {predicate.engine.version}, "
            f"{len(predicate.checks)} of {len(predicate.checks)} checks passed, {camera}, "
            f"measured {predicate.started[:10]}."
        )


def page_status(outputs: Path, lesson: str, page: str, backend: str) -> Status:
    """Return the state of one bundle below the outputs folder of a build."""
    folder = outputs / lesson / page / backend
    if not folder.is_dir():
        return Status("missing", backend, f"No bundle was recorded for {lesson}/{page}.", None)
    try:
        return Status("verified", backend, "", verify_bundle(folder))
    except BundleRefused as refusal:
        return Status("refused", backend, str(refusal), None)
