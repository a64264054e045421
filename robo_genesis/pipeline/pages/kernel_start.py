"""What each kernel of a build executes first, in a namespace of its own.

The last three parts only save time: the engine asks the same questions for each kernel,
each expression and each pair of shapes. A page that is executed elsewhere does without
them.
"""

import atexit
import ctypes
import inspect
import os
import sys
import textwrap
from functools import lru_cache
from typing import Any

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


class KeepVoxels:
    """Finds no module; before the engine is imported, it lets meshes keep their voxels.

    For each pair of a robot's shapes that may overlap the engine fills both.
    """

    @staticmethod
    def find_spec(name: str, *_: Any) -> None:
        """Change the class of meshes when the engine is looked for."""
        if name != "genesis":
            return
        sys.meta_path = [one for one in sys.meta_path if one is not KeepVoxels]
        from trimesh import Trimesh

        voxelized, kept = Trimesh.voxelized, {}

        def voxelized_once(mesh: Trimesh, *given: Any, **named: Any) -> Any:
            shape = mesh.vertices.tobytes(), mesh.faces.tobytes()
            key = *shape, given, *named.items()
            if key not in kept:
                kept[key] = voxelized(mesh, *given, **named)
            return kept[key]

        Trimesh.voxelized = voxelized_once  # type: ignore[assignment, method-assign]


sys.meta_path.insert(0, KeepVoxels)
