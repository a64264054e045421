"""The verification stage: each bundle of a build is accepted, and its page shows what it holds."""

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from robo_genesis.build.command import Progress
from robo_genesis.build.page_folder import stored_notebook
from robo_genesis.build.page_results import PageResult
from robo_genesis.build.page_store import Verify
from robo_genesis.build.shown import require_shown
from robo_genesis.core.names import BACKEND, RENDER
from robo_genesis.core.project import environment_contract
from robo_genesis.core.refusals import BundleRefused, expect


def verify_results(
    verify: Verify,
    results: Sequence[PageResult],
    imported: Collection[str],
    progress: Progress,
) -> tuple[dict[str, Any], list[str]]:
    """Verify the bundles of a build, and compare what the pages show with them.

    A page from the store was compared when it was new, and its files still have their digests.

    Args:
        verify: verifies one bundle.
        results: of all executed pages, of which none failed.
        imported: the names of the pages that were executed elsewhere.
        progress: prints a line for each accepted bundle.

    Returns:
        The accepted manifests by page name, and a line for each refused bundle.
    """
    contract = environment_contract()
    manifests: dict[str, Any] = {}
    refused: list[str] = []
    for result in results:
        if result.bundle is None:
            continue
        try:
            manifest = verify(result.bundle, result.run_id)
            require_contract(manifest.predicate, contract)
            found = "accepted"
            if result.status == "executed" or result.page.docname in imported:
                compared = require_shown(
                    result.page, stored_notebook(result), result.bundle, manifest
                )
                found = f"accepted, {compared} outputs compared"
            manifests[result.page.docname] = manifest
            progress("verify", result.page.docname, found)
        except BundleRefused as error:
            refused.append(f"{result.page.docname}: the bundle {result.bundle} is refused: {error}")
    return manifests, refused


def require_contract(predicate: Any, contract: Mapping[str, str]) -> None:
    """Raise BundleRefused if a bundle's backend or camera is not the requested one.

    Args:
        predicate: the predicate of the bundle's manifest.
        contract: the variables that requested it.
    """
    remedy = "Write gs.init(backend=rg.backend(), ...), and a camera where page.render is true."
    backend, render = contract[BACKEND], contract[RENDER]
    mode = "camera" if render == "1" else "skip"
    found = predicate.backend.requested
    expect("backend", "manifest.json", "backend.requested", found, backend, remedy)
    expect("frames", "manifest.json", "render.mode", predicate.render.mode, mode, remedy)
