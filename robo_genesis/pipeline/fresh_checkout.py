"""A fresh checkout of HEAD, and the build of `make book RELEASE=1` in it.

The fresh checkout gets the commit's objects through git's own transfer, which computes
their names again, and nothing else: no file that the user's checkout or its index hides
or changes, no configuration of git, no bytecode, and of `.cache` only the named
folders. A release shares what the engine compiled: compiling takes minutes, and a test
requires equal arrays from reused and from new kernels.
"""

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from robo_genesis.core.files import locked
from robo_genesis.core.git import git, unclean
from robo_genesis.core.project import COMPILED, ROOT, STORE, ProjectError
from robo_genesis.pipeline.command import end_with_parent
from robo_genesis.pipeline.pages.kernels import (
    interrupts_blocked,
    users_variables,
    wait_or_kill,
)

# Folders of a release in the caches, and of the checkout in it. They stay if a release
# fails.
FOLDER, CHECKOUT = "release", "checkout"

# Caches whose folders are named by their inputs; a release shares what is compiled
# alone.
SHARED = ("derived", COMPILED, "npm", STORE)

# Variables of the outer make that a make in another checkout must not get: a new pin
# makes recorded bundles stale, which a release would refuse.
OUTER = (
    "GENESIS",
    "PYTHON",
    "BUNDLE",
    "RELEASE",
    "EXECUTED",
    "SECOND",
    "MAKEFLAGS",
    "MFLAGS",
    "MAKELEVEL",
    "PYTEST_ADDOPTS",
)

SETTINGS = (
    "RENDER",
    "JOBS",
    "SITE_URL",
    "SOLUTIONS",
    "SOURCE_DATE_EPOCH",
    "ROBO_GENESIS_BACKEND",
)

# What npm needs to fetch the locked packages; it compares them with the lock.
NETWORK = ("HTTP_PROXY", "HTTPS_PROXY", "NO_PROXY", "NODE_EXTRA_CA_CERTS")

# The whole configuration of the git that makes the checkout. A container's user may
# differ from the owner of the checkout, which git would refuse.
GIT_CONFIG = """\
[safe]
directory = *
[core]
attributesFile = /dev/null
excludesFile = /dev/null
autocrlf = false
"""


def release(
    arguments: Sequence[str], cache: Path, root: Path = ROOT, **handed: Path | None
) -> int:
    """Build the last commit in a fresh checkout, and return the exit status of its build.

    Args:
        arguments: of `build_scripts/book.py` there.
        cache: the folder of the caches.
        root: the checkout whose HEAD is built.
        handed: `executed` is the folder of pages that other machines executed at this
            commit, `second` that of a second execution.

    Raises:
        ProjectError: the tree has changes, git failed, or another release runs here.
    """
    if problems := unclean(root):
        raise ProjectError("\n".join(["RELEASE=1 cannot be met.", *problems]))
    with locked(cache / "release.lock", "Another release"):
        work = check_out(root, cache / FOLDER, cache, (COMPILED,))
        status = _build(work, [*arguments], release_environment(work, **handed))
        if status == 0:
            shutil.rmtree(cache / FOLDER)
        return status


@contextmanager
def fresh_checkout(root: Path, folder: Path, cache: Path) -> Iterator[Path]:
    """Check HEAD out with all shared caches, and remove it in the end; see `check_out`."""
    try:
        yield check_out(root, folder, cache, SHARED)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def check_out(root: Path, folder: Path, cache: Path, shared: Sequence[str]) -> Path:
    """Check HEAD of a repository out into a new one; return its folder.

    Args:
        root: the checkout whose HEAD is taken, with its history.
        folder: its older content is removed.
        cache: the folder of the caches.
        shared: the names of the caches that the new checkout uses as well.

    Raises:
        ProjectError: git failed.
    """
    commit = git(root, "rev-parse", "HEAD").strip()
    shutil.rmtree(folder, ignore_errors=True)
    work = folder / CHECKOUT
    work.mkdir(parents=True)
    config = folder / "gitconfig"
    config.write_text(GIT_CONFIG)
    own = {
        "GIT_CONFIG_GLOBAL": str(config),
        "GIT_CONFIG_NOSYSTEM": "1",
        "GIT_ATTR_NOSYSTEM": "1",
    }
    git(work, "init", "--quiet", "--template=", **own)
    source = root.resolve().as_uri()
    git(
        work, "fetch", "--quiet", "--no-tags", "--update-shallow", source, "HEAD", **own
    )
    git(work, "checkout", "--quiet", "--detach", commit, **own)
    (work / ".cache").mkdir()
    for name in shared:
        (cache / name).mkdir(parents=True, exist_ok=True)
        (work / ".cache" / name).symlink_to((cache / name).resolve())
    return work


def environment(work: Path, *without: str) -> dict[str, str]:
    """Return the variables for a command in a checkout: those of this process, with fewer names."""
    kept = {name: os.environ[name] for name in os.environ.keys() - {*OUTER, *without}}
    return kept | {"PYTHONPATH": str(work)}


def release_environment(work: Path, **handed: Path | None) -> dict[str, str]:
    """Return the whole environment of a release's build: of this process's, only listed names.

    Args:
        work: the fresh checkout.
        handed: see `release`.
    """
    names = {*SETTINGS, *NETWORK, *(name.lower() for name in NETWORK)}
    kept = users_variables() | {
        name: value
        for name, value in os.environ.items()
        if name in names or name.lower().startswith("npm_config_")
    }
    own = {
        "RELEASE": "1",
        "PYTHONPATH": str(work),
        "PYTHONPYCACHEPREFIX": str(work.parent / "bytecode"),
        "PYTHONNOUSERSITE": "1",
        "PYDANTIC_DISABLE_PLUGINS": "__all__",
    }
    return (
        kept
        | own
        | {n.upper(): str(path.absolute()) for n, path in handed.items() if path}
    )


def _build(work: Path, arguments: Sequence[str], environment: Mapping[str, str]) -> int:
    """Run the build of a checkout; it ends with this process, by Ctrl-C too."""
    script = str(work / "build_scripts" / "book.py")
    with interrupts_blocked():
        process = subprocess.Popen(
            [sys.executable, script, *arguments],
            cwd=work,
            env=environment,
            preexec_fn=end_with_parent(),
        )
    return wait_or_kill(process)
