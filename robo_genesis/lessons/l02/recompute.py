"""The dropped boxes of a bundle as their page measured them, from arrays, counts and frames."""

from robo_genesis.lessons.declaration import BundleReader, Recomputed
from robo_genesis.lessons.l02 import checks, life_cycle, spec, study
from robo_genesis.lessons.l02.metrics import measure, metric_records


def recompute(files: BundleReader) -> Recomputed:
    """Return what the runs of a bundle give, with the substep study where the page has it.

    Raises:
        BundleRefused: `cases`, `labels`, `metrics`, `frames`, or as `read_body_trace`.
    """
    rendered, lecture = files.end_state == "camera", files.page == spec.STUDY_PAGE
    cases = spec.CASES | (spec.SUBSTEP_CASES if lecture else {})
    traces = files.bodies(cases, spec.LINK)
    counts = files.counts("model", spec.EXPECTED_MODEL)
    metrics, mass = measure(traces, cases), files.readings("body", ["mass"])["mass"]
    run = checks.DropExperiment(
        model=counts,
        mass=mass,
        cases=cases,
        traces=traces,
        metrics=metrics,
        posture=files.end_state,
        frames=files.frames(),
    )
    found, outcomes = metric_records(metrics, counts, mass), checks.run_checks(run)
    if lecture:
        outcome = files.counts(life_cycle.GROUP, life_cycle.names(rendered))
        found |= life_cycle.records(outcome)
        outcomes += study.run_checks(metrics, cases)
        outcomes += (life_cycle.check(outcome, rendered),)
    return Recomputed(found, outcomes)
