"""Cameras: frames, views, geometry, and checks of both."""
