"""Compare the bundle of your own run with the one that the site publishes.

    python -m robo_genesis.compare outputs/l04/lab/cpu l04-lab-cpu-1a2b3c4d.zip

Each is the folder of a bundle, or a bundle's archive as the ledger of the site offers
it.
Exit status: 0 they agree, 1 they differ or it is undecided, 2 they cannot be compared.
"""

import argparse
import sys
import tempfile
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from robo_genesis.core.text import printable
from robo_genesis.evidence import report
from robo_genesis.evidence.bundle import MANIFEST, Manifest
from robo_genesis.evidence.compare import BundleComparison, compare
from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.evidence.rows import (
    DIFFERS,
    EQUAL,
    INCONCLUSIVE,
    NOT_COMPARABLE,
    WITHIN,
)

# Most bytes that an archive may hold; a bundle has a few hundred thousand.
LARGEST = 500_000_000

REASONS = (
    "The engines differ: {} and {}. Install the version that the site pins.",
    "The installed files of one engine were changed. Install the engine again.",
    "The backends differ: {} and {}. They round differently; orderings should agree.",
    "The settings of the lesson differ: the course's package was changed.",
    "The course's code differs: your package is of another build of the site.",
)

OWN = "This is the site's own run or an edited copy of it: both have the same run id."

CONCLUSIONS = {
    EQUAL: "Your run agrees with the site's within the tolerances of the lesson.",
    WITHIN: "Your run agrees with the site's within the tolerances of the lesson.",
    INCONCLUSIVE: "Whether the runs agree is undecided: see the inconclusive lines above.",
    DIFFERS: "Your run differs from the site's. An arrow leads from its value to yours.",
    NOT_COMPARABLE: "The two runs cannot be compared, for the reasons above.",
}


def bundle_folder(given: str, opened: ExitStack) -> Path:
    """Return the folder of a bundle, that of an archive as long as `opened` is open.

    Raises:
        BundleRefused: there is neither a folder nor an archive of a bundle.
    """
    path, remedy = (
        Path(given),
        "expected a run's folder, as outputs/l04/lab/cpu, or its archive",
    )
    if not path.is_dir():
        if not zipfile.is_zipfile(path):
            raise BundleRefused(
                "missing", f"{given!r} is neither a folder nor a zip archive; {remedy}"
            )
        with zipfile.ZipFile(path) as archive:
            size = sum(entry.file_size for entry in archive.infolist())
            if size > LARGEST:
                raise BundleRefused(
                    "size", f"{given!r} holds {size} bytes, expected a bundle."
                )
            path = Path(opened.enter_context(tempfile.TemporaryDirectory()))
            archive.extractall(path)
    if not (path / MANIFEST).is_file():
        raise BundleRefused("missing", f"{given!r} has no {MANIFEST}; {remedy}")
    return path


def reasons(mine: Manifest, other: Manifest) -> Iterator[str]:
    """Yield what differs between two runs and may explain different numbers."""
    facts = [
        (
            f"{run.engine.version} (quadrants {run.engine.quadrants_version})",
            run.engine.files_match_wheel,
            run.backend.actual,
            run.parameters,
            run.source.modules,
        )
        for run in (mine, other)
    ]
    for here, there, text in zip(*facts, REASONS, strict=True):
        if here != there:
            yield text.format(here, there)


def explained(comparison: BundleComparison) -> list[str]:
    """Return the comparison in lines that a student can act on; the old side is the site's."""
    found = [*reasons(comparison.new, comparison.old)]
    if comparison.state == DIFFERS and not found:
        found = [
            "Engine, backend, settings and code are equal. Another processor can change the last "
            "digits; a larger difference comes from a changed cell of the notebook. The check "
            "`functions` fails if the test of a function did not pass."
        ]
    without_notes = report.summary(
        replace(comparison, notes=())
    )  # they are about recordings
    own = [OWN] * (comparison.new.run_id == comparison.old.run_id)
    return [*without_notes.splitlines(), CONCLUSIONS[comparison.state], *own, *found]


def main(arguments: Sequence[str] | None = None) -> int:
    """Compare, print the result and return the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m robo_genesis.compare", description=__doc__.splitlines()[0]
    )
    parser.add_argument("mine", help="folder or archive of your run")
    parser.add_argument("site", help="folder or archive of the site's run")
    args = parser.parse_args(arguments)
    with ExitStack() as opened:
        try:
            mine, site = (
                bundle_folder(given, opened) for given in (args.mine, args.site)
            )
            comparison = compare(site, mine)
        except (BundleRefused, zipfile.BadZipFile) as error:
            print(printable(f"Not compared: {error}"), file=sys.stderr)
            return 2
    print("\n".join(map(printable, explained(comparison))))
    return {EQUAL: 0, WITHIN: 0, NOT_COMPARABLE: 2}.get(comparison.state, 1)


if __name__ == "__main__":
    sys.exit(main())
