"""The browser that tests open."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Browser

SOFTWARE = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")
"""WebGL without a graphics card."""


def chromium() -> str:
    """Return the path of Chromium; a test without it fails."""
    path = shutil.which("chromium")
    assert path, "Chromium is missing. On Debian: apt install chromium"
    return path


@contextmanager
def launched(*arguments: str) -> Iterator["Browser"]:
    """Open Chromium with further arguments."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=chromium(), args=["--no-sandbox", *arguments]
        )
        yield browser
        browser.close()
