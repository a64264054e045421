"""What one camera sees and where it is: pictures, depth, segmentation, camera matrix and pose.

The functions that read the engine are the only ones that depend on its version.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.arm.joints import to_numpy


@dataclass(frozen=True, slots=True)
class View:
    """One view of W columns and H rows. Pictures are None if they were not rendered.

    | field | shape | meaning |
    |---|---|---|
    | `intrinsics` | (3, 3) | camera matrix K [pixel] |
    | `transform` | (4, 4) | camera axes x right, y up, z backwards, in the world [m] |
    | `size` | (2,) | W and H, in the order of the engine's `res` |
    | `limits` | (2,) | near and far [m] |
    | `rgb` | (H, W, 3) | colours, uint8 |
    | `depth` | (H, W) | distance along the optical axis [m], float32 |
    | `segmentation` | (H, W) | number of what each pixel shows, 0 for the background, int32 |
    """

    intrinsics: FloatArray
    transform: FloatArray
    size: tuple[int, int]
    limits: tuple[float, float]
    rgb: np.ndarray | None = None
    depth: FloatArray | None = None
    segmentation: np.ndarray | None = None


def look(camera: Any, render: bool = True) -> View:
    """Return what a camera sees in the present state, and its pose at this moment.

    A forced picture moves a camera on a link to the link. Without pictures, move it
    there first, with `move_to_attach`. Depth is rendered without colours: with them,
    the engine takes it from one sample of a multisampled picture, which is not at the
    centre of the pixel. Rendering is forced, because the engine otherwise draws nothing
    new before the next step, not even after a position was assigned.

    Args:
        camera: of a built scene.
        render: whether to take pictures.
    """
    pictures: dict[str, Any] = {}
    if render:
        _, depth, segmentation, _ = camera.render(
            rgb=False, depth=True, segmentation=True, force_render=True
        )
        pictures = {
            "rgb": to_numpy(camera.render(force_render=True)[0]),
            "depth": to_numpy(depth),
            "segmentation": to_numpy(segmentation).astype(np.int32),
        }
    return View(
        intrinsics=to_numpy(camera.intrinsics).astype(np.float64),
        transform=read_transform(camera),
        size=(int(camera.res[0]), int(camera.res[1])),
        limits=(float(camera.near), float(camera.far)),
        **pictures,
    )


def read_transform(camera: Any) -> FloatArray:
    """Return the pose (4, 4) of a camera in the world, with z backwards [m].

    It is computed at each call; Genesis 1.3 keeps the first value of
    `camera.extrinsics`.
    """
    return to_numpy(camera.transform).astype(np.float64)


def segment_number(scene: Any, link: Any) -> int:
    """Return the number of a link in the segmentations of a scene, whose level is the link."""
    numbers = {key: number for number, key in scene.segmentation_idx_dict.items()}
    return int(numbers[link.entity.idx, link.idx])
