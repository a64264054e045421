"""What a page shows is what its run put out: all of its outputs are compared with its bundle.

Three rules, from the strongest:

1. Each `page.show(function, ...)` leaves one output, and the metadata of the output
name the
   function. The same function, called on the experiment of the bundle with the accepted
   metrics, must give the same output.
2. A number that a cell prints, and names with the option `prints`, is that value of the
bundle. 3. Every output, also of these two kinds, is the one in the bundle's
`printed.json`. Nothing else
   confirms other outputs, and the site says below them that the run printed them.
"""

import ast
import re
from collections.abc import Mapping
from dataclasses import replace
from itertools import zip_longest
from pathlib import Path
from typing import Any

from nbformat import NotebookNode

from robo_genesis.core import shown
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import quoted
from robo_genesis.evidence.bundle import Manifest, read_metrics, read_printed
from robo_genesis.evidence.reader import from_bundle
from robo_genesis.evidence.refusals import BundleRefused, expect
from robo_genesis.pipeline.pages import printed
from robo_genesis.pipeline.pages.book import Page

# The calls that show a measured output; pages give this name to the result of
# `rg.open_page`.
SHOW, FINISH = "page.show", "page.finish"

AGAIN = "The page was edited, or the environment moved: `make clean book` executes the page again."
ONCE = "Call page.show once for each output, outside of loops and conditions."
BOUNDARY = 60  # Characters that a message shows on both sides of a difference

# Difference up to which coordinates count as equal [px]: other processors round
# differently.
NEAR = 0.1
# The coordinates of a drawing.
PLACE = re.compile(
    r'(?<=\s)(?:d|points|[xy][12]?|c[xy]|width|height|viewBox)="[^"]*"|translate\([^()]*\)'
)
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")

# A name in a drawing. Matplotlib makes some of them from coordinates.
NAME = re.compile(r'(\sid="|url\(#|href="#)([^")]*)')


# One call that shows an output: its `function`, the name, and its `arguments`, a list;
# so is the metadata of the output.
Shown = dict[str, Any]


def require_shown(
    page: Page, executed: NotebookNode, folder: Path, manifest: Manifest
) -> int:
    """Require that all outputs of an executed page are those of its bundle.

    Args:
        page: the page as it is now.
        executed: its code cells with outputs.
        folder: its bundle, which was accepted.
        manifest: of that bundle.

    Returns:
        The number of outputs that were computed again.

    Raises:
        BundleRefused: `shown`, naming page, cell and output.
    """
    experiment, compared = None, 0
    cells = (cell for cell in executed.cells if cell.cell_type == "code")
    expected = zip(calls_of(page), printed.declared(page.notebook), cells, strict=True)
    for number, (named, values, cell) in enumerate(expected, start=1):
        place, found = f"{page.docname}, code cell {number}", marked(cell)
        if len(found) != len(named):
            what = f"number of measured outputs is {len(found)}, expected {len(named)}"
            raise _refused(f"{place}: {what}. {ONCE}")
        for call, output in zip(named, found, strict=True):
            experiment = experiment or accepted_experiment(folder, manifest)
            _compare(place, call, output, experiment)
            compared += 1
        if values and (reason := printed.contradiction(values, cell, folder)):
            raise BundleRefused(
                "shown", f"{place}: {reason}. Correct the option or the cell."
            )
    require_printed(page.docname, executed, folder)
    return compared


def require_printed(docname: str, executed: NotebookNode, folder: Path) -> None:
    """Require that the outputs of an executed page are those that its bundle has kept.

    Raises:
        BundleRefused: `shown`, naming page, cell, output and place of the first
            difference; `missing-file` if the build did not write the bundle's last
            file.
    """
    found, kept = printed.outputs_of(executed), read_printed(folder)
    for cell, outputs in enumerate(zip_longest(found, kept, fillvalue=()), start=1):
        for number, (here, there) in enumerate(zip_longest(*outputs), start=1):
            if here != there:
                what = difference_of(str(here), str(there), False)
                raise _refused(
                    f"{docname}, code cell {cell}, output {number} of its run: {what}."
                )


def accepted_experiment(folder: Path, manifest: Manifest) -> Experiment:
    """Return the experiment of an accepted bundle, with the metrics that were accepted.

    Metrics that another machine computes again may differ in the last digit.
    """
    recorded = read_metrics(folder)
    run = from_bundle(folder, manifest, recorded)
    metrics = {
        case: type(found)(
            **{name: recorded[case][name].value for name in found.about("unit")}
        )
        for case, found in run.metrics.items()
    }
    return replace(run, accepted=metrics)


