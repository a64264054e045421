"""Lessons on robot simulation with Genesis: experiments, metrics and their evidence.

A page of a lesson writes `import robo_genesis as rg` and uses the names of `__all__`.
Importing the package or any of its modules does not import the engine. Only modules of
`sim` import it, inside functions. The names are loaded when they are first used.
"""

from typing import Any

__all__ = [
    "PLAIN_LOG",
    "PRECISION",
    "SEED",
    "backend",
    "curves",
    "model_file",
    "open_page",
    "table",
]


def __getattr__(name: str) -> Any:
    """Return a name of `__all__`."""
    if name not in __all__:
        raise AttributeError(
            f"robo_genesis has no {name!r}. Names: {', '.join(__all__)}."
        )
    from robo_genesis import page
    from robo_genesis.sim import session
    from robo_genesis.sim.arm.model import model_file

    if name in ("PLAIN_LOG", "model_file"):
        return model_file if name == "model_file" else session.plain_log()
    return getattr(session if name in ("PRECISION", "SEED") else page, name)
