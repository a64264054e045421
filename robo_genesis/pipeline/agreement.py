"""Whether two executions of the same pages agree.

On equal processors they must leave equal arrays. Another processor may round
differently: then both bundles must pass verification, and their values agree within the
tolerances of the lesson.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from robo_genesis.core.project import ProjectError
from robo_genesis.core.text import listed
from robo_genesis.evidence import report
from robo_genesis.evidence.bundle import read_manifest, sha256
from robo_genesis.evidence.compare import compare
from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.evidence.rows import EQUAL, WITHIN, Row
from robo_genesis.pipeline.bundles.verify import verify_bundle
from robo_genesis.pipeline.pages.folder import OUTPUTS, Record, plain_files, read_record
from robo_genesis.pipeline.pages.results import find_bundle
from robo_genesis.pipeline.pages.store import Verify, exported_folders

# Ends the name of an archive of arrays. Its bytes depend on the arrays alone.
ARRAYS = ".npz"
OF_BUNDLE = "/arrays/"  # In the name of an archive whose arrays have tolerances
NAMELESS = "a processor without a name"


@dataclass(frozen=True, slots=True)
class Execution:
    """One execution of a page.

    `bundle` is None if it left none; `archives` has the digest of each archive of
    arrays, computed from the file. `processor` is the name in the manifest.
    """

    record: Record
    bundle: Path | None
    archives: Mapping[str, str]
    processor: str


def agree(
    first: Path | None, second: Path | None, verify: Verify = verify_bundle
) -> list[str]:
    """Require that two executions of the same pages agree.

    Outputs, frames and logs are not compared: they contain times and names of machines.

    Args:
        first: holds the folders that `make execute` exported on one machine, at any
            depth.
        second: those of another machine.
        verify: verifies a bundle whose arrays differ from those of the other processor.

    Returns:
        Sentences about processors and arrays, for the user and the site.

    Raises:
        ProjectError: a page or an archive is missing in one of them, or the two do not
            agree.
        PageRefused: a folder is not an executed page.
    """
    one, other = _executions("FIRST", first), _executions("SECOND", second)
    problems, apart = [], {}
    for page in sorted({*one, *other}):
        if page not in one or page not in other:
            absent = first if page not in one else second
            problems.append(
                f"{page} is not in {absent}. Execute it: make execute PAGE={page}"
            )
            continue
        try:
            if row := _difference(one[page], other[page], verify):
                apart[page] = row
        except (ProjectError, BundleRefused) as error:
            problems.append(f"{page}: {error}")
    measured = [page for page, execution in one.items() if execution.archives]
    if not measured:
        problems.append(
            f"FIRST={first} has no arrays ({ARRAYS}). Execute the measuring pages."
        )
    if problems:
        raise ProjectError(
            "\n".join([f"{first} and {second} do not agree.", *problems])
        )
    found = {pages[page].processor for pages in (one, other) for page in measured}
    lines = [
        f"Each page was executed twice, on {listed(sorted(found))}.",
        f"Pages with arrays that are equal to the last bit: {len(measured) - len(apart)} of "
        f"{len(measured)}.",
    ]
    if apart:
        page, row = max(apart.items(), key=lambda of: of[1].weight)
        lines.append(
            f"Pages on two processors that round differently: {len(apart)}. Their values agree "
            "within the tolerances of the lessons. The largest difference, as a share of its "
            f"tolerance, is in {page}, {report.words(row)}."
        )
    return lines


def _executions(name: str, folder: Path | None) -> dict[str, Execution]:
    """Return the executed pages of a folder by name."""
    if folder is None or not folder.is_dir():
        raise ProjectError(
            f"{name}={str(folder or '')!r} is not a folder. Name the one that "
            "`make execute TO=folder` filled."
        )
    found = {}
    for place in exported_folders(folder):
        record = read_record(place)
        if record.docname in found:
            raise ProjectError(
                f"{name}={folder} has {record.docname} twice. Remove one."
            )
        archives = (file for file in plain_files(place) if file.endswith(ARRAYS))
        bundle = find_bundle(place / OUTPUTS, record.run_id)
        processor = read_manifest(bundle).predicate.host.cpu if bundle else NAMELESS
        digests = {file: sha256(place / file) for file in archives}
        found[record.docname] = Execution(record, bundle, digests, processor)
    return found


def _difference(one: Execution, other: Execution, verify: Verify) -> Row | None:
    """Return the difference that is the largest share of its tolerance, None if arrays are equal.

    Raises:
        ProjectError: arrays differ on equal processors, a difference exceeds its
            tolerance, or a check or an ordering changed.
        BundleRefused: a bundle is not valid.
    """
    here, there = one.record, other.record
    if here.run_id == there.run_id:
        raise ProjectError(
            f"both are run {here.run_id[:8]}, expected two. Execute it once more."
        )
    if here.fingerprint != there.fingerprint:
        raise ProjectError(
            f"their fingerprints are {here.fingerprint[:8]} and {there.fingerprint[:8]}, expected "
            "equal ones: commit, lock, packages, Python or switches differ. Execute it again."
        )
    files = sorted({*one.archives, *other.archives})
    apart = [
        name for name in files if one.archives.get(name) != other.archives.get(name)
    ]
    processors = sorted({one.processor, other.processor})
    may_round = len(processors) == 2 and NAMELESS not in processors
    exact = [name for name in apart if not may_round or OF_BUNDLE not in name]
    if exact:
        raise ProjectError(
            f"{len(exact)} of {len(files)} archives differ. For example, {exact[0]} must be equal "
            f"on {listed(processors)}. Execute the page again. If they still differ, report "
            "it with both manifests."
        )
    if not (apart and one.bundle and other.bundle):
        return None
    verify(one.bundle, here.run_id)
    verify(other.bundle, there.run_id)
    compared = compare(one.bundle, other.bundle)
    if compared.axis != "repeat" or compared.state not in (EQUAL, WITHIN):
        raise ProjectError(
            f"{listed(processors)} may differ within the tolerances of the lesson, but they differ "
            f"more.\n{report.summary(compared)}"
        )
    rows = (row for section in compared.sections for row in section.rows)
    return max(rows, key=lambda row: row.weight)
