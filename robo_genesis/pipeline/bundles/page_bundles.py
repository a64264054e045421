"""The verification stage: each bundle of a build is accepted, and its page shows what it holds."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from robo_genesis.core.files import derived_value
from robo_genesis.core.project import BACKEND, RENDER, environment_contract
from robo_genesis.evidence.bundle import Manifest
from robo_genesis.evidence.refusals import BundleRefused, expect
from robo_genesis.lessons import find_page
from robo_genesis.pipeline.command import Progress
from robo_genesis.pipeline.pages import outputs
from robo_genesis.pipeline.pages.page_folder import RECORD, executed_cells
from robo_genesis.pipeline.pages.results import PageResult
from robo_genesis.pipeline.pages.sources import Tree
from robo_genesis.pipeline.pages.store import Verify
from robo_genesis.pipeline.pages.values import prints


def verify_result(
    verify: Verify, result: PageResult, bundle: Path, progress: Progress
) -> Any:
    """Verify the bundle of a page, compare what the page shows with it; return its manifest.

    A refused page of the store loses its record, so that it is executed again. One that was
    executed now is verified once more by the next build, because the rule may be wrong.

    Args:
        verify: verifies one bundle.
        result: of the page.
        bundle: that the page left.
        progress: prints a line.

    Raises:
        BundleRefused: by `verify`; `backend` and `frames`, see `require_contract`; `shown`.
    """
    try:
        manifest = verify(bundle)
        require_contract(manifest, environment_contract())
        compared = outputs_compared(result, bundle)
    except BundleRefused:
        if result.status == "reused":
            (result.folder / RECORD).unlink()
        raise
    progress("verify", result.page.docname, f"accepted, {compared} outputs compared")
    return manifest


def outputs_compared(result: PageResult, bundle: Path) -> int:
    """Compare the outputs of a page with its bundle, and return their number.

    A page is compared once: the result is kept for the record of its files with their
        digests, for the values that its cells name, and for the code that compares.

    Raises:
        BundleRefused: `shown`.
    """
    folder = result.folder
    code = [
        path.read_text("utf8") for path in Tree().closure([outputs.__name__]).values()
    ]
    inputs = [(folder / RECORD).read_text("utf8"), prints(result.page.notebook), code]

    def compare() -> int:
        executed = executed_cells(folder)
        return outputs.require_shown(result.page, executed, bundle)

    return int(derived_value("shown", inputs, compare))


def require_contract(manifest: Manifest, contract: Mapping[str, str]) -> None:
    """Raise BundleRefused if a bundle's backend or camera is not the requested one.

    A page that declares no camera must have none.

    Args:
        manifest: of the bundle.
        contract: the variables that requested it.
    """
    remedy = "Write gs.init(backend=rg.backend(), ...), and a camera where page.render is true."
    backend, render = contract[BACKEND], contract[RENDER]
    camera = render == "1" and find_page(manifest.lesson, manifest.page).camera
    mode = "camera" if camera else "skip"
    found = manifest.backend.requested
    expect("backend", "manifest.json", "backend.requested", found, backend, remedy)
    expect("frames", "manifest.json", "render.mode", manifest.render.mode, mode, remedy)
