"""The whole site as one archive, for reading without a network, and the digests of its files."""

import zipfile
from collections.abc import Iterable, Iterator
from io import BytesIO
from pathlib import Path

from bs4 import BeautifulSoup

from robo_genesis.core.files import bytes_digest

# The archive's place in the site, for the link of the home page: unpack it, open
# `index.html`.
ARCHIVE = "offline/robo-genesis-site.zip"
FOLDER = "robo-genesis-site"  # The folder that unpacking makes

# A page's offer of the archive; the archive's own copy of the page must not have it.
OFFER = ".offline-offer"
# The level of compression. Level 6 takes 1.6 times as long and makes the archive 2 %
# smaller.
LEVEL = 3
DATE = (1980, 1, 1, 0, 0, 0)  # the earliest one: the same site makes the same archive

# The file with the digests. It does not list itself.
SUMS = "SHA256SUMS"


def pack(html: Path) -> Path:
    """Put the archive of a complete site into the site, and return its file.

    Args:
        html: the folder of the site.
    """
    files = ((f"{FOLDER}/{n}", without_offer(n, data)) for n, data in contents(html))
    archive = html / ARCHIVE
    archive.parent.mkdir()
    archive.write_bytes(zipped(files))
    return archive


def contents(folder: Path) -> Iterator[tuple[str, bytes]]:
    """Yield name and content of each file below a folder."""
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            yield path.relative_to(folder).as_posix(), path.read_bytes()


def zipped(files: Iterable[tuple[str, bytes]]) -> bytes:
    """Return an archive of files by name whose bytes depend on nothing else."""
    target = BytesIO()
    with zipfile.ZipFile(target, "w") as packed:
        for name, content in files:
            entry = zipfile.ZipInfo(name, DATE)
            entry.external_attr = 0o644 << 16
            packed.writestr(entry, content, zipfile.ZIP_DEFLATED, LEVEL)
    return target.getvalue()


def without_offer(name: str, data: bytes) -> bytes:
    """Return the content of a file, of a page without its offer of the archive."""
    if not name.endswith(".html") or OFFER[1:].encode() not in data:
        return data
    page = BeautifulSoup(data, "html.parser")
    for offer in page.select(OFFER):
        offer.decompose()
    return page.encode()


def sums(files: Iterable[tuple[str, bytes]]) -> bytes:
    """Return the digests of files by name, as `sha256sum -c` reads them."""
    return "".join(f"{bytes_digest(data)}  {name}\n" for name, data in files).encode()
