"""What each kernel of a build executes first, in a namespace of its own.

The last three parts only save time: the engine asks the same questions for each kernel,
each expression and each pair of shapes. A page that is executed elsewhere does without
them.
"""

import atexit
import ctypes
import inspect
import os
import textwrap
from functools import lru_cache
from typing import Any

import trimesh

# Linux kills the kernel when the thread that started it ends, also by SIGKILL (1 is
# PR_SET_PDEATHSIG of <linux/prctl.h>, 9 SIGKILL).
ctypes.CDLL(None).prctl(1, 9)

# Runs after the engine's exit handler, and before ipykernel's, which hangs in about one
# of ten.
atexit.register(os._exit, 0)

# The module of Python's own import, in no file: `inspect` would search all 3000 modules
# for it whenever a module declares a function of the engine.
inspect.modulesbyfile["<frozen importlib._bootstrap>"] = ""

# For each expression the compiler wraps the line of source that a message would show.
wrap = textwrap.TextWrapper.wrap


@lru_cache(2**16)
def wrapped(settings: tuple[tuple[str, Any], ...], text: str) -> list[str]:
    """Return the lines of a text that a plain wrapper with these settings makes."""
    wrapper = textwrap.TextWrapper()
    vars(wrapper).update(settings)
    return wrap(wrapper, text)


def wrap_once(self: textwrap.TextWrapper, text: str) -> list[str]:
    """Return the lines of a text; a wrapper of another class is left alone."""
    if type(self) is textwrap.TextWrapper:
        return wrapped(tuple(vars(self).items()), text).copy()
    return wrap(self, text)


textwrap.TextWrapper.wrap = wrap_once  # type: ignore[method-assign]

# For each pair of a robot's shapes that may overlap, the engine fills both with voxels.
voxelized = trimesh.Trimesh.voxelized
filled: dict[tuple[Any, ...], trimesh.voxel.VoxelGrid] = {}


def voxelized_once(
    mesh: trimesh.Trimesh, pitch: float, **options: Any
) -> trimesh.voxel.VoxelGrid:
    """Return the voxels of a mesh; the engine does not change them."""
    key = (mesh.vertices.tobytes(), mesh.faces.tobytes(), pitch, *options.items())
    if key not in filled:
        filled[key] = voxelized(mesh, pitch, **options)
    return filled[key]


trimesh.Trimesh.voxelized = voxelized_once
