"""`make agree`: two machines that executed the same pages left equal arrays."""

from collections.abc import Iterator
from pathlib import Path

from robo_genesis.core.project import ProjectError
from robo_genesis.evidence.bundle import sha256
from robo_genesis.pipeline.pages.folder import plain_files, read_record
from robo_genesis.pipeline.pages.store import exported_folders

ARRAYS = ".npz"  # Ends the name of an archive of arrays. Its bytes depend on the arrays alone.

Digests = dict[str, str]
"""The SHA-256 of each archive of one page, by its name in the folder of the page."""


def agree(first: Path | None, second: Path | None) -> list[str]:
    """Require equal arrays from two executions of the same pages.

    Digests are computed from the files. Outputs, frames and logs are not compared: they contain
    times and names of machines.

    Args:
        first: holds the folders that `make execute` exported on one machine, at any depth.
        second: those of another machine.

    Returns:
        The last line for the user: the number of arrays and pages.

    Raises:
        ProjectError: a page or an archive is missing in one of them, or its digest differs.
        PageRefused: a folder is not an executed page.
    """
    one, other = _digests("FIRST", first), _digests("SECOND", second)
    lines = [line for page in sorted({*one, *other}) for line in _differences(page, one, other)]
    number = sum(map(len, one.values()))
    if not number:
        lines.append(f"FIRST={first} has no arrays ({ARRAYS}). Execute the measuring pages.")
    if lines:
        raise ProjectError("\n".join([f"{first} and {second} do not agree.", *lines]))
    return [f"Equal: {number} archives of arrays on {len(one)} pages."]


def _digests(name: str, folder: Path | None) -> dict[str, Digests]:
    """Return the digests of the arrays of each executed page of a folder."""
    if folder is None or not folder.is_dir():
        raise ProjectError(
            f"{name}={str(folder or '')!r} is not a folder. Usage: make agree FIRST=folder "
            "SECOND=folder; `make execute TO=folder` fills each on another machine."
        )
    found = {}
    for place in exported_folders(folder):
        docname = read_record(place).docname
        if docname in found:
            raise ProjectError(f"{name}={folder} has {docname} twice. Remove one.")
        archives = (file for file in plain_files(place) if file.endswith(ARRAYS))
        found[docname] = {file: sha256(place / file) for file in archives}
    return found


def _differences(page: str, first: dict[str, Digests], second: dict[str, Digests]) -> Iterator[str]:
    """Yield a line for each difference of one page."""
    for name, pages in (("FIRST", first), ("SECOND", second)):
        if page not in pages:
            yield f"{page} is not in {name}. Execute it there: make execute PAGE={page} TO=folder"
            return
    one, other = first[page], second[page]
    for file in sorted({*one, *other}):
        if one.get(file) != other.get(file):
            digests = (digests.get(file, "none")[:12] for digests in (one, other))
            yield (
                f"{page}: {file} has the digests {' and '.join(digests)}, equal ones are expected. "
                "The manifests beside the arrays name processor and packages of both machines."
            )
