"""Verify evidence: `make verify` (BUNDLE=path checks one folder).

One line for each bundle that is recorded in the book and for each of the last build: lesson,
backend, state, reason. Exit status: 0 all verified, or no bundle; 1 any is inconclusive, stale,
failed or refused.
"""

import sys
from collections.abc import Iterator

from robo_genesis.build.command import path
from robo_genesis.core.project import BOOK, PUBLISHED, ProjectError
from robo_genesis.evidence.status import Status, bundle_status, recorded_folders, recorded_status


def all_bundles() -> Iterator[tuple[str, Status]]:
    """Yield (place, status) of the recorded bundles, then of the last build's."""
    for folder in recorded_folders(BOOK):
        yield f"{folder.parent.name} recorded", recorded_status(BOOK, *folder.parts[-2:])
    for folder in recorded_folders(BOOK / PUBLISHED):
        lesson = folder.parent.name
        yield f"{lesson} built", bundle_status(folder, lesson, "lab")


def line(place: str, status: Status) -> str:
    """Return one bundle's line."""
    text = status.reason
    if not text and status.manifest:
        run = status.manifest.predicate
        text = f"run {run.run_id[:8]} of {run.started[:10]}, Genesis {run.engine.version}"
    return f"{place:14} {status.backend:8} {status.state:12} {text}"


def main() -> int | str:
    """Print the lines and return the exit status, or why nothing can be verified."""
    try:
        bundle = path("BUNDLE")
        found = [(bundle.parent.name, bundle_status(bundle))] if bundle else list(all_bundles())
    except (ProjectError, OSError) as error:
        return f"Nothing can be verified: {error}"
    if not found:
        print("No bundle is recorded in book/evidence, and none is built. `make book` builds one.")
    for place, status in found:
        print(line(place, status))
    return 0 if all(status.state == "verified" for _, status in found) else 1


if __name__ == "__main__":
    sys.exit(main())
