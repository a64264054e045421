"""Compare two evidence bundles: `make compare OLD=path NEW=path [REPORT=folder]`.

Writes report.md, by default below .cache/reports/, and prints the summary.
Exit status: 0 equal or within tolerance, 1 differs or inconclusive, 2 not comparable or
    refused.
`make` itself ends with 2 for each but 0; call this script if you need the difference.
"""

import argparse
import sys
from pathlib import Path

from robo_genesis.core.project import CACHE
from robo_genesis.core.text import printable
from robo_genesis.evidence import report
from robo_genesis.evidence.compare import compare
from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.evidence.rows import DIFFERS, INCONCLUSIVE, NOT_COMPARABLE

STATUS = {DIFFERS: 1, INCONCLUSIVE: 1, NOT_COMPARABLE: 2}


def refused(message: str) -> int:
    """Print why nothing was compared; return the exit status."""
    print(printable(message), file=sys.stderr)
    return 2


def main() -> int:
    """Compare, write the report and return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("old", help="folder of the bundle that is compared against")
    parser.add_argument("new", help="folder of the bundle that is compared")
    parser.add_argument("--report", default="", help="folder of the report")
    args = parser.parse_args()
    for name, path in (("OLD", args.old), ("NEW", args.new)):
        if not path or not Path(path).is_dir():
            return refused(
                f"{name}={path!r} is not a folder. Usage: make compare OLD=path NEW=path; a path "
                "is a bundle's folder, for example book/_build/evidence/l04/cpu."
            )
    old, new = Path(args.old), Path(args.new)
    try:
        comparison = compare(old, new)
    except BundleRefused as refusal:
        return refused(f"Refused: {refusal}")
    runs = [predicate.run_id[:8] for predicate in (comparison.old, comparison.new)]
    folder = Path(args.report or CACHE / "reports" / "-".join(["compare", *runs]))
    try:
        written = report.document(comparison).write(folder)
    except OSError as error:
        return refused(
            f"REPORT={folder} cannot be written: {error}. Give another folder."
        )
    print(report.summary(comparison), f"Report: {written}", sep="\n")
    return STATUS.get(comparison.state, 0)


if __name__ == "__main__":
    sys.exit(main())