def calls_of(page: Page) -> list[list[ast.Call]]:
    """Return the calls of each code cell that show a measured output, in their order."""
    found = []
    for source in page.code.sources:
        try:
            nodes = [
                node
                for node in ast.walk(ast.parse(source))
                if isinstance(node, ast.Call)
            ]
        except SyntaxError:  # an expected error of the page
            nodes = []
        calls = (node for node in nodes if ast.unparse(node.func) in (SHOW, FINISH))
        found.append(sorted(calls, key=lambda node: (node.lineno, node.col_offset)))
    return found


def names(call: ast.Call, says: Shown) -> bool:
    """Return whether a call, as it is written, shows what the metadata of an output say."""
    if ast.unparse(call.func) == FINISH:
        return says == {"function": shown.CHECKS, "arguments": []}
    name, *arguments = map(ast.unparse, [*call.args, *call.keywords] or [call.func])
    written = {
        "function": says.get("function"),
        "arguments": [*map(ast.literal_eval, arguments)],
    }
    return written == says and f".{says['function']}".endswith(f".{name}")


def marked(cell: NotebookNode) -> list[NotebookNode]:
    """Return the outputs of an executed cell whose metadata name a function."""
    return [
        out
        for out in cell.get("outputs", [])
        if shown.METADATA in out.get("metadata", {})
    ]


def _compare(
    place: str, call: ast.Call, output: NotebookNode, experiment: Experiment
) -> None:
    """Raise BundleRefused unless an output is that of its call."""
    says = output.metadata[shown.METADATA]
    try:
        is_its = names(call, says)
    except (AttributeError, SyntaxError, TypeError, ValueError):
        is_its = False
    if not is_its:
        raise _refused(
            f"{place}: the output is of {quoted(says)}, expected that of `{ast.unparse(call)}`. "
            "Write arguments out, as text, numbers or lists by position."
        )
    place = f"{place}, {says['function']}"
    try:
        valid = shown.mime_data(says["function"], experiment, says["arguments"])
    except (
        shown.ShownError,
        LookupError,
        ValueError,
        ArithmeticError,
        TypeError,
    ) as error:
        raise _refused(
            f"{place}: it cannot be called on the bundle: {error!r}"
        ) from error
    data: Mapping[str, Any] = output.get("data", {})
    expect(
        "shown", place, "type of the output", output.output_type, "display_data", AGAIN
    )
    expect(
        "shown",
        place,
        "list of kinds of the output",
        sorted(data),
        sorted(valid),
        AGAIN,
    )
    for kind, text in valid.items():
        if difference := difference_of(str(data[kind]), text, kind == shown.DRAWING):
            raise _refused(
                f"{place}: the page shows another {kind} than the bundle: {difference}."
            )


def difference_of(found: str, valid: str, drawn: bool) -> str | None:
    """Return the first difference of two texts or two drawings, None if they count as equal.

    Drawings are equal if their texts are, except for the choice of names, and for
    coordinates that differ by less than `NEAR`. They are compared as texts: no parser
    reads what a page contains.

    Args:
        found: what a page shows.
        valid: what the bundle gives.
        drawn: whether both are drawings (SVG).
    """
    if found == valid:
        return None
    if drawn:
        found, at = _without_places(found)
        valid, expected = _without_places(valid)
        if found == valid and len(at) == len(expected):
            far = (
                pair
                for pair in zip(at, expected, strict=True)
                if abs(pair[0] - pair[1]) > NEAR
            )
            return next(
                (f"found the coordinate {a}, expected {b}" for a, b in far), None
            )
    pairs = enumerate(zip(found, valid, strict=False))
    start = next((k for k, (a, b) in pairs if a != b), min(len(found), len(valid)))
    part = slice(max(0, start - BOUNDARY), start + BOUNDARY)
    return f"found {quoted(found[part])}, expected {quoted(valid[part])}"


def _without_places(svg: str) -> tuple[str, list[float]]:
    """Return a drawing without coordinates, its names numbered by their first use; coordinates."""
    names: dict[str, int] = {}
    numbered = NAME.sub(lambda m: f"{m[1]}{names.setdefault(m[2], len(names))}", svg)
    places = [
        float(n) for place in PLACE.findall(numbered) for n in NUMBER.findall(place)
    ]
    return PLACE.sub(lambda m: NUMBER.sub("#", m[0]), numbered), places


def _refused(message: str) -> BundleRefused:
    return BundleRefused("shown", f"{message} {AGAIN}")
