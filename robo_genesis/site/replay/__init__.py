"""Recorded runs that play in a page."""
