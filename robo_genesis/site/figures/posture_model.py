"""The model of recorded answers: a robot with a cross at the target of the answer that is shown."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.core.trace import Trace
from robo_genesis.sim.visual_shape import WORLD, Part, load_shape

if TYPE_CHECKING:
    from robo_genesis.site.replay.scenery import Camera  # loads slowly

CROSS, CROSS_LENGTH, CROSS_RADIUS = "target", 0.3, 0.006
"""Name of the cross at the target, which moves like a link, length and radius of its rods [m]. They
are longer than the hand, which hides the target when it is there."""


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


def glb(
    shape: Path,
    links: Sequence[str],
    traces: Mapping[str, Trace],
    camera: "Camera",
    credit: str | None,
) -> bytes:
    """Return the model of all answers, one animation a map, with the cross and a floor.

    Args:
        shape: file of the robot's shape.
        links: of the record, without the cross.
        traces: with the cross, by map.
        camera: of the model.
        credit: copyright of the shape, None where it needs no notice.
    """
    import trimesh  # these load slowly

    from robo_genesis.site.replay import model
    from robo_genesis.site.replay.scenery import AXIS_RGB, Scenery, floor_of

    parts = [part for part in load_shape(shape) if part.link != WORLD]
    half = CROSS_LENGTH / 2 * np.eye(3)
    rods = [trimesh.creation.cylinder(CROSS_RADIUS, segment=[-end, end]) for end in half]
    cross = [Part(CROSS, AXIS_RGB, rod.vertices, rod.faces) for rod in rods]
    scenery = Scenery([*parts, *cross, *floor_of(parts)], camera)
    return model.glb(scenery, [*links, CROSS], traces, credit)
