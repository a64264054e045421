"""The dropped boxes of a bundle as their page had them, from arrays, counts and frames."""

from pathlib import Path

from robo_genesis import drop_checks, l02, life_cycle
from robo_genesis.drop_metrics import measure, metric_records
from robo_genesis.evidence.bundle import Manifest
from robo_genesis.evidence.recompute import Judged, read_counts, read_frames, read_readings
from robo_genesis.evidence.traces import read_bodies, read_body_trace
from robo_genesis.substep_study import run_checks as run_study_checks


def judge(folder: Path, manifest: Manifest) -> Judged:
    """Return what the runs of a bundle of L02 give, the lecture's study included where it is one.

    Raises:
        BundleRefused: `cases`, `labels`, `metrics`, or as `read_body_trace` and `read_frames`.
    """
    rendered = manifest.predicate.render.mode == "camera"
    lecture = manifest.predicate.page == l02.STUDY_PAGE
    cases = l02.CASES | (l02.SUBSTEP_CASES if lecture else {})
    traces = read_bodies(folder, cases, l02.LINK, read_body_trace)
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
