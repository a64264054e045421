"""The site of a build before it is published: a copy of what Sphinx rendered, and its archive.

Most files of a kept folder stay as they are. They are copied and packed while Sphinx works, and
what it changed is copied again after it. A file with the content of the published one is a link to
it: writing the whole site takes longer.
"""

import hashlib
import os
from contextlib import suppress
from pathlib import Path
from zipfile import ZipFile

from robo_genesis.build.site import archive
from robo_genesis.core.files import write_or_link

BUILD_INFO = ".buildinfo"
"""A note of Sphinx for its next build, which depends on the checkout's path."""


class Draft:
    """A growing copy of a rendered site, which shares no file with it.

    `digests` has the SHA-256 of each file that was copied, by its name in the site.
    """

    def __init__(self, rendered: Path, folder: Path, published: Path):
        """Begin an empty copy, before Sphinx begins.

        Args:
            rendered: the folder with Sphinx's pages; it may not exist yet.
            folder: gets what will be published; the site is its folder `html`.
            published: what is published now; it may not exist.
        """
        self.rendered, self.folder, self.published = rendered, folder, published
        self.html = folder / "html"
        self.digests: dict[str, str] = {}
        self._packed: ZipFile | None = None
        self.html.mkdir(parents=True)
        self._begin = self.html.stat().st_ctime_ns  # by the clock of the file system

    def prepare(self) -> None:
        """Copy and pack what is there while Sphinx works; `complete` and `pack` correct it."""
        self._update()
        self._packed = archive.begin(self.html)

    def complete(self) -> "Draft":
        """Make the copy equal to what Sphinx rendered, after it ended; return this draft."""
        changed = self._update()
        if self._packed and any(map(archive.lasting, changed)):
            self._packed.close()
            self._packed = None
        return self

    def pack(self) -> Path:
        """Put the archive into the complete site and return it."""
        return archive.pack(self.html, self._packed)

    def _update(self) -> set[str]:
        """Copy what Sphinx may have written since the last call; return the names that changed."""
        changed, found = set(), set()
        for here, _, files in os.walk(self.rendered):  # passes over a folder that disappears
            for path in (Path(here, file) for file in files if file != BUILD_INFO):
                name = path.relative_to(self.rendered).as_posix()
                with suppress(FileNotFoundError):  # Sphinx is replacing it
                    if self._copied(path, name):
                        changed.add(name)
                    found.add(name)
        for name in self.digests.keys() - found:
            (self.html / name).unlink()
            del self.digests[name]
            changed.add(name)
        return changed

    def _copied(self, path: Path, name: str) -> bool:
        """Copy a file if its content is not in the copy; return whether it was copied."""
        if name in self.digests and path.stat().st_ctime_ns < self._begin:
            return False
        content = path.read_bytes()
        digest = hashlib.sha256(content).hexdigest()
        if digest == self.digests.get(name):
            return False
        (self.html / name).parent.mkdir(parents=True, exist_ok=True)
        write_or_link(self.html / name, content, self.published / "html" / name)
        self.digests[name] = digest
        return True
