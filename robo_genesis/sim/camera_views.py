"""What one camera sees and where it is: pictures, depth, segmentation, camera matrix and pose.

The functions that read the engine are the only ones that depend on its version.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from robo_genesis.core.scene import FloatArray
from robo_genesis.sim.joints import to_numpy


class ViewError(ValueError):
    """Readings of a camera do not form one view."""


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
    | `shown` | | by number, the engine's indices of entity, link and geom |

    Raises:
        ViewError: a shape is wrong, or the transform is not that of a rigid body.
    """

    intrinsics: FloatArray
    transform: FloatArray
    size: tuple[int, int]
    limits: tuple[float, float]
    rgb: np.ndarray | None = None
    depth: FloatArray | None = None
    segmentation: np.ndarray | None = None
    shown: Mapping[int, tuple[int, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        width, height = self.size
        shapes: dict[str, tuple[int, ...]] = {"intrinsics": (3, 3), "transform": (4, 4)}
        pictures = {"rgb": (height, width, 3), "depth": (height, width)}
        pictures["segmentation"] = height, width
        shapes |= {name: of for name, of in pictures.items() if getattr(self, name) is not None}
        for name, shape in shapes.items():
            array = np.array(getattr(self, name))
            if array.shape != shape:
                raise ViewError(
                    f"{name} has shape {array.shape}, expected {shape}. A camera with "
                    f"res=({width}, {height}) has {height} rows and {width} columns."
                )
            array.setflags(write=False)
            object.__setattr__(self, name, array)
        turn = self.transform[:3, :3].astype(float)
        if not np.allclose(turn @ turn.T, np.eye(3), atol=1e-5) or np.linalg.det(turn) < 0:
            raise ViewError(
                f"The axes in transform are {turn.round(4).tolist()}, expected three orthogonal "
                "unit vectors in a right-handed order. Read the camera's transform again."
            )


def look(camera: Any, scene: Any, render: bool = True) -> View:
    """Return what a camera sees in the present state, and its pose at this moment.

    A camera on a link must be placed first, with `place_on_link`. Depth is rendered without
    colours: with them, the engine takes it from one sample of a multisampled picture, which is not
    at the centre of the pixel. Rendering is forced, because the engine otherwise draws nothing new
    before the next step, not even after a position was assigned.

    Args:
        camera: of a built scene.
        scene: the scene, for the meaning of the numbers in the segmentation.
        render: whether to take pictures.

    Raises:
        ViewError: the camera returned pictures of another shape than its resolution.
    """
    pictures: dict[str, Any] = {}
    if render:
        first = camera.render(rgb=False, depth=True, segmentation=True, force_render=True)
        _, depth, segmentation, _ = first
        pictures = {
            "rgb": to_numpy(camera.render(force_render=True)[0]),
            "depth": to_numpy(depth),
            "segmentation": to_numpy(segmentation).astype(np.int32),
            "shown": read_segments(scene),
        }
    return View(
        intrinsics=read_intrinsics(camera),
        transform=read_transform(camera),
        size=(int(camera.res[0]), int(camera.res[1])),
        limits=(float(camera.near), float(camera.far)),
        **pictures,
    )


def read_intrinsics(camera: Any) -> FloatArray:
    """Return the camera matrix (3, 3) [pixel]."""
    return to_numpy(camera.intrinsics).astype(np.float64)


def read_transform(camera: Any) -> FloatArray:
    """Return the pose (4, 4) of a camera in the world, with z backwards [m].

    It is computed at each call; older versions of Genesis keep the first value of
    `camera.extrinsics`.
    """
    return to_numpy(camera.transform).astype(np.float64)


def read_segments(scene: Any) -> dict[int, tuple[int, ...]]:
    """Return by number in a segmentation the indices of entity, link and geom, without background.

    There are as many indices as the scene's `segmentation_level` names: 1, 2 or 3.
    """
    keys = dict(scene.segmentation_idx_dict)
    return {
        int(number): tuple(map(int, key)) if isinstance(key, tuple) else (int(key),)
        for number, key in keys.items()
        if key != -1
    }


def segment_number(scene: Any, link: Any) -> int:
    """Return the number of a link in the segmentations of a scene, whose level is the link.

    Raises:
        ViewError: no segment is this link's; the message has those that exist.
    """
    segments = read_segments(scene)
    found = [number for number, key in segments.items() if key == (link.entity.idx, link.idx)]
    if len(found) != 1:
        raise ViewError(
            f"No single segment is that of entity {link.entity.idx}, link {link.idx}. The scene "
            f"has {sorted(segments.values())}. Leave the scene's segmentation_level at 'link'."
        )
    return found[0]


def read_link_pose(link: Any) -> tuple[FloatArray, FloatArray]:
    """Return position (3,) [m] and orientation (4,), (w, x, y, z), of a link in the world."""
    return to_numpy(link.get_pos()).reshape(3), to_numpy(link.get_quat()).reshape(4)


def place_on_link(camera: Any, link: Any, offset: FloatArray) -> None:
    """Attach a camera to a link and move it there. Repeat it after the link has moved.

    Args:
        camera: of a built scene.
        link: of a rigid entity.
        offset: (4, 4) the camera in the frame of the link, z backwards [m].
    """
    camera.attach(link, np.array(offset, dtype=np.float64))
    camera.move_to_attach()
