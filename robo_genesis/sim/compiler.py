"""What a page changes about the engine's compiler: quicker searches, and kernels saved early."""

import inspect
import sys
from contextlib import suppress

MEASURES = False


def spare_searches() -> None:
    """Spare the engine's compiler a search of all loaded modules for each kernel that it declares.

    The compiler asks `inspect` for the line of source that calls each declaration. At the top level
    of a module the caller is Python's own import, which belongs to no file. `inspect` keeps what it
    finds, but not that it found nothing, so it would search all 3000 modules every time. The
    entry names no module either: the answer stays the same.
    """
    inspect.modulesbyfile["<frozen importlib._bootstrap>"] = ""


def save_kernels(*_: object) -> None:
    """Save the kernels that were compiled so far: a process that starts now need not compile them.

    The engine saves them only when it ends. IPython calls this after each cell.
    """
    with suppress(KeyError, AttributeError):  # no engine yet, or one with another interface
        sys.modules["quadrants"].lang.impl.pyquadrants._prog.dump_cache_data_to_disk()
