"""Queries of a git checkout."""

import os
import subprocess
from pathlib import Path

from .project import ProjectError
from .text import quoted


def git(root: Path, *arguments: str) -> str:
    """Return the output of git in a folder; a query does not rewrite the user's index.

    It gets none of the variables that only git reads, such as GIT_DIR.

    Raises:
        ProjectError: git is not installed, or it failed; the message contains its
            output.
    """
    others = {
        name: value for name, value in os.environ.items() if not name.startswith("GIT_")
    }
    command = ["git", "--no-optional-locks", "-C", str(root), *arguments]
    try:
        done = subprocess.run(
            command,
            env=others,
            capture_output=True,
            encoding="utf8",
            errors="replace",
        )
    except OSError as error:
        raise ProjectError(
            "Git is not installed. Install it: apt install git."
        ) from error
    if done.returncode:
        output = done.stderr.strip() or f"exit status {done.returncode}"
        raise ProjectError(f"git {arguments[0]} failed in {root}: {output}")
    return done.stdout


def git_or_none(root: Path, *arguments: str) -> str | None:
    """Return the output of `git`, None if it fails or is not installed."""
    try:
        return git(root, *arguments)
    except ProjectError:
        return None


def require_clean(root: Path) -> None:
    """Raise ProjectError unless a checkout is its last commit."""
    status = git(root, "status", "--porcelain", "--untracked-files=all")
    if changed := [line[3:] for line in status.splitlines()]:
        raise ProjectError(
            f"The tree has {len(changed)} changed or new files ({quoted(changed)}). A worktree has "
            "the last commit alone: commit or stash them (git stash --include-untracked)."
        )
