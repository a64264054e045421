"""L03: rigid-body physics and stable simulation."""
