"""The dropped boxes of a bundle as their page had them, from arrays, counts and frames."""

from pathlib import Path

from robo_genesis import drop_checks, l02, life_cycle
from robo_genesis.drop_metrics import measure, metric_records
from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import Manifest
from robo_genesis.evidence.recompute import Judged, read_counts, read_frames, read_readings
from robo_genesis.evidence.strict_json import expect
from robo_genesis.evidence.traces import read_body_trace
from robo_genesis.substep_study import run_checks as run_study_checks
from robo_genesis.trace import BodyTrace


def judge(folder: Path, manifest: Manifest) -> Judged:
    """Return what the runs of a bundle of L02 give, the lecture's study included where it is one.

    Raises:
        BundleRefused: `cases`, `labels`, `metrics`, or as `read_body_trace` and `read_frames`.
    """
    rendered = manifest.predicate.render.mode == "camera"
    lecture = manifest.predicate.page == l02.STUDY_PAGE
    cases = l02.CASES | (l02.SUBSTEP_CASES if lecture else {})
    traces = read_traces(folder, list(cases))
    counts = read_counts(folder, "model", l02.EXPECTED_MODEL)
    metrics, mass = measure(traces, cases), read_readings(folder, "body", ["mass"])["mass"]
    run = drop_checks.DropExperiment(
        model=counts,
        mass=mass,
        cases=cases,
        traces=traces,
        metrics=metrics,
        posture="camera" if rendered else "schematic",
        frames=read_frames(folder, manifest),
    )
    found, outcomes = metric_records(metrics, counts, mass), drop_checks.run_checks(run)
    if lecture:
        went = read_counts(folder, life_cycle.GROUP, life_cycle.names(rendered))
        found |= life_cycle.records(went)
        outcomes += run_study_checks(metrics, cases)
        outcomes += (life_cycle.check(went, rendered),)
    return Judged(found, outcomes)


def read_traces(folder: Path, cases: list[str]) -> dict[str, BodyTrace]:
    """Return the traces of a bundle by case, which must be those cases.

    Raises:
        BundleRefused: `cases`, `labels`, or as `read_body_trace`.
    """
    arrays = bundle.read_arrays(folder)
    expect("cases", "arrays.json", "list of cases", sorted(arrays.cases), sorted(cases))
    present = sorted(path.stem for path in (folder / "arrays").glob("*.npz"))
    expect("cases", "arrays/", "list of archives", present, sorted(cases))
    expect("labels", "arrays.json", "names of coords", sorted(arrays.coords), ["link"])
    expect("labels", "arrays.json", "list of links", arrays.coords["link"], [l02.LINK])
    return {case: read_body_trace(folder, arrays, case) for case in cases}
