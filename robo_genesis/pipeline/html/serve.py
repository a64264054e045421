"""The handler of `make serve`: the site's own files, as static hosts send them."""

from http import HTTPStatus
from http.server import SimpleHTTPRequestHandler
from pathlib import Path
from typing import Any

INDEXES = ("index.html", "index.htm")
"""The files that a folder is served as."""


class SiteHandler(SimpleHTTPRequestHandler):
    """Sends files of the site alone: no link that leads out of it, and no list of a folder.

    Browsers take each file for the type that it is sent with.
    """

    def end_headers(self) -> None:
        """Add the header that forbids browsers to guess another type."""
        self.send_header("X-Content-Type-Options", "nosniff")
        super().end_headers()

    def send_head(self) -> Any:
        """Answer 404 where the base class would send a file outside the site."""
        root, asked = Path(self.directory).resolve(), Path(self.translate_path(self.path))
        for path in (asked, *(asked / name for name in INDEXES)):
            if not path.resolve().is_relative_to(root):
                self.send_error(HTTPStatus.NOT_FOUND, "Outside the site")
                return None
        return super().send_head()

    def list_directory(self, path: Any) -> None:
        """Answer 404 for a folder without a page."""
        self.send_error(HTTPStatus.NOT_FOUND, "No page in this folder")
