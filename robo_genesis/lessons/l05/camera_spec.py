"""Bounds of L05's checks of cameras; they judge and decide no measured value."""

from typing import Any

SAME_MATRIX = 1e-9
"""Largest difference of two camera matrices, both in float64 [pixel]."""

SAME_POSE = 2e-6
"""Largest difference of a pose computed in float64 to the engine's float32 [m or 1]."""

FEWEST_PIXELS = 200
"""A surface with fewer pixels is not judged by its picture."""

CENTROID = 0.15
"""Largest distance of a centroid from the centre of the computed silhouette [pixel].

A mask has whole pixels. At random places, the centroid of a disc of 200 pixels is up to 0.14 pixels
from the centre of the disc.
"""

MESH_SHARE = 0.006
"""Largest distance of a point from a sphere's surface, as a share of the radius.

The engine draws a sphere as 1280 triangles, whose centres are 0.45 % nearer to its middle.
"""

PLANE = 1e-4
"""Largest distance of a point from a plane that is nearer than `PLANE_FAR` [m]."""

PLANE_FAR = 3.0
"""Depth up to which the bound of a plane holds [m]."""

VIEW = {"pos": (1.5, -1.1, 1.0), "lookat": (0.4, 0.0, 0.3), "up": (0.0, 0.0, 1.0)}
"""Pose of the camera beside the robot [m]."""

FOV = {"world": 42.0, "cut": 42.0, "hand": 60.0}
"""Vertical field of view of each recorded view [degree]: the scene before the run; the scene after
it, with narrow limits; and what the camera on the hand sees after it."""

PICTURES = {
    "world": {
        "alt": "Camera frame of the robot at its start, with an orange ball beside it.",
        "caption": "Depth and point are those of the recorded arrays, in the pixel's centre.",
    },
    "cut": {
        "alt": "Camera frame of the robot. The floor exists only in a band. The hand and the wrist "
        "are cut open, so that the orange marker behind them is visible.",
        "caption": "Surfaces nearer than the near limit or farther than the far one are missing. "
        "The hand is cut open, and the marker behind it is visible.",
    },
}
"""Alternative text and caption of the pictures that a reader can read."""

CUT = (1.65, 2.2)
"""Near and far limit of the view `cut` [m]: one is inside the hand, the other on the floor."""

MARKER, MARKER_RADIUS = (0.3, 0.22, 0.2), 0.05
"""Centre and radius of a fixed sphere without collisions [m]."""

ON_HAND = (
    (0.0, -1.0, 0.0, 0.05),
    (-1.0, 0.0, 0.0, 0.0),
    (0.0, 0.0, -1.0, 0.0),
    (0.0, 0.0, 0.0, 1.0),
)
"""The camera in the frame of the hand, z backwards: it looks along the fingers [m]."""


def parameters() -> dict[str, Any]:
    """Return every configured input of the cameras as JSON values, for the evidence key."""
    names = ("VIEW", "FOV", "CUT", "MARKER", "MARKER_RADIUS", "ON_HAND")
    return {"cameras": {name: globals()[name] for name in names}}
