"""The viewer of the replays' models as the site ships it: one script, its licences and a notice."""

import json
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from sphinx.application import Sphinx

from robo_genesis.pipeline import npm

# Folder of the site; Jupyter Book would load every script of `_static` on every page.
FOLDER = "replay"
VIEWER = "model-viewer.js"

VIEWER_LICENCE = "LICENSE-Apache-2.0.txt"
NOTICE = "NOTICE.txt"

# Addresses in the viewer: of decoders for compressed models, which the site does not
# have, and of the viewer's own source.
ELSEWHERE = re.compile(
    rb"https://(?:www\.gstatic\.com|cdn\.jsdelivr\.net)/[^\"'`\s]*|//# sourceMappingURL=.*"
)

# The packages in the viewer's single file, each in the lock.
PARTS = (
    "@google/model-viewer",
    "three",
    "lit",
    "lit-html",
    "lit-element",
    "@lit/reactive-element",
    "@monogrid/gainmap-js",
)

CREDITS = f"""\
The viewer ({VIEWER}): @google/model-viewer, © Google LLC, Apache-2.0. Changed here: the addresses
from which it would load decoders for compressed models are removed, so that it contacts no other
host.
The text of Apache-2.0 is in {VIEWER_LICENCE}.
The viewer is one file made of these packages; the text of each licence is in the named file:
"""


@cache
def viewer() -> bytes:
    """Return the viewer's script without addresses of other hosts."""
    script = npm.published("@google/model-viewer/dist/model-viewer-umd.min.js")
    return b"/* See " + NOTICE.encode() + b". */\n" + ELSEWHERE.sub(b"", script)


def write_viewer(app: Sphinx, exception: Exception | None) -> None:
    """Write the viewer, the licences and the notice into the folder of the models, if it exists."""
    folder = Path(app.outdir) / FOLDER
    if exception is None and folder.is_dir():
        (folder / VIEWER).write_bytes(viewer())
        lines = [CREDITS, *copy_licences(folder), *model_credits(folder)]
        (folder / NOTICE).write_text("".join(lines), "utf8")


def model_credits(folder: Path) -> Iterator[str]:
    """Yield a line of the notice for each model that names a copyright."""
    for file in sorted(folder.glob("*.glb")):
        # The JSON is the first chunk; pygltflib takes seconds for all accessors in it.
        data = file.read_bytes()
        size = int.from_bytes(data[12:16], "little")
        if credit := json.loads(data[20 : 20 + size])["asset"].get("copyright"):
            yield f"The model {file.name}, and the same in {file.stem}.js: {credit}.\n"


def copy_licences(folder: Path) -> Iterator[str]:
    """Write the licence of each package in the viewer; yield a line of the notice for each."""
    for name in PARTS:
        about = npm.locked(name)
        own = f"LICENSE-{name.strip('@').replace('/', '-')}.txt"
        file = VIEWER_LICENCE if name == PARTS[0] else own
        (folder / file).write_bytes(npm.published(f"{name}/LICENSE"))
        yield f"- {name} {about['version']}: {about['license']}, {file}\n"
