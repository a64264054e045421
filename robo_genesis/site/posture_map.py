"""Maps of recorded postures: ```` ```{posture-map} l05/solutions reach ````.

A reader chooses a cell, reads the values of its answer, and sees the posture in 3D. The lesson says
which maps there are and what is known of each answer; postures come from the bundle of a page.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robo_genesis.core import tables
from robo_genesis.core.channels import ReplayView
from robo_genesis.core.declaration import Compared
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.files import derived
from robo_genesis.core.scene import DT, FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.lessons import drawn_cases
from robo_genesis.sim.visual_shape import WORLD, Part, load_shape
from robo_genesis.site.evidence.ledger import scroll_box
from robo_genesis.site.evidence.measured import BACKEND
from robo_genesis.site.explorer import inputs, of_lesson
from robo_genesis.site.replay import controls
from robo_genesis.site.replay.directive import (
    leave_model,
    origin_html,
    replay_folder,
    shape_file,
    stage,
)

if TYPE_CHECKING:
    from robo_genesis.site.replay.scenery import Camera  # loads slowly

CROSS, CROSS_LENGTH, CROSS_RADIUS = "target", 0.3, 0.006
"""Name of the cross at the target, which moves like a link, length and radius of its rods [m]. They
are longer than the hand, which hides the target when it is there."""


class PostureMapDirective(SphinxDirective):
    """Show maps of the answers in a page's bundle of this build."""

    required_arguments = 2

    def run(self) -> list[nodes.Node]:
        """Return the maps with one picture in 3D.

        Errors: the page has no bundle, or its lesson has no such maps or wrote no shape.
        """
        folder, experiment, maps = of_lesson(self, "posture_maps")
        lesson_page, which = self.arguments
        lesson = lesson_page.split("/")[0]
        try:
            compared = drawn_cases(lesson)
            if not isinstance(compared, Compared):
                raise LookupError(f"{lesson} compares free bodies. Maps show a robot's postures.")
            shape = shape_file(lesson, compared.view.thing)
        except (LookupError, ValueError) as error:
            raise self.error(f"{self.name}: {lesson_page} {which}: {error}") from error
        key = f"{lesson_page}/{BACKEND}"
        return [posture_block(self, key, which, folder, experiment, maps, shape, compared.view)]


def posture_block(
    directive: SphinxDirective, key: str, which: str, folder: Path, experiment: Experiment,
    maps: Sequence[Mapping[str, Any]], shape: Path, view: ReplayView,
) -> nodes.Node:  # fmt: skip
    """Return maps with one picture in 3D, and a table of each.

    Args:
        directive: the directive that shows them.
        key: names the run, as in the ledger.
        which: names the maps.
        folder: of the bundle.
        experiment: of the bundle.
        maps: as the lesson's `explorer.posture_maps` returns them.
        shape: file of the robot's shape.
        view: the words for its 3D view.
    """
    from robo_genesis.site.replay.poster import picture  # these load slowly
    from robo_genesis.site.replay.scenery import fitted

    env, name = directive.env, "-".join(("postures", *key.split("/"), which))
    traces = {
        one["run"]: with_target(experiment.traces[one["run"]], one["targets"]) for one in maps
    }
    camera = fitted(np.concatenate([trace.link_pos.reshape(-1, 3) for trace in traces.values()]))
    built = [which.encode(), shape.read_bytes(), *inputs(folder)]
    parts = shape, experiment.links, traces, view, camera
    model = derived("replay", built, lambda: model_of(*parts))
    still = derived("poster", built, lambda: picture(model, camera))
    files, weight = leave_model(env, name, model)
    alt = f"The {view.thing} at the start, drawn from the recorded poses."
    caption = f"Recorded postures of the {view.thing}. Yellow cross: the target."
    summary = "All answers as tables"

    block = nodes.container(classes=["replay-block"], evidence_runs=(key,))
    block += nodes.raw("", opening(name, maps, camera, files, view), format="html")
    block += stage(env, name, still, alt, caption, controls.over_the_picture("Show in 3D"))
    block += nodes.raw("", panel(maps, weight, view.thing), format="html")
    block += nodes.raw("", f"<details><summary>{summary}</summary>", format="html")
    for one in maps:
        block += nodes.paragraph("", one["caption"])
        rows = directive.parse_text_to_nodes(tables.markdown(one["records"]))
        block += scroll_box("", *rows, label=one["caption"])
    origin = origin_html(name, folder, replay_folder(env), view.credit)
    block += nodes.raw("", f"</details>{origin}", format="html")
    return block


