"""The site of a build before it is published, or of `make live`: a copy of what Sphinx rendered.

Most files of a kept folder stay as they are, and only what changed is copied again.
"""

import hashlib
import os
from contextlib import suppress
from pathlib import Path

from robo_genesis.core.files import write_whole

# A note of Sphinx for its next build, which depends on the checkout's path.
BUILD_INFO = ".buildinfo"


class Draft:
    """A growing copy of a rendered site, which shares no file with it.

    `digests` has the SHA-256 of each file that was copied, by its name in the site.
    """

    def __init__(self, rendered: Path, folder: Path):
        """Begin an empty copy.

        Args:
            rendered: the folder with Sphinx's pages; it may not exist yet.
            folder: gets what will be published; the site is its folder `html`.
        """
        self.rendered, self.folder = rendered, folder
        self.html = folder / "html"
        self.digests: dict[str, str] = {}
        self.html.mkdir(parents=True)

    def complete(self) -> "Draft":
        """Make the copy equal to what Sphinx rendered, after it ended; return this draft.

        Raises:
            OSError: a file or folder cannot be read.
        """
        names = self._names()
        for name in (
            self.digests.keys() - names
        ):  # first: a folder may have taken a file's name
            (self.html / name).unlink()
            with suppress(OSError):  # the folder has other files
                os.removedirs((self.html / name).parent)
            del self.digests[name]
        for name in names:
            content = (self.rendered / name).read_bytes()
            digest = hashlib.sha256(content).hexdigest()
            if digest != self.digests.get(name):
                write_whole(
                    self.html / name, content
                )  # a browser of `make live` gets no part of it
                self.digests[name] = digest
        return self

    def _names(self) -> set[str]:
        """Return the names of the rendered files."""

        def report(error: OSError) -> None:
            raise error

        return {
            Path(here, file).relative_to(self.rendered).as_posix()
            for here, _, files in os.walk(
                self.rendered, onerror=report, followlinks=True
            )
            for file in files
            if file != BUILD_INFO
        }
