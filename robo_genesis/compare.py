"""Compare the bundle of your own run with the one that the site publishes.

    python -m robo_genesis.compare outputs/l04/lab/cpu l04-lab-cpu-1a2b3c4d.zip

Each is the folder of a bundle, or a bundle's archive as the ledger of the site offers it.
Exit status: 0 they agree, 1 they differ or it is undecided, 2 they cannot be compared.
"""

import argparse
import sys
import tempfile
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path

from robo_genesis.core.refusals import BundleRefused, printable
from robo_genesis.evidence import report
from robo_genesis.evidence.bundle import Predicate
from robo_genesis.evidence.compare import BundleComparison, compare
from robo_genesis.evidence.rows import EQUAL, INCONCLUSIVE, NOT_COMPARABLE, WITHIN

LARGEST = 500_000_000
"""Most bytes that an archive may hold; a bundle has a few hundred thousand."""


def bundle_folder(given: str, opened: ExitStack) -> Path:
    """Return the folder of a bundle, that of an archive as long as `opened` is open.

    Raises:
        BundleRefused: there is neither a folder nor an archive of a bundle.
    """
    path = Path(given)
    if path.is_dir():
        return path
    if not zipfile.is_zipfile(path):
        raise BundleRefused(
            "missing",
            f"{given!r} is neither a folder nor a zip archive. Give the folder of a run, such as "
            "outputs/l04/lab/cpu, and an archive from the site's ledger.",
        )
    with zipfile.ZipFile(path) as archive:
        size = sum(entry.file_size for entry in archive.infolist())
        if size > LARGEST:
            raise BundleRefused("size", f"{given!r} holds {size} bytes, expected a bundle.")
        folder = Path(opened.enter_context(tempfile.TemporaryDirectory()))
        archive.extractall(folder)
    return folder


def reasons(mine: Predicate, other: Predicate) -> Iterator[str]:
    """Yield what differs between two runs and may explain different numbers."""
    engines = [p.engine for p in (mine, other)]
    versions = [f"{e.version} (quadrants {e.quadrants_version})" for e in engines]
    if versions[0] != versions[1]:
        found = " and ".join(versions)
        yield f"The engines differ: {found}. Install the version that the site pins."
    if mine.engine.files_match_wheel != other.engine.files_match_wheel:
        yield "The installed files of one engine were changed. Install the engine again."
    if mine.backend.actual != other.backend.actual:
        backends = f"{mine.backend.actual} and {other.backend.actual}"
        yield f"The backends differ: {backends}. They round differently; orderings should agree."
    if mine.parameters != other.parameters:
        yield "The settings of the lesson differ: the course's package was changed."
    if mine.source.modules != other.source.modules:
        yield "The course's code differs: your package is of another build of the site."


def explained(comparison: BundleComparison) -> list[str]:
    """Return the comparison in lines that a student can act on; the old side is the site's."""
    lines = report.summary(comparison).splitlines()
    found = [*reasons(comparison.new, comparison.old)]
    if comparison.state in (EQUAL, WITHIN):
        lines.append("Your run agrees with the site's within the tolerances of the lesson.")
    elif comparison.state == NOT_COMPARABLE:
        lines.append("The two runs cannot be compared, for the reasons above.")
    elif comparison.state == INCONCLUSIVE:
        lines.append("Whether the runs agree is undecided: see the inconclusive lines above.")
    else:
        lines.append("Your run differs from the site's. An arrow leads from its value to yours.")
        found = found or [
            "Engine, backend, settings and code are equal. Another processor can change the last "
            "digits; a larger difference comes from a changed cell of the notebook."
        ]
    return lines + found


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
            mine, site = (bundle_folder(given, opened) for given in (args.mine, args.site))
            comparison = compare(site, mine)
        except (BundleRefused, zipfile.BadZipFile) as error:
            print(printable(f"Not compared: {error}"), file=sys.stderr)
            return 2
    print("\n".join(map(printable, explained(comparison))))
    return {EQUAL: 0, WITHIN: 0, NOT_COMPARABLE: 2}.get(comparison.state, 1)


if __name__ == "__main__":
    sys.exit(main())
