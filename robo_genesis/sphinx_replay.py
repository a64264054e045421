"""A recorded run that plays in the page, and the files that only a reader's request loads.

A page writes ```` ```{replay} l04/lecture ````; the panel of a recorded run has one of its own.
Poses and curves are the record's; the shape of the robot is the model's, handed on by the lecture.
"""

import base64
import gzip
import json
import re
import shutil
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robo_genesis import npm, replay, robot_shape
from robo_genesis.derived import derived
from robo_genesis.evidence import bundle
from robo_genesis.evidence.traces import read_joints, read_trace
from robo_genesis.lessons import Compared, compared_cases
from robo_genesis.replay import Replay
from robo_genesis.sphinx_evidence import BACKEND, outputs_folder
from robo_genesis.sphinx_ledger import scroll_box

SHAPE_PAGE = "lecture"
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
The models (*.glb, and the same in *.js): {replay.CREDIT}.
The viewer ({VIEWER}): @google/model-viewer, © Google LLC, Apache-2.0. Changed here: the addresses
from which it would load decoders for compressed models are taken out, so that it asks no other
host.
The licence of both stands in {VIEWER_LICENCE}.
The viewer is one file made of these packages; the text of each licence stands in the file named:
"""


class ReplayDirective(SphinxDirective):
    """Play the runs of a page's bundle of this build."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return the replay.

        Errors are a page without a bundle, and a lesson that compares no cases.
        """
        lesson_page = self.arguments[0]
        if compared_cases(lesson_page.split("/")[0]) is None:
            raise self.error(
                f"replay: the lesson of {lesson_page} compares no cases. With cases and joint in "
                "robo_genesis/lessons.py it has a replay."
            )
        folder = outputs_folder() / lesson_page / BACKEND
        if not (folder / "manifest.json").is_file():
            raise self.error(f"replay: {lesson_page} left no bundle on {BACKEND}.")
        return [replay_block(self, f"{lesson_page}/{BACKEND}", folder)]


def replay_block(directive: SphinxDirective, key: str, folder: Path) -> nodes.Node:
    """Return what plays an accepted bundle, with all that it says in text and in a table.

    Args:
        directive: which asks for it.
        key: names the run, as the ledger does.
        folder: of the bundle.

    Raises:
        DirectiveError: no page of this build handed the robot's shape on, or another robot's.
    """
    env, lesson = directive.env, key.split("/")[0]
    compared = compared_cases(lesson)
    if compared is None:
        raise directive.error(f"replay: {lesson} compares no cases.")
    shown = read_replay(f"replay-{key.replace('/', '-')}", folder, compared)
    shape = outputs_folder() / lesson / SHAPE_PAGE / robot_shape.FILE
    if not shape.is_file():
        raise directive.error(
            f"replay: {lesson} handed on no shape of its robot. A cell of its {SHAPE_PAGE} must "
            f"call robot_shape.write_shape(contract.outputs / {lesson!r} / {SHAPE_PAGE!r}, "
            "robot_shape.read_shape(robot)) after the robot is built."
        )
    try:
        inputs = model_inputs(shape, folder, shown)
        model = derived("replay", inputs, lambda: make_model(shape, shown))
    except ValueError as error:
        raise directive.error(f"replay: {key}: {error}") from error
    written = write_model(Path(env.app.outdir) / FOLDER, shown.name, model)
    weight = written + len(gzip.compress(viewer()))
    up = "../" * env.docname.count("/") + FOLDER
    controls = replay.markup(shown, f"{up}/{shown.name}.js", f"{up}/{VIEWER}", round(weight / 1000))
    said = replay.moving(shown, bundle.read_metrics(folder))
    summary = f"All samples of {', '.join(shown.traces)} as a table"

    block = nodes.container(classes=["replay-block"], evidence_runs=(key,))
    block += nodes.raw("", controls, format="html")
    block += directive.parse_text_to_nodes("\n".join(f"- {text}" for text in said.values()))
    block += nodes.raw("", f"<details><summary>{summary}</summary>", format="html")
    block += scroll_box("", *directive.parse_text_to_nodes(replay.samples(shown)), label=summary)
    block += nodes.raw("", f"</details>{origin_html(shown.name, folder, up)}", format="html")
    return block


def make_model(shape: Path, shown: Replay) -> bytes:
    """Return the GLB of a replay; what makes meshes light takes long to load, so only here."""
    from robo_genesis import replay_model

    return replay_model.glb(robot_shape.load_shape(shape), shown.links, shown.traces)


def model_inputs(shape: Path, folder: Path, shown: Replay) -> Iterator[bytes]:
    """Yield everything that decides the GLB of a replay."""
    yield repr((list(shown.traces), list(shown.links))).encode()
    sources = Path(__file__).parent.rglob("*.py")
    for path in (shape, folder / "arrays.json", *sorted(folder.glob("arrays/*")), *sorted(sources)):
        yield path.read_bytes()


def read_replay(name: str, folder: Path, compared: Compared) -> Replay:
    """Return what is played of a bundle."""
    arrays = bundle.read_arrays(folder)
    return Replay(
        name=name,
        traces={case: read_trace(folder, arrays, case) for case in compared.cases},
        joints=read_joints(arrays),
        joint=compared.joint,
        links=arrays.coords["link"],
    )


def origin_html(name: str, folder: Path, up: str) -> str:
    """Say which run is played and whose model is shown; `up` leads to the replay's files."""
    run = bundle.read_manifest(folder).predicate
    return (
        f'<p class="credit">Poses and samples: {run.backend.actual}, Genesis {run.engine.version}, '
        f'run {run.run_id[:8]}. 3D model: <a href="{up}/{name}.glb" download>GLB</a>, '
        f'{replay.CREDIT} (<a href="{up}/{NOTICE}">notice</a>, '
        f'<a href="{up}/{VIEWER_LICENCE}">licence</a>).</p>'
    )


def write_model(folder: Path, name: str, model: bytes) -> int:
    """Write a model as GLB and as a classic script, and return the script's compressed size.

    A page that was opened from disk may fetch nothing, but may add a script.
    """
    folder.mkdir(parents=True, exist_ok=True)
    script = script_of(name, model)
    (folder / f"{name}.glb").write_bytes(model)
    (folder / f"{name}.js").write_bytes(script)
    return len(gzip.compress(script))


def script_of(name: str, model: bytes) -> bytes:
    """Return a model as a classic script."""
    text = base64.b64encode(model).decode()
    return f'(globalThis.replayModels ??= {{}})["{name}"] = "{text}";\n'.encode()


@cache
def viewer() -> bytes:
    """Return the viewer's script without addresses of other hosts."""
    package = npm.packages() / "@google" / "model-viewer"
    script = (package / "dist" / "model-viewer-umd.min.js").read_bytes()
    return b"/* See " + NOTICE.encode() + b". */\n" + ELSEWHERE.sub(b"", script)


def write_viewer(app: Sphinx, exception: Exception | None) -> None:
    """Put the viewer and the licences beside the models, where there are any."""
    folder = Path(app.outdir) / FOLDER
    if exception is None and folder.is_dir():
        (folder / VIEWER).write_bytes(viewer())
        (folder / NOTICE).write_text(CREDITS + "".join(copy_licences(folder)), "utf8")


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


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive and what writes the viewer."""
    app.add_directive("replay", ReplayDirective)
    app.connect("build-finished", write_viewer)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
