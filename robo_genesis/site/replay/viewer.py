"""The viewer of the replays' models as the site ships it: one script, its licences and a notice."""

import json
import re
import shutil
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from sphinx.application import Sphinx

from robo_genesis.build import npm

FOLDER = "replay"
"""Below the site; Jupyter Book loads every script of `_static` on every page, these on none."""

VIEWER = "model-viewer.js"
VIEWER_LICENCE = "LICENSE-Apache-2.0.txt"
NOTICE = "NOTICE.txt"
ELSEWHERE = re.compile(
    rb"https://(?:www\.gstatic\.com|cdn\.jsdelivr\.net)/[^\"'`\s]*|//# sourceMappingURL=.*"
)
"""Addresses in the viewer: of decoders for compressed models, which these are not, and of its own
source."""

PARTS = (
    "@google/model-viewer",
    "three",
    "lit",
    "lit-html",
    "lit-element",
    "@lit/reactive-element",
    "@monogrid/gainmap-js",
)
"""The packages whose code the viewer's one file holds, each in the lock."""

CREDITS = f"""\
The viewer ({VIEWER}): @google/model-viewer, © Google LLC, Apache-2.0. Changed here: the addresses
from which it would load decoders for compressed models are taken out, so that it asks no other
host.
Where Apache-2.0 is named here, its text stands in {VIEWER_LICENCE}.
The viewer is one file made of these packages; the text of each licence stands in the file named:
"""


@cache
def viewer() -> bytes:
    """Return the viewer's script without addresses of other hosts."""
    package = npm.packages() / "@google" / "model-viewer"
    script = (package / "dist" / "model-viewer-umd.min.js").read_bytes()
    return b"/* See " + NOTICE.encode() + b". */\n" + ELSEWHERE.sub(b"", script)


def write_viewer(app: Sphinx, exception: Exception | None) -> None:
    """Put the viewer, the licences and the notice beside the models, where there are any."""
    folder = Path(app.outdir) / FOLDER
    if exception is None and folder.is_dir():
        (folder / VIEWER).write_bytes(viewer())
        lines = CREDITS + "".join(copy_licences(folder)) + "".join(model_credits(folder))
        (folder / NOTICE).write_text(lines, "utf8")


def model_credits(folder: Path) -> Iterator[str]:
    """Yield for the notice whose each model is, by its own word; the course's own have none."""
    for file in sorted(folder.glob("*.glb")):
        content = file.read_bytes()
        length = int.from_bytes(content[12:16], "little")  # of the first chunk, which is JSON
        credit = json.loads(content[20 : 20 + length])["asset"].get("copyright")
        if credit:
            yield f"The model {file.name}, and the same in {file.stem}.js: {credit}.\n"


def copy_licences(folder: Path) -> Iterator[str]:
    """Copy the licence of each package in the viewer; yield a line on each for the notice."""
    for name in PARTS:
        package = npm.packages() / name
        said = json.loads((package / "package.json").read_text("utf8"))
        file = (
            VIEWER_LICENCE
            if name == PARTS[0]
            else f"LICENSE-{name.strip('@').replace('/', '-')}.txt"
        )
        shutil.copyfile(package / "LICENSE", folder / file)
        yield f"- {name} {said['version']}: {said['license']}, {file}\n"
