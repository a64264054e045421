"""Metrics and checks of the dropped boxes, from the arrays, counts and frames of a bundle."""

from robo_genesis.lessons.declaration import BundleReader, Recomputed
from robo_genesis.lessons.l02 import checks, life_cycle, spec, study
from robo_genesis.lessons.l02.metrics import measure, metric_records


def recompute(files: BundleReader) -> Recomputed:
    """Return metrics and checks of a bundle's runs, those of the substep study for the lecture.

    Raises:
        BundleRefused: `cases`, `labels`, `metrics`, `frames`, or as `read_body_trace`.
    """
    lecture = files.page == spec.STUDY_PAGE
    cases = spec.CASES | (spec.SUBSTEP_CASES if lecture else {})
    traces = files.bodies(cases, spec.LINK)
    counts = files.counts("model", spec.EXPECTED_MODEL)
    metrics, mass = measure(traces, cases), files.readings("body", ["mass"])["mass"]
    run = checks.DropExperiment(
        counts, mass, cases, traces, metrics, files.end_state, files.frames()
    )
    records, outcomes = metric_records(metrics, counts, mass), checks.run_checks(run)
    if lecture:
        rendered = files.end_state == "camera"
        counted = files.counts(life_cycle.GROUP, life_cycle.expected(rendered))
        records |= life_cycle.records(counted)
        outcomes += study.run_checks(metrics, cases)
        outcomes += (life_cycle.check(counted, rendered),)
    return Recomputed(records, outcomes)
