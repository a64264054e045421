"""Change several files of the checkout as one: a kill leaves all of the old or all of the new.

The new files are staged below `.cache/repin/apply`, the journal that lists them is written last.
From then on the change is decided: `recover` completes it as often as it is broken off. Without a
journal nothing has been touched, and what was staged is thrown away.

`make` runs this file before any target, with the Python that `.venv` is made from, so it needs the
standard library alone and nothing of the package. A script that is run without make calls
`recover_or_exit` first.
"""

import fcntl
import hashlib
import json
import os
import shutil
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
STAGED = Path(".cache", "repin", "apply")
LOCK = STAGED.with_name("apply.lock")
JOURNAL, FILES = "journal.json", "files"


class ApplyError(Exception):
    """The change cannot be applied or completed; the message says what to do."""


class UnfinishedError(ApplyError):
    """The change is decided, and files of both states may stand in the checkout."""


def digest(path: Path) -> str:
    """Return the sha256 of a file as hex digits, of an absent one as of an empty text."""
    return hashlib.sha256(path.read_bytes() if path.exists() else b"").hexdigest()


def apply(root: Path, source: Path, before: dict[str, str]) -> None:
    """Replace files of a checkout by those of a copy, all or none.

    Args:
        root: the checkout.
        source: the copy that holds the new files under the same names.
        before: name of each file, relative to the checkout, to the digest that it must still have.

    Raises:
        ApplyError: a file was changed meanwhile; nothing is touched.
        UnfinishedError: a file cannot be written; the next `recover` completes the change.
        OSError: the new files cannot be staged; nothing is touched.
    """
    with _alone(root), _decided(root):
        _recover(root)
        changed = [name for name, old in before.items() if digest(root / name) != old]
        if changed:
            raise ApplyError(
                f"{' and '.join(changed)} changed while the new version was tried, so nothing is "
                "applied. Run make repin again; what is compiled and executed is reused."
            )
        _stage(root / STAGED, source, before)
        _recover(root)


def recover(root: Path = ROOT) -> None:
    """Complete or throw away what an earlier `apply` left; without anything left, do nothing.

    Raises:
        UnfinishedError: a file cannot be written, and the next call goes on; or one was edited
            after the kill, and the message offers both ways out.
    """
    if (root / STAGED).exists():
        with _alone(root), _decided(root):
            _recover(root)


def recover_or_exit(status: int = 1) -> None:
    """Do as `recover` does; where it cannot, say why and exit with a status."""
    try:
        recover()
    except (ApplyError, OSError) as error:
        print(f"An interrupted make repin cannot be completed: {error}", file=sys.stderr)
        sys.exit(status)


def _stage(folder: Path, source: Path, before: dict[str, str]) -> None:
    """Write the new files, then the journal that makes them count, each down to the disk."""
    entries = []
    for name, old in before.items():
        target = folder / FILES / name
        target.parent.mkdir(parents=True, exist_ok=True)
        _write(target, (source / name).read_bytes())
        entries.append({"name": name, "old": old, "new": digest(target)})
    _flush_folders(entry.parent for entry in (folder / FILES).rglob("*"))
    partial = folder / f"{JOURNAL}.partial"
    _write(partial, json.dumps(entries).encode())
    os.replace(partial, folder / JOURNAL)
    _flush_folders([folder, folder.parent])


def _recover(root: Path) -> None:
    """Go on where the journal is; the staged files stay until all of them are in place."""
    folder = root / STAGED
    if (folder / JOURNAL).exists():
        entries = json.loads((folder / JOURNAL).read_bytes())
        _refuse_edited(root, entries)
        for entry in entries:
            target = root / entry["name"]
            if digest(target) != entry["new"]:
                _replace(target, folder / FILES / entry["name"])
        _flush_folders((root / entry["name"]).parent for entry in entries)
        os.unlink(folder / JOURNAL)
    with suppress(OSError):  # what is left says nothing any more; the next call removes it
        _flush_folders([folder])
        shutil.rmtree(folder)


def _refuse_edited(root: Path, entries: list[dict[str, str]]) -> None:
    """Raise UnfinishedError where a file is neither old nor new: that is someone's work."""
    names = [e["name"] for e in entries if digest(root / e["name"]) not in (e["old"], e["new"])]
    if names:
        raise UnfinishedError(
            f"make repin was killed while it changed {', '.join(e['name'] for e in entries)}, and "
            f"{' and '.join(names)} was edited since. To complete the change, take that edit back; "
            f"to keep what stands there now, remove {root / STAGED}."
        )


def _replace(target: Path, staged: Path) -> None:
    """Put a copy of a staged file in the target's place in one move, with the target's mode."""
    partial = target.with_name(f".{target.name}.repin")
    _write(partial, staged.read_bytes())
    if target.exists():
        shutil.copymode(target, partial)
    os.replace(partial, target)


def _write(path: Path, content: bytes) -> None:
    with path.open("wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())


def _flush_folders(folders: Iterable[Path]) -> None:
    for folder in set(folders):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


@contextmanager
def _alone(root: Path) -> Iterator[None]:
    """Wait for another process that applies or recovers; a killed one holds nothing."""
    lock = root / LOCK
    lock.parent.mkdir(parents=True, exist_ok=True)
    with lock.open("a") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


@contextmanager
def _decided(root: Path) -> Iterator[None]:
    """Tell a failure that leaves the journal, and so a decided change, from one before it."""
    try:
        yield
    except OSError as error:
        if not (root / STAGED / JOURNAL).exists():
            raise
        raise UnfinishedError(
            f"The change is decided and not complete: {error}. Clear that away, or give it free "
            "space or write access; the next command completes the change."
        ) from error


if __name__ == "__main__":
    recover_or_exit()
