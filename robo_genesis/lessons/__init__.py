"""The lessons: one folder each, found by `registry`."""
