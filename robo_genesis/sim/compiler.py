"""Work that the engine's compiler repeats, and that a process can be spared."""

import inspect
import textwrap
from functools import lru_cache
from types import CodeType, FunctionType
from typing import Any

IMPORT = "<frozen importlib._bootstrap>"
"""What Python names as the file of its own import."""


def spare_repeated_work() -> None:
    """Keep the answers that the compiler requests repeatedly from Python's library.

    - For each kernel it asks `inspect` for the line of source that calls the declaration. At the
      top level of a module the caller is Python's own import, which belongs to no file. `inspect`
      keeps what it finds, but not that it found nothing, so it would search all 3000 modules every
      time. The entry names no module either.
    - For each expression it wraps the line of source for the message of a possible error, and it
      does so again in each pass and in each unrolled loop.
    - For each call of a function inside a kernel it splits that function's source into tokens.

    An answer is that for the same line and settings, or for the same function with the same code.
    """
    if IMPORT in inspect.modulesbyfile:
        return
    inspect.modulesbyfile[IMPORT] = ""
    wrap, lines = textwrap.TextWrapper.wrap, inspect.getsourcelines

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

    textwrap.TextWrapper.wrap = wrap_once  # type: ignore[method-assign]
    inspect.getsourcelines = find_once
