"""Bundles of this checkout: their keys, their verification, and the states that follow."""
