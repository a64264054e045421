"""The names that figure cells of L02 use, from the bundle of their page."""

from pathlib import Path
from typing import Any

from robo_genesis.evidence import bundle
from robo_genesis.evidence.trace_files import read_any_trace
from robo_genesis.lessons.l02 import LECTURE, spec, study


def names(folder: Path) -> dict[str, Any]:
    arrays = bundle.read_arrays(folder)
    traces = {case: read_any_trace(folder, arrays, case) for case in arrays.cases}
    cases = {
        name: case for name, case in (spec.CASES | spec.SUBSTEP_CASES).items() if name in traces
    }
    return {
        "traces": traces,
        "case": spec.BASELINE,
        "trace": traces["baseline"],
        "step_study": study.step_study(LECTURE.metrics(traces), cases),
    }
