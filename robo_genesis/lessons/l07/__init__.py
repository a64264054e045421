"""L07: a scene that can be tested."""
