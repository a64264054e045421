"""The browser that tests open."""

import shutil


def chromium() -> str:
    """Return the path of Chromium; a test without it fails."""
    path = shutil.which("chromium")
    assert path, "Chromium is missing. On Debian: apt install chromium"
    return path