def with_target(trace: Trace, targets: FloatArray) -> Trace:
    """Return answers with one more link, the target of each; before the first, that of the first.

    Args:
        trace: a start and m answers.
        targets: (m, 3) [m].
    """
    places = np.vstack([targets[:1], targets])[:, None]
    turns = np.broadcast_to([1.0, 0.0, 0.0, 0.0], (len(places), 1, 4))
    return replace(
        trace,
        link_pos=np.concatenate([trace.link_pos, places], axis=1),
        link_quat=np.concatenate([trace.link_quat, turns], axis=1),
    )


def model_of(
    shape: Path,
    links: Sequence[str],
    traces: Mapping[str, Trace],
    view: ReplayView,
    camera: "Camera",
) -> bytes:
    """Return the model of all answers, one animation a map, with the cross and a floor."""
    import trimesh  # these load slowly

    from robo_genesis.site.replay import model
    from robo_genesis.site.replay.scenery import AXIS_RGB, Scenery, floor_of

    parts = [part for part in load_shape(shape) if part.link != WORLD]
    half = CROSS_LENGTH / 2 * np.eye(3)
    rods = [trimesh.creation.cylinder(CROSS_RADIUS, segment=[-end, end]) for end in half]
    cross = [Part(CROSS, AXIS_RGB, rod.vertices, rod.faces) for rod in rods]
    scenery = Scenery([*parts, *cross, *floor_of(parts)], camera)
    return model.glb(scenery, [*links, CROSS], traces, view.credit)


def opening(
    name: str, maps: Sequence[Mapping[str, Any]], camera: "Camera", files: controls.Files,
    view: ReplayView,
) -> str:  # fmt: skip
    """Return the start of the maps as HTML, with what `_static/posture-map.js` needs to know."""
    shown = ("run", "caption", "axes", "rows", "columns")
    words = {
        "name": name,
        "maps": controls.as_json([{key: one[key] for key in shown} for one in maps]),
        "dt": str(DT),
        "alt": f"The {view.thing} in 3D, in the chosen posture.",
        "orbit": camera.orbit,
        "target": camera.target,
        "model": files.model,
        "viewer": files.viewer,
    }
    data = " ".join(f'data-{key}="{escape(text)}"' for key, text in words.items())
    return f'<div class="posture-map" {data}>'


def panel(maps: Sequence[Mapping[str, Any]], weight: int, thing: str) -> str:
    """Return the controls and the end of the maps as HTML; the script fills and shows them."""
    which = controls.options({str(k): m["caption"].split(".")[0] for k, m in enumerate(maps)}, "0")
    measures = maps[0]["measures"]
    shown = controls.options({name: name for name in measures}, measures[0])
    return (
        f'<div class="panel" hidden><p role="status">Show in 3D loads the {escape(thing)}: '
        f'{weight} kB.</p><div class="controls">'
        f'<label{" hidden" * (len(maps) == 1)}>Map <select name="map">{which}</select></label>'
        f'<label>Cells show <select name="measure">{shown}</select></label></div>'
        '<div class="map-of-postures"></div><output aria-live="polite"></output><dl></dl></div>'
        "</div>"
    )


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("posture-map", PostureMapDirective)
