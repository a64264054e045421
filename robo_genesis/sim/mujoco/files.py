"""The files that MuJoCo reads, also for Genesis: compiled code opens them, so Python sees none."""

from collections.abc import Callable
from contextlib import suppress
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
            with suppress(mujoco.FatalError):  # which the loader reports
                for path in mujoco.mju_getXMLDependencies(str(text if from_text else model)):
                    note(path)
            return load(*given, **named)

        return staticmethod(noted)

    for kind, names in (
        (mujoco.MjModel, ("from_xml_path", "from_xml_string")),
        (mujoco.MjSpec, ("from_file", "from_string")),
    ):
        for name in names:
            setattr(kind, name, noting(getattr(kind, name), name.endswith("string")))
