"""The names that figure cells of L03 use, from the bundle of their page."""

from pathlib import Path
from typing import Any

from robo_genesis.evidence import bundle
from robo_genesis.evidence.trace_files import read_contact_trace
from robo_genesis.lessons.l03 import spec, study
from robo_genesis.lessons.l03.metrics import measure


def names(folder: Path) -> dict[str, Any]:
    arrays, numbers = bundle.read_arrays(folder), bundle.read_metrics(folder)
    traces = {case: read_contact_trace(folder, arrays, case) for case in arrays.cases}
    found = {"traces": traces, "case": spec.BASELINE, "trace": traces["baseline"]}
    if folder.parent.name == "lab":
        return found | {
            "slid": measure(traces, spec.SLIDES),
            "bounced": measure(traces, spec.BOUNCES),
        }
    seconds = {name: metric.value for name, metric in numbers["time_constant"].items()}
    return found | {"studies": study.Studies(traces, measure(traces, spec.STUDY_CASES), seconds)}
