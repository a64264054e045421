"""Settings of the page about cameras: its views, their limits, and the marker. Data only."""

from typing import Any

VIEW = {"pos": (1.5, -1.1, 1.0), "lookat": (0.4, 0.0, 0.3), "up": (0.0, 0.0, 1.0)}
"""Pose of the camera beside the robot [m]."""

FOV = {"world": 42.0, "cut": 42.0, "hand": 60.0}
"""Vertical field of view of each recorded view [degree]: the scene before the run; the scene after
it, with narrow limits; and what the camera on the hand sees after it."""

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
