"""Verify evidence: `make verify` (BUNDLE=path checks one folder).

One line for each bundle that is recorded in the book and for each of the last build: lesson,
backend, state, reason. Exit status: 0 all verified, or none there; 1 any that is inconclusive,
stale, failed or refused.
"""

import os
import sys
from collections.abc import Iterator
from pathlib import Path

from robo_genesis.build.publish import PUBLISHED
from robo_genesis.core.project import BOOK, ProjectError
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
    text = status.reason or f"run {_run(status)}"
    return f"{place:14} {status.backend:8} {status.state:12} {text}"


def _run(status: Status) -> str:
    assert status.manifest is not None
    predicate = status.manifest.predicate
    return f"{predicate.run_id[:8]} of {predicate.started[:10]}, Genesis {predicate.engine.version}"


def main() -> int:
    """Print the lines and return the exit status."""
    asked = os.environ.get("BUNDLE")
    try:
        if asked:
            folder = Path(asked).absolute()
            found = [(folder.parent.name, bundle_status(folder))]
        else:
            found = list(all_bundles())
    except (ProjectError, OSError) as error:
        print(f"Nothing can be verified: {error}", file=sys.stderr)
        return 1
    if not found:
        print("No bundle is recorded in book/evidence, and none is built. `make book` builds one.")
        return 0
    print("\n".join(line(place, status) for place, status in found))
    return 0 if all(status.state == "verified" for _, status in found) else 1


if __name__ == "__main__":
    sys.exit(main())
