"""Lessons on robot simulation with Genesis: experiments, metrics and their evidence.

Importing the package or any of its modules does not import the engine. Only modules of `sim` import
it, inside functions.
"""
