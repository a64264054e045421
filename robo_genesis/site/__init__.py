"""Sphinx extensions, and what is done to the pages that Sphinx has written."""
