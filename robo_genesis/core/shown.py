"""Measured outputs of a page: named functions of the experiment, and their results as MIME data.

A page shows such an output with `page.show`. The build calls the same function on the
experiment that it reads from the page's bundle, and refuses a page with another result.
Any other output of a cell is only compared with the copy in the bundle.
"""

import io
from collections.abc import Callable, Sequence
from importlib import import_module
from inspect import isfunction
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # a build without new runs draws nothing
    from matplotlib.figure import Figure

# The modules that may hold such functions.
PLACES = ("robo_genesis.lessons.", "robo_genesis.core.")

# The key of an output's metadata; its value is {"function": name, "arguments": [...]}.
METADATA = "robo_genesis"

TEXT, DRAWING = "text/markdown", "image/svg+xml"


class ShownError(ValueError):
    """A page shows something that is not a named function of the experiment."""


def name_of(function: Any) -> str:
    """Return the name under which the build finds a function.

    Raises:
        ShownError: the build cannot find it.
    """
    if not isfunction(function):
        raise ShownError(
            f"page.show was given {function!r}. Give a function of a lesson and not its result: "
            "page.show(text.metric_table)."
        )
    name = f"{function.__module__}.{function.__qualname__}"
    find(name)
    return name


def find(name: str) -> Callable[..., Any]:
    """Return the function of a name.

    Raises:
        ShownError: it is not a function at the top level of a module of lessons or
            core.
    """
    place, _, last = name.rpartition(".")
    found = None
    if place.startswith(PLACES):
        try:
            found = vars(import_module(place)).get(last)
        except ImportError:
            found = None
    if not isfunction(found) or found.__module__ != place:
        raise ShownError(
            f"{name!r} cannot be shown. Valid are functions at the top level of a module below "
            f"{' or '.join(place.removesuffix('.') for place in PLACES)}. Move it there."
        )
    return found


def metadata(name: str, arguments: Sequence[Any]) -> dict[str, Any]:
    """Return the metadata of an output; the arguments are JSON values."""
    return {METADATA: {"function": name, "arguments": list(arguments)}}


def mime_data(name: str, experiment: Any, arguments: Sequence[Any]) -> dict[str, str]:
    """Call a function on an experiment and return its result as MIME data.

    A text is Markdown. A figure is drawn as SVG in the course's style; equal figures
    give equal bytes.

    Args:
        name: of the function.
        experiment: its first argument.
        arguments: its further arguments, JSON values.

    Raises:
        ShownError: the name is not valid, or the result is neither a text nor a figure.
    """
    from matplotlib.figure import Figure

    from . import plotting

    function = find(name)
    with plotting.course_style():
        result = function(experiment, *arguments)
        if isinstance(result, str):
            return {TEXT: result}
        if isinstance(result, Figure):
            return {DRAWING: svg(result)}
    raise ShownError(
        f"{name} returned {type(result).__name__}. Return Markdown, as `tables.markdown` does, or "
        "a Matplotlib Figure, as `plotting.stacked` does of frames."
    )


def svg(figure: "Figure") -> str:
    """Return a figure as SVG without a date: equal figures give equal text."""
    stream = io.StringIO()
    figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None})
    return stream.getvalue()
