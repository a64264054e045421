"""The whole site as one archive, for reading without a network: unpack it, open `index.html`."""

import zipfile
from pathlib import Path

from bs4 import BeautifulSoup

from robo_genesis.core.files import derived

ARCHIVE = "offline/robo-genesis-site.zip"
"""The archive's place in the site, for the link of the home page."""
FOLDER = "robo-genesis-site"
"""The folder that unpacking makes."""
OFFER = ".offline-offer"
"""A page's offer of the archive; the archive's own copy of the page must not have it."""
COMPRESSED = {".jpg", ".npz", ".png", ".webp", ".whl", ".woff2", ".zip"}
"""Suffixes of files that compression makes no smaller."""
LEVEL = 3
"""The level of compression. Level 6 takes 1.6 times as long and makes the archive 2 % smaller."""
DATE = (1980, 1, 1, 0, 0, 0)  # the earliest one: the same site makes the same archive


def pack(html: Path) -> Path:
    """Put the archive of a site into the site.

    Args:
        html: the folder of the complete site, before its checks: they include links to the archive.

    Returns:
        The archive. The same files make the same bytes.
    """
    archive = html / ARCHIVE
    files = sorted(path for path in html.rglob("*") if path.is_file() and path != archive)
    archive.parent.mkdir(exist_ok=True)
    with zipfile.ZipFile(archive, "w") as packed:
        for path in files:
            entry = zipfile.ZipInfo(f"{FOLDER}/{path.relative_to(html).as_posix()}", DATE)
            packs = path.suffix not in COMPRESSED
            entry.compress_type = zipfile.ZIP_DEFLATED if packs else zipfile.ZIP_STORED
            entry.external_attr = 0o644 << 16
            packed.writestr(entry, content(path), compresslevel=LEVEL)
    return archive


def content(path: Path) -> bytes:
    """Return a file for the archive: its content, a page's without the offer of the archive."""
    data = path.read_bytes()
    if path.suffix != ".html" or OFFER[1:].encode() not in data:
        return data

    def without_offer() -> bytes:
        page = BeautifulSoup(data, "html.parser")
        for offer in page.select(OFFER):
            offer.decompose()
        return page.encode()

    return derived("offline", [data, Path(__file__).read_bytes()], without_offer)
