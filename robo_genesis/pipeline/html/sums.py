"""SHA256SUMS: the digests of all files of a site, in the form that `sha256sum -c` reads."""

import hashlib
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from robo_genesis.core.files import write_whole
from robo_genesis.core.project import ProjectError

SUMS = "SHA256SUMS"
"""The file's name in the site. It does not list itself."""


def write_sums(html: Path, known: Mapping[str, str] = MappingProxyType({})) -> Path:
    """Write the digests of a complete site into the site; return the file.

    Args:
        html: the folder of the site with its archive. The archive holds no SHA256SUMS: its pages
            differ from the site's by the offer of the archive, and its own digest is in the file.
        known: digests by name of the file; the other files are read.

    Raises:
        ProjectError: a file is a link, or its name has a character that `sha256sum` would escape.
    """
    lines = []
    for path in sorted(html.rglob("*"), key=lambda path: path.relative_to(html).as_posix()):
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
