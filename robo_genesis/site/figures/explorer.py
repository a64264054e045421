"""Recorded results to choose from: ```` ```{explorer} l05/cameras world ````.

A reader chooses a cell of a map or a pixel of a picture, and reads what was recorded
there. A map can have curves of the chosen run, or the chosen posture in 3D. The data
come from the lesson's `explorer.explored`, which gets the experiment of the page's
bundle and the directive's second word:

| key | content |
|---|---|
| `columns` | names of the values that are read |
| `maps` | each a `label`, a `caption`, labels of `columns`, and `rows` of a `label` and `cells` |
| `measures` | each a `label` |
| `choices` | labels of the choice of a map and of a measure, by default `Map`, `Cells show` |
| `notes` | the meaning of signs in the cells |
| `curves` | what is drawn of a run; each map has the axes, each cell the packed values |
| `postures` | by run the targets (m, 3) [m] of its answers; each map names its `run` |
| `traces` | runs of the postures that are not in the bundle, by name |
| `around` | whether what does not move is drawn with the postures |
| `tables` | by caption the rows of a table below the fold |
| `picture` | `name`, `alt` and `caption` of a recorded view; see `l05.explorer.picture` |
| `without_script` | the sentence for a browser without scripts |

A cell has `name`, `sentence`, `values` of the columns, `numbers` and `texts` of the
measures. It may have a `tag` and a `state`, and one cell `opens`.
"""

import base64
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import trimesh
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robo_genesis.core import tables
from robo_genesis.core.channels import Run
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.markup import filled
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.shown import find
from robo_genesis.lessons import find_replay
from robo_genesis.pipeline.pages.outputs import accepted_experiment
from robo_genesis.pipeline.pages.page_index import page_bundle
from robo_genesis.sim.visual_shape import WORLD, Part, load_shape
from robo_genesis.site.evidence.plain_nodes import html, image, on_request, scroll_box
from robo_genesis.site.evidence.runs import BACKEND
from robo_genesis.site.pages import PageDirective
from robo_genesis.site.replay import controls
from robo_genesis.site.replay import directive as replays
from robo_genesis.site.replay.scenery import (
    AXIS_RGB,
    Camera,
    Scenery,
    fitted,
    floor_of,
    moved,
)

# Name of the cross at the target, which moves like a link, length and radius of its
# rods [m]. They are longer than the hand, which hides the target when it is there.
CROSS, CROSS_LENGTH, CROSS_RADIUS = "target", 0.3, 0.006


# The parts of a recorded view; the second and the third hold numbers.
FRAMES = ("rgb", "depth", "segmentation")

# See the module's table.
Data: TypeAlias = Mapping[str, Any]


class ExplorerDirective(PageDirective):
    """Show what a page's bundle of this build recorded, one result at a time."""

    required_arguments = 1
    optional_arguments = 1

    def shown(self) -> list[nodes.Node]:
        """Return the explorer, or SKIP for a picture of a run without a camera."""
        lesson_page, *name = self.arguments
        lesson, folder = lesson_page.split("/")[0], page_bundle(lesson_page)
        run = accepted_experiment(folder)
        explored = find(f"robo_genesis.lessons.{lesson}.explorer.explored")
        key = f"{lesson_page}/{BACKEND}"
        file = "-".join([*key.split("/"), *name])
        return [explorer_block(self, key, file, folder, run, explored(run, *name))]


def explorer_block(
    directive: SphinxDirective,
    key: str,
    file: str,
    folder: Path,
    run: Experiment,
    data: dict[str, Any],
) -> nodes.Node:
    """Return an explorer with all that it shows without a script.

    Args:
        directive: the directive that shows it.
        key: names the run, as in the ledger.
        file: how the names of its files end.
        folder: of the bundle.
        run: the accepted bundle.
        data: see the module's table.
    """
    block = nodes.container(classes=["explorer-block"], evidence_runs=(key,))
    if "picture" in data:
        block += picture(directive, f"picture-{file}", folder / "frames", data)
    elif "postures" in data:
        block["classes"].append("replay-block")
        block += postures(directive, f"postures-{file}", folder, run, data)
    else:
        block += [opening("", data), panel(data)]
    return block


def opening(kind: str, data: Data, **words: str) -> nodes.Node:
    """Return the start of an explorer, with what `_static/explorer.js` needs to know."""
    words |= {"explorer": controls.as_json(data)}
    return html(controls.opening(f"explorer {kind}".strip(), words))


