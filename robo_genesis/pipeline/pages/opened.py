"""The start of a kernel, which notes the files that its page reads; the worker judges them."""

import atexit
import os
import re
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from robo_genesis.core.project import CACHE, CACHE_FOLDERS, OUTPUTS_DIR, PACKAGES, ROOT
from robo_genesis.sim.compiler import spare_repeated_work
from robo_genesis.sim.mujoco.files import note_models

# Folders of the operating system.
SYSTEM = (
    "/bin",
    "/dev",
    "/etc",
    "/lib",
    "/lib64",
    "/opt",
    "/proc",
    "/run",
    "/sys",
    "/usr",
    "/var",
)

# Matplotlib lists all fonts of the machine; the figures use its own.
FONTS = (".ttf", ".otf", ".ttc", ".afm")

# The end of the name of a robot's model or mesh.
MODEL = re.compile(
    r"\.(xml|mjcf|urdf|xacro|mjb|obj|mtl|stl|dae|glb|gltf|ply|msh|usd\w?)$", re.I
)

RUNTIME = "JUPYTER_RUNTIME_DIR"
BYTECODE = re.compile(r"__pycache__/([^/.]+)\.[^/]+\.pyc$")
OWN = os.O_TRUNC | os.O_EXCL  # The flags of a file that the process makes or empties


def start() -> None:
    """Prepare a kernel, and note from now on each file that its Python opens for reading.

    What the process itself made or emptied is not noted. What compiled code or a child
    process opens is not seen, except the models that MuJoCo reads, also for the engine.
    """
    # ipykernel 7 hangs for ever, or 10 s, in about one of ten of its own exit handlers.
    # They run last: one that is registered right after them runs right before them,
    # after the engine's, and ends it.
    atexit.register(os._exit, 0)
    spare_repeated_work()  # here, because pages import the engine before the course
    notes, seen = os.open(_notes(), os.O_WRONLY | os.O_CREAT), set()

    def note(event: str, arguments: tuple[Any, ...]) -> None:
        if event != "open" or isinstance(arguments[0], int):
            return
        path, flags = os.path.abspath(os.fsdecode(arguments[0])), arguments[2]
        if path not in seen and (flags & OWN or flags & os.O_ACCMODE != os.O_WRONLY):
            seen.add(path)
            os.write(notes, b"" if flags & OWN else os.fsencode(path) + b"\0")

    note_models(
        lambda path: note("open", (path, None, os.O_RDONLY)),
        Path(os.environ[RUNTIME], "model.xml"),
    )
    sys.addaudithook(note)


def _notes() -> Path:
    """Return the file that gets the paths, each with a NUL at its end."""
    return Path(os.environ[RUNTIME], "opened")


def unkeyed_files(keyed: Iterable[Path]) -> list[str]:
    """Return the noted files on which no key depends, and which the page did not make itself.

    The innermost known folder of a file decides: files of the system, of Python, of
        packages and of
    the engine's caches are accepted, others in the checkout or at home are not, nor are
    models of robots in folders of the system.

    Args:
        keyed: the files of the checkout that the page's fingerprint covers.
    """
    accepted = [*SYSTEM, sys.prefix, PACKAGES, sys.base_prefix, str(CACHE / "derived")]
    accepted += map(
        str, ROOT.glob("*.egg-info")
    )  # which lists the package for importlib.metadata
    accepted += filter(
        None, map(os.environ.get, (RUNTIME, OUTPUTS_DIR, *CACHE_FOLDERS))
    )
    places = {
        form: True for each in accepted for form in (each, os.path.realpath(each))
    }
    places |= {"": False, str(ROOT): False, str(Path.home()): False}
    system = {*SYSTEM, *map(os.path.realpath, SYSTEM)}

    def is_accepted(path: str) -> bool:
        place = max((each for each in places if path.startswith(f"{each}/")), key=len)
        return places[place] and not (place in system and MODEL.search(path))

    names = os.fsdecode(_notes().read_bytes()).split("\0")
    found = {BYTECODE.sub(r"\1.py", name) for name in names if not name.endswith(FONTS)}
    found -= set(map(str, keyed))
    return sorted(
        name for name in found if os.path.isfile(name) and not is_accepted(name)
    )
