"""Metrics and checks of landings, slides and bounces, from the files of a bundle."""

from robo_genesis.core.metrics import reading_records
from robo_genesis.core.refusals import AGAIN, BundleRefused
from robo_genesis.lessons.declaration import BundleReader, Recomputed
from robo_genesis.lessons.l03 import checks, spec, study
from robo_genesis.lessons.l03.metrics import measure, metric_records
from robo_genesis.sim.contacts import SETTINGS


def recompute(files: BundleReader) -> Recomputed:
    """Return metrics and checks of a bundle's runs, of the lab or of the lecture's studies.

    Raises:
        BundleRefused: `cases`, `labels`, `metrics`, `bad-trace`, `frames`, or as
            `read_contact_trace`.
    """
    lecture = files.page == spec.STUDY_PAGE
    cases = spec.STUDY_CASES if lecture else spec.CASES
    traces = files.contacts(cases, spec.LINK)
    counts = files.counts("model", spec.EXPECTED_MODEL)
    masses = files.readings("mass", ("cube",) if lecture else ("cube", "ball"))
    frames = files.frames()
    try:
        metrics = measure(traces, cases)
    except (IndexError, ValueError) as error:  # a run with too few states
        raise BundleRefused("bad-trace", f"arrays: {error} {AGAIN}") from error
    by_setting = spec.BY_GENESIS if lecture else cases
    settings = {name: files.readings(name, by_setting) for name in SETTINGS}
    records = metric_records(metrics, counts, masses, settings)
    run = checks.ContactExperiment(
        counts, masses, settings, cases, traces, metrics, files.end_state, frames
    )
    if not lecture:
        return Recomputed(records, checks.run_checks(run))
    seconds = files.readings(study.GROUP, spec.STEPS_STUDIED)
    records |= {study.GROUP: reading_records(seconds, "s")}
    studies = study.Studies(traces, metrics, seconds)
    return Recomputed(records, checks.run_study_checks(run) + study.run_checks(studies))
