"""The engine pin: which version may replace it, and how it is written."""

import re
from importlib.metadata import distributions
from pathlib import Path

from packaging.utils import canonicalize_name
from packaging.version import InvalidVersion, Version

from robo_genesis.core.project import ENGINE, ProjectError, locked_versions

FILES = ("pyproject.toml", "requirements.lock")
"""What a change of the pin changes: measured results are never kept in the tree."""


class RepinError(ProjectError):
    """The new pin was refused or failed; the message is the whole report."""


def wanted_version(given: str, pin: str) -> str:
    """Return the wanted version, without a leading `v`; whether it exists, pip knows.

    Args:
        given: what the user gave.
        pin: the version that is pinned now.

    Raises:
        RepinError: it is not a version, or it is the pin.
    """
    try:
        version = Version(given)
    except InvalidVersion:
        valid = f"Usage: make repin GENESIS=1.2.3 (the pin is {pin})."
        raise RepinError(f"GENESIS={given!r} is not a version. {valid}") from None
    if version == Version(pin):
        raise RepinError(f"GENESIS={given} is the pin already. Give another version.")
    return str(version)


def require_locked_packages(root: Path) -> None:
    """Raise RepinError if this environment is not the one that the lock describes.

    The new lock keeps the installed versions, so they must be those of the old one.
    """
    installed = {canonicalize_name(d.name): d.version.split("+")[0] for d in distributions()}
    unlike = [
        f"{name} {installed.get(canonicalize_name(name), '(none)')} instead of {version}"
        for name, version in locked_versions((root / FILES[1]).read_text("utf8")).items()
        if installed.get(canonicalize_name(name)) != version
    ]
    if unlike:
        raise RepinError(
            f"This environment differs from requirements.lock: {', '.join(unlike[:5])}"
            f"{', …' if unlike[5:] else ''}. Install the lock (pip install -r requirements.lock), "
            "or omit PYTHON=…, so that .venv is used."
        )


def set_pin(root: Path, old: str, new: str) -> None:
    """Write another engine version into the one line that pins it.

    Raises:
        ProjectError: the line is not written as expected.
    """
    path = root / FILES[0]
    pattern = rf"(?<=[\"']){ENGINE}\s*==\s*{re.escape(old)}(?=[\"'])"
    text, count = re.subn(pattern, f"{ENGINE}=={new}", path.read_text("utf8"))
    if count != 1:
        raise ProjectError(
            f'{path} has "{ENGINE}=={old}" {count} times, expected once. Write the pin in one line.'
        )
    path.write_text(text, "utf8")
