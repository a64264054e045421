"""The whole site as one archive, for reading without a network, and the digests of its files."""

import hashlib
import zipfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import BinaryIO

from bs4 import BeautifulSoup

from robo_genesis.core.files import derived, write_whole
from robo_genesis.core.project import ProjectError

# The archive's place in the site, for the link of the home page: unpack it, open
# `index.html`.
ARCHIVE = "offline/robo-genesis-site.zip"
FOLDER = "robo-genesis-site"  # The folder that unpacking makes

# A page's offer of the archive; the archive's own copy of the page must not have it.
OFFER = ".offline-offer"
# Suffixes of files that compression makes no smaller.
COMPRESSED = {".jpg", ".png", ".webp", ".whl", ".woff2", ".zip"}
# The level of compression. Level 6 takes 1.6 times as long and makes the archive 2 %
# smaller.
LEVEL = 3
DATE = (1980, 1, 1, 0, 0, 0)  # the earliest one: the same site makes the same archive

# The file with the digests, as `sha256sum -c` reads them. It does not list itself.
SUMS = "SHA256SUMS"


def pack(html: Path) -> Path:
    """Put the archive of a site into the site.

    Args:
        html: the folder of the complete site, before its checks: they include links to
            the archive.

    Returns:
        The archive. The same files make the same bytes.
    """
    archive = html / ARCHIVE
    archive.parent.mkdir(exist_ok=True)
    files = sorted(
        path for path in html.rglob("*") if path.is_file() and path != archive
    )
    names = (f"{FOLDER}/{path.relative_to(html).as_posix()}" for path in files)
    write_zip(archive, zip(names, map(content, files), strict=True))
    return archive


def write_zip(target: Path | BinaryIO, files: Iterable[tuple[str, bytes]]) -> None:
    """Write an archive of files by name whose bytes depend on nothing else."""
    with zipfile.ZipFile(target, "w") as packed:
        for name, content in files:
            entry = zipfile.ZipInfo(name, DATE)
            packs = Path(name).suffix not in COMPRESSED
            entry.compress_type = zipfile.ZIP_DEFLATED if packs else zipfile.ZIP_STORED
            entry.external_attr = 0o644 << 16
            packed.writestr(entry, content, compresslevel=LEVEL)


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


def write_sums(html: Path, known: Mapping[str, str]) -> Path:
    """Write the digests of a complete site into the site; return the file.

    Args:
        html: the folder of the site with its archive. The archive holds no SHA256SUMS:
            its pages differ from the site's by the offer of the archive, and its own
            digest is in the file.
        known: digests by name of the file; the other files are read.

    Raises:
        ProjectError: a file is a link, or its name has a character that `sha256sum`
            would escape.
    """
    lines = []
    for path in sorted(
        html.rglob("*"), key=lambda path: path.relative_to(html).as_posix()
    ):
        name = path.relative_to(html).as_posix()
        if path.is_symlink() or set(name) & set("\\\n\r"):
            raise ProjectError(
                f"The site's file {name!r} is a link, or has a backslash or a new line in its "
                f"name. {SUMS} lists plain files with plain names. Rename or copy it."
            )
        if path.is_file() and name != SUMS:
            digest = known.get(name) or hashlib.sha256(path.read_bytes()).hexdigest()
            lines.append(f"{digest}  {name}\n")
    write_whole(html / SUMS, "".join(lines).encode())
    return html / SUMS
