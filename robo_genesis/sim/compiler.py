"""Work that the engine repeats, and that a process can be spared."""

import gc
import inspect
import sys
import textwrap
import traceback
from contextlib import suppress
from functools import lru_cache
from types import CodeType, FunctionType
from typing import Any

import numpy as np

IMPORT = (
    "<frozen importlib._bootstrap>"  # What Python names as the file of its own import
)

# New objects after which Python looks for unused ones; by default 700 or 2000
OBJECTS = 20_000

FRAMES = (
    10  # Calls written down; the engine drops its own. A cell of a notebook has 50 more
)


def spare_repeated_work() -> None:
    """Keep the answers that the engine requests repeatedly from Python's library and trimesh.

    - For each kernel the compiler asks `inspect` for the line of source that calls the
      declaration. At the top level of a module the caller is Python's own import, in no
      file. `inspect` keeps what it finds, but not that it found nothing, so it would
      search all 3000 modules every time. The entry names no module either.
    - For each expression it wraps the line of source for the message of a possible
      error, and it does so again in each pass and in each unrolled loop.
    - For each call of a function inside a kernel it splits that function's source into
        tokens.
    - For each array it writes down all calls that led there, for the message of a
      possible error, and some of its warnings name them. Here these are at most the
      last `FRAMES`.
    - In each scene, for every two shapes of a robot whose boxes overlap, the engine
      covers both surfaces with small cubes.

    An answer is that for the same line and settings, for the same function with the
    same code, or for a surface with the same numbers. Python looks for unused objects
    after each `OBJECTS` new ones: a kernel has many, and all of them are used. All this
    lasts as long as the process.
    """
    if IMPORT in inspect.modulesbyfile:
        return
    if 0 < gc.get_threshold()[0] < OBJECTS:  # 0: never
        gc.set_threshold(OBJECTS)
    with suppress(ImportError):  # the engine, which needs trimesh, says it better
        _keep_covered_surfaces()
    inspect.modulesbyfile[IMPORT] = ""
    wrap, lines = textwrap.TextWrapper.wrap, inspect.getsourcelines
    stack = traceback.extract_stack

    @lru_cache(2**16)
    def wrapped(text: str, settings: tuple[tuple[str, Any], ...]) -> list[str]:
        wrapper = textwrap.TextWrapper()
        vars(wrapper).update(settings)
        return wrap(wrapper, text)

    @lru_cache(2**12)
    def found(function: FunctionType, code: CodeType) -> tuple[list[str], int]:
        return lines(function)

    def wrap_once(self: textwrap.TextWrapper, text: str) -> list[str]:
        if type(self) is not textwrap.TextWrapper:
            return wrap(self, text)
        return wrapped(text, tuple(vars(self).items())).copy()

    def find_once(object: Any) -> tuple[list[str], int]:
        if not isinstance(object, FunctionType):
            return lines(object)
        source, number = found(object, object.__code__)
        return source.copy(), number

    def last_calls(f: Any = None, limit: int | None = None) -> traceback.StackSummary:
        f = f or sys._getframe(1)
        engine = f.f_globals.get("__name__") == "quadrants.lang.util"
        return stack(f, FRAMES if engine and limit is None else limit)

    textwrap.TextWrapper.wrap = wrap_once  # type: ignore[method-assign]
    inspect.getsourcelines = find_once
    traceback.extract_stack = last_calls


def _keep_covered_surfaces() -> None:
    from trimesh import Trimesh

    voxelized = Trimesh.voxelized

    @lru_cache(2**8)
    def covered(vertices: bytes, faces: bytes, pitch: float) -> Any:
        points, corners = np.frombuffer(vertices), np.frombuffer(faces, np.int64)
        mesh = Trimesh(points.reshape(-1, 3), corners.reshape(-1, 3), process=False)
        return voxelized(mesh, pitch)

    def cover_once(self: Any, pitch: Any, *how: Any, **settings: Any) -> Any:
        if how or settings or type(self) is not Trimesh or not isinstance(pitch, float):
            return voxelized(self, pitch, *how, **settings)
        return covered(self.vertices.tobytes(), self.faces.tobytes(), pitch).copy()

    Trimesh.voxelized = cover_once  # type: ignore[method-assign]
