"""The names that figure cells of L03 use, from the bundle of their page."""

from pathlib import Path
from typing import Any

from robo_genesis.evidence import bundle
from robo_genesis.evidence.trace_files import read_any_trace
from robo_genesis.lessons.l03 import LAB, LECTURE, spec


def names(folder: Path) -> dict[str, Any]:
    arrays = bundle.read_arrays(folder)
    traces = {case: read_any_trace(folder, arrays, case) for case in arrays.cases}
    found = {"traces": traces, "case": spec.BASELINE, "trace": traces["baseline"]}
    if folder.parent.name == "lab":
        return found | {
            "slid": LAB.metrics({name: traces[name] for name in spec.SLIDES}),
            "bounced": LAB.metrics({name: traces[name] for name in spec.BOUNCES}),
        }
    return found | {"metrics": LECTURE.metrics(traces)}
