"""What a page shows is what its run put out: its outputs are compared with its bundle.

Three rules, from the strongest:

1. Each `page.show(function, ...)` leaves one output whose metadata name the function.
   The same function, called on the experiment of the bundle with the accepted metrics,
   must give the same output.
2. A number that a cell prints, and names with the option `prints`, is that value of the
   bundle; see `values`.
3. Every output, also of these two kinds, is the one in the bundle's `printed.json`:
   text as it is, the digest of anything else. The build writes this file when the run
   ends, so a notebook that was run by hand has none.
"""

import json
from dataclasses import replace
from itertools import zip_longest
from pathlib import Path
from typing import Any

from nbformat import NotebookNode

from robo_genesis.core import shown
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.files import json_digest
from robo_genesis.core.project import without_folders
from robo_genesis.core.text import quoted
from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import MANIFEST, write_json
from robo_genesis.evidence.reader import from_bundle
from robo_genesis.evidence.refusals import BundleRefused

from . import values
from .book import Page, code_cells

AGAIN = "The page was edited, or the environment moved: `make clean book` executes the page again."
TEXTS = ("text/plain", "text/markdown")
BOUNDARY = 60  # Characters that a message shows on both sides of a difference


def outputs_of(executed: NotebookNode) -> list[list[Any]]:
    """Return the outputs of each code cell in the form in which a bundle keeps them."""
    return [
        [_record(output) for output in cell.get("outputs", [])]
        for cell in code_cells(executed)
    ]


def _record(output: NotebookNode) -> dict[str, Any]:
    record = dict(output)
    if "data" in output:
        record["data"] = {
            kind: content if kind.endswith(TEXTS) else json_digest(content)
            for kind, content in output.data.items()
        }
    # IPython itself writes a home folder as `~` in the frames of an error.
    text = json.dumps(record, ensure_ascii=False).replace("~/", f"{Path.home()}/")
    return json.loads(without_folders(text))


def keep_outputs(folder: Path, executed: NotebookNode) -> None:
    """Add the outputs of a run to its bundle and to the list of files in the manifest."""
    write_json(folder / bundle.PRINTED, outputs_of(executed))
    manifest = json.loads((folder / MANIFEST).read_text("utf8"))
    digest = bundle.sha256(folder / bundle.PRINTED)
    manifest["files"] = manifest.get("files", {}) | {bundle.PRINTED: digest}
    write_json(folder / MANIFEST, manifest)


def require_shown(page: Page, executed: NotebookNode, folder: Path) -> int:
    """Require that all outputs of an executed page are those of its bundle.

    Args:
        page: the page as it is now.
        executed: its code cells with outputs.
        folder: its bundle, which was accepted.

    Returns:
        The number of outputs that were computed again.

    Raises:
        BundleRefused: `shown`, naming page, cell and output.
    """
    experiment, compared = None, 0
    cells = zip(
        values.prints(page.notebook),
        code_cells(executed),
        strict=True,
    )
    for number, (printed, cell) in enumerate(cells, start=1):
        place = f"{page.docname}, code cell {number}"
        for output in shown_outputs(cell):
            experiment = experiment or accepted_experiment(folder)
            _compare(place, output, experiment)
            compared += 1
        if printed and (reason := values.contradiction(printed, cell, folder)):
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
    outputs, recorded = outputs_of(executed), bundle.read_printed(folder)
    for cell, pair in enumerate(zip_longest(outputs, recorded, fillvalue=()), start=1):
        for number, (here, there) in enumerate(zip_longest(*pair), start=1):
            if here != there:
                raise BundleRefused(
                    "shown",
                    f"{docname}, code cell {cell}, output {number}: the page shows another than "
                    f"the bundle: {_difference(str(here), str(there))}. {AGAIN}",
                )


def accepted_experiment(folder: Path) -> Experiment:
    """Return the experiment of an accepted bundle, with the metrics that were accepted.

    Metrics that another machine computes again may differ in the last digit.
    """
    recorded = bundle.read_metrics(folder)
    run = from_bundle(folder, bundle.read_manifest(folder), recorded)
    metrics = {
        case: type(computed)(
            **{name: recorded[case][name].value for name in computed.about("unit")}
        )
        for case, computed in run.metrics.items()
    }
    return replace(run, accepted=metrics)


def shown_outputs(cell: NotebookNode) -> list[NotebookNode]:
    """Return the outputs of an executed cell whose metadata name a function."""
    return [
        output
        for output in cell.get("outputs", [])
        if shown.METADATA in output.get("metadata", {})
    ]


def _compare(place: str, output: NotebookNode, experiment: Experiment) -> None:
    """Raise BundleRefused unless an output is what its function gives for the bundle."""
    call = output.metadata[shown.METADATA]
    place = f"{place}, {call['function']}"
    try:
        valid = shown.mime_data(call["function"], experiment, call["arguments"])
    except (LookupError, ValueError, ArithmeticError, TypeError) as error:
        raise BundleRefused(
            "shown", f"{place}: it cannot be called on the bundle: {error!r} {AGAIN}"
        ) from error
    data = output.get("data", {})
    for kind in sorted({*data, *valid}):
        if data.get(kind) != valid.get(kind):
            difference = _difference(str(data.get(kind)), str(valid.get(kind)))
            raise BundleRefused(
                "shown",
                f"{place}: the page shows another {kind} than the bundle: {difference}. {AGAIN}",
            )


def _difference(found: str, valid: str) -> str:
    """Return the place where two texts differ first, from both of them."""
    pairs = enumerate(zip(found, valid, strict=False))
    start = next((k for k, (a, b) in pairs if a != b), min(len(found), len(valid)))
    part = slice(max(0, start - BOUNDARY), start + BOUNDARY)
    return f"found {quoted(found[part])}, expected {quoted(valid[part])}"
