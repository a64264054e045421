"""The files that MuJoCo reads, also for Genesis: compiled code opens them, so Python sees none."""

from collections.abc import Callable
from contextlib import suppress
from os.path import dirname, join, relpath
from pathlib import Path
from typing import Any

MEASURES = False


def note_models(note: Callable[[str], None], text: Path) -> None:
    """Call `note` with the path of each file of a model before MuJoCo reads it, from now on.

    Args:
        note: takes the model, what it includes, its meshes and textures.
        text: gets a model that is given as text, not by its file.
    """
    import mujoco

    def noting(load: Callable[..., Any], from_text: bool) -> Any:
        def noted(*given: Any, **named: Any) -> Any:
            model = next(iter((*given, *named.values())))
            if from_text:
                text.write_bytes(model if isinstance(model, bytes) else model.encode())
            file = str(text if from_text else model)
            with suppress(mujoco.FatalError):  # which the loader reports
                paths, top = mujoco.mju_getXMLDependencies(file), dirname(file)
                # Names in an included file are relative to that file, but listed below
                # the first.
                for folder in {
                    top,
                    *(dirname(path) for path in paths if path.endswith(".xml")),
                }:
                    for path in paths:
                        note(join(folder, relpath(path, top or ".")))
            return load(*given, **named)

        return staticmethod(noted)

    for kind, names in (
        (mujoco.MjModel, ("from_xml_path", "from_xml_string")),
        (mujoco.MjSpec, ("from_file", "from_string")),
    ):
        for name in names:
            setattr(kind, name, noting(getattr(kind, name), name.endswith("string")))
