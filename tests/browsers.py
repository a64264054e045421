"""The browser that tests open."""

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from threading import Event, Timer
from typing import TYPE_CHECKING

import psutil

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserType

# WebGL without a graphics card.
SOFTWARE = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")

PATIENCE = 120.0  # Seconds; a visit to a page takes two to four


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
        browser = launch(playwright.chromium, *arguments)
        yield browser
        browser.close()


def launch(kind: "BrowserType", *arguments: str) -> "Browser":
    return kind.launch(executable_path=chromium(), args=["--no-sandbox", *arguments])


def answered(browser: "Browser", ask: Callable, patience: float = PATIENCE) -> tuple:
    """Return a browser and what it answers: the given one, or a new one if that hangs.

    Rarely a page of Chromium waits for itself, and Playwright then waits for ever: its
    `evaluate` has no time limit. If the new browser hangs as well, the page is the
    reason, and the test fails.

    Args:
        browser: with which to try first; it is killed if it hangs.
        ask: what the browser is asked.
        patience: seconds after which it counts as hanging.
    """
    from playwright.sync_api import Error

    for last in (False, True):
        hangs = Event()
        timer = Timer(patience, lambda found=hangs: (found.set(), kill_browsers()))
        timer.start()
        try:
            return browser, ask(browser)
        except Error:
            if last or not hangs.is_set():
                raise
            browser = launch(browser.browser_type)
        finally:
            timer.cancel()
    raise AssertionError


def kill_browsers() -> None:
    """Kill the browsers of this process; Playwright then raises an error."""
    for process in psutil.Process().children(recursive=True):
        with suppress(psutil.NoSuchProcess):  # it ended with the one before
            if process.name() == "chromium":
                process.kill()
