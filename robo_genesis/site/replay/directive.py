"""A recorded run that plays in the page, and the files that only a reader's request loads.

A page writes ```` ```{replay} l04/lecture ````, or with the name of further cases that its lesson
declares, ```` ```{replay} l03/lab slides ````; the panel of a recorded run has one of its own.
Poses and curves are the record's; the shape of what moves is the model's, handed on by the lecture.
"""

import base64
import gzip
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robo_genesis.core import project
from robo_genesis.core.channels import Runs
from robo_genesis.core.content_cache import derived
from robo_genesis.evidence import bundle
from robo_genesis.evidence.replay_data import read_runs
from robo_genesis.lessons.registry import drawn_cases
from robo_genesis.sim import visual_shape
from robo_genesis.site.evidence.ledger import scroll_box
from robo_genesis.site.evidence.measured import BACKEND, outputs_folder
from robo_genesis.site.replay import controls as replay
from robo_genesis.site.replay.viewer import (
    FOLDER,
    NOTICE,
    VIEWER,
    VIEWER_LICENCE,
    viewer,
    write_viewer,
)

SHAPE_PAGE = "lecture"


class ReplayDirective(SphinxDirective):
    """Play the runs of a page's bundle of this build."""

    required_arguments = 1
    optional_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return the replay.

        Errors are a page without a bundle, and a lesson that compares no such cases.
        """
        lesson_page, *further = self.arguments
        folder = outputs_folder() / lesson_page / BACKEND
        if not (folder / "manifest.json").is_file():
            raise self.error(f"replay: {lesson_page} left no bundle on {BACKEND}.")
        return [replay_block(self, f"{lesson_page}/{BACKEND}", folder, *further)]


def replay_block(
    directive: SphinxDirective, key: str, folder: Path, further: str = ""
) -> nodes.Node:
    """Return what plays an accepted bundle, with all that it says in text and in a table.

    Args:
        directive: which asks for it.
        key: names the run, as the ledger does.
        folder: of the bundle.
        further: name of cases beside those that the lesson compares, empty for these.

    Raises:
        DirectiveError: the lesson plays no such cases or its runs cannot be played together; no
            page of this build handed their shape on, or another shape.
    """
    env, lesson = directive.env, key.split("/")[0]
    name = "-".join(("replay", *key.split("/"), *filter(None, [further])))
    try:
        runs = read_runs(folder, drawn_cases(lesson, further))
        shape = handed_on(lesson, runs.view.thing)
        inputs = model_inputs(shape, folder, runs)
        model = derived("replay", inputs, lambda: make_model(shape, runs))
        written = write_model(Path(env.app.outdir) / FOLDER, name, model)
        weight = written + len(gzip.compress(viewer()))
        up = "../" * env.docname.count("/") + FOLDER
        files = f"{up}/{name}.js", f"{up}/{VIEWER}"
        controls = replay.markup(name, runs, *files, round(weight / 1000))
    except (LookupError, ValueError) as error:
        raise directive.error(f"replay: {key}: {error}") from error
    summary = f"All samples of {', '.join(runs.traces)} as a table"

    block = nodes.container(classes=["replay-block"], evidence_runs=(key,))
    block += nodes.raw("", controls, format="html")
    block += directive.parse_text_to_nodes("\n".join(f"- {text}" for text in runs.moves.values()))
    block += nodes.raw("", f"<details><summary>{summary}</summary>", format="html")
    block += scroll_box("", *directive.parse_text_to_nodes(replay.samples(runs)), label=summary)
    origin = origin_html(name, folder, up, runs.view.credit)
    block += nodes.raw("", f"</details>{origin}", format="html")
    return block


def handed_on(lesson: str, thing: str) -> Path:
    """Return the file of the shape that a page of this build handed on.

    Raises:
        ValueError: there is none.
    """
    shape = outputs_folder() / lesson / SHAPE_PAGE / visual_shape.FILE
    if not shape.is_file():
        raise ValueError(
            f"{lesson} handed on no shape of its {thing}. A cell of its {SHAPE_PAGE} must "
            f"call robot_shape.write_shape(contract.outputs / {lesson!r} / {SHAPE_PAGE!r}, "
            f"robot_shape.read_shape({thing})) after the {thing} is built."
        )
    return shape


def make_model(shape: Path, runs: Runs) -> bytes:
    """Return the GLB of a replay; what makes meshes light takes long to load, so only here."""
    from robo_genesis.site.replay import model as replay_model

    parts = visual_shape.load_shape(shape)
    return replay_model.glb(parts, runs.links, runs.traces, runs.view.credit)


def model_inputs(shape: Path, folder: Path, runs: Runs) -> Iterator[bytes]:
    """Yield everything that decides the GLB of a replay."""
    yield repr((list(runs.traces), list(runs.links), runs.view.credit)).encode()
    sources = (project.ROOT / "robo_genesis").rglob("*.py")
    for path in (shape, folder / "arrays.json", *sorted(folder.glob("arrays/*")), *sorted(sources)):
        yield path.read_bytes()


def origin_html(name: str, folder: Path, up: str, credit: str | None) -> str:
    """Say which run is played and whose shape is shown.

    Args:
        name: of the replay.
        folder: of the bundle.
        up: leads to the replay's files.
        credit: of the shape, None where it is the scene's own.
    """
    run = bundle.read_manifest(folder).predicate
    words = f'<a href="{up}/{NOTICE}">notice</a>, <a href="{up}/{VIEWER_LICENCE}">licence</a>'
    whose = f"{credit} ({words})." if credit else f"shapes of the scene itself. Viewer: {words}."
    return (
        f'<p class="credit">Poses and samples: {run.backend.actual}, Genesis {run.engine.version}, '
        f'run {run.run_id[:8]}. 3D model: <a href="{up}/{name}.glb" download>GLB</a>, {whose}</p>'
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


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive and what writes the viewer."""
    app.add_directive("replay", ReplayDirective)
    app.connect("build-finished", write_viewer)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
