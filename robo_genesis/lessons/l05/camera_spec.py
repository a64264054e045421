"""Bounds of L05's checks of cameras; they judge and decide no measured value."""

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