def panel(data: Data, loads: str = "") -> nodes.Node:
    """Return the controls and the end of an explorer; the script fills and shows them.

    A map has the choices of it, places for its cells and a sentence; a picture has a
    slider each for column and row. `loads` says what a button loads.
    """
    return html(filled(Path(__file__).with_suffix(".html"), **data, loads=loads))


def picture(
    directive: SphinxDirective, file: str, folder: Path, data: dict[str, Any]
) -> list[nodes.Node]:
    """Return a recorded view, the cross that marks a pixel, and what reads its values.

    The frames that hold numbers are part of the data: a page from disk cannot read the
    pixels of a file.
    """
    view = data.pop("picture")
    rgb, *numbers = (folder / f"{view['name']}_{part}.png" for part in FRAMES)
    if not rgb.is_file():
        return [nodes.paragraph("", "SKIP: this run has no camera.")]
    texts = (base64.b64encode(frame.read_bytes()).decode() for frame in numbers)
    data["frames"] = dict(zip(FRAMES[1:], texts, strict=True))
    shown = image(directive.env, f"{file}.png", rgb.read_bytes(), view["alt"])
    cross = '<span class="cross"></span>'
    figure = replays.stage(shown, cross, view["caption"], file)
    return [opening("with-picture", data), figure, panel(data)]


def postures(
    directive: SphinxDirective,
    name: str,
    folder: Path,
    run: Experiment,
    data: dict[str, Any],
) -> Iterator[nodes.Node]:
    """Yield the answers of a page in 3D, and leave one model with an animation for each map.

    Args:
        directive: the directive that shows them.
        name: of the model's files.
        folder: of the bundle.
        run: the accepted bundle.
        data: see the module's table.
    """
    env, lesson = directive.env, name.split("-")[1]
    replay = find_replay(lesson)
    runs = {**run.traces, **data.pop("traces", {})}
    traces = {
        run: with_target(runs[run], of) for run, of in data.pop("postures").items()
    }
    tables_below = data.pop("tables", {})
    shape = replays.shape_file(lesson, replay.thing)
    camera = fitted(
        np.concatenate([t.link_pos.reshape(-1, 3) for t in traces.values()])
    )
    parts = [p for p in load_shape(shape) if p.link != WORLD or data.get("around")]
    files, weight, still = replays.leave_model(
        env,
        name,
        folder,
        shape,
        (with_cross(parts, camera), [*run.links, CROSS], traces, replay.credit),
        "The robot at the start, drawn from the recorded poses.",
    )
    alt = "The robot in 3D, in the chosen posture."
    yield opening("with-model", data, alt=alt, **files)
    over = controls.over_the_picture("Show in 3D")
    caption = "Recorded postures of the robot. Yellow cross: the target."
    yield replays.stage(still, over, caption, f"{name}-model")
    yield panel(data, f"Show in 3D loads the robot: {weight} kB.")
    if tables_below:
        yield html("<details><summary>All answers as tables</summary>")
        below = on_request()
        for title, rows in tables_below.items():
            below += nodes.paragraph("", title)
            table = directive.parse_text_to_nodes(tables.markdown(rows))
            below += scroll_box(title, *table)
        yield below
        yield html("</details>")
    yield html(replays.origin_html(name, folder, env, replay.credit))


def with_target(trace: Run, targets: FloatArray) -> Run:
    """Return answers with one more link, the target of each; before the first, that of the first.

    Args:
        trace: a start and m answers.
        targets: (m, 3) [m].
    """
    places = np.vstack([targets[:1], targets])[:, None]
    turns = np.broadcast_to([1.0, 0.0, 0.0, 0.0], (len(places), 1, 4))
    pos = np.concatenate([trace.link_pos, places], axis=1)
    return moved(trace.t, pos, np.concatenate([trace.link_quat, turns], axis=1))


def with_cross(parts: Sequence[Part], camera: Camera) -> Scenery:
    """Return parts with the cross at the target and a floor, as a camera sees them."""
    half = CROSS_LENGTH / 2 * np.eye(3)
    rods = [
        trimesh.creation.cylinder(CROSS_RADIUS, segment=[-end, end]) for end in half
    ]
    cross = [Part(CROSS, AXIS_RGB, rod.vertices, rod.faces) for rod in rods]
    return Scenery([*parts, *cross, *floor_of(parts)], camera)


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("explorer", ExplorerDirective)
