"""Views of the page about cameras beside the lesson's: with narrow limits, and on the hand."""

from typing import Any

from robo_genesis.lessons.l05 import spec

CUT = (1.65, 2.2)
"""Near and far limit of the view `cut` [m]: one is inside the hand, the other on the floor."""

HAND_FOV = 60.0
"""Vertical field of view of the camera on the hand [degree]."""

ON_HAND = (
    (0.0, -1.0, 0.0, 0.05),
    (-1.0, 0.0, 0.0, 0.0),
    (0.0, 0.0, -1.0, 0.0),
    (0.0, 0.0, 0.0, 1.0),
)
"""The camera in the frame of the hand, z backwards: it looks along the fingers [m]."""

VIEWS = (spec.VIEWED, "cut", "hand")
"""The recorded views: the first before the run, the others after it."""

PICTURES = {
    spec.VIEWED: {
        "alt": "Camera frame of the robot at its start. An orange ball is below its hand.",
        "caption": "Depth and point are those of the recorded arrays, in the pixel's centre.",
    },
    "cut": {
        "alt": "Camera frame of the robot. The floor exists only in a band. The hand and the wrist "
        "are cut open.",
        "caption": "Surfaces nearer than the near limit or farther than the far one are missing: "
        "the hand is cut open, and the floor is a band.",
    },
}
"""Alternative text and caption of the pictures that a reader can read."""


def parameters() -> dict[str, Any]:
    """Return every configured input of these views as JSON values, for the evidence key."""
    return {"cut": CUT, "hand_fov": HAND_FOV, "on_hand": ON_HAND}
