"""Landings, slides and bounces of a bundle, as their page had them, from its files."""

from pathlib import Path

from robo_genesis import contact_checks, contact_studies, l03, records
from robo_genesis.contact_metrics import measure, metric_records
from robo_genesis.contacts import SETTINGS
from robo_genesis.evidence.bundle import Manifest
from robo_genesis.evidence.recompute import (
    Judged,
    read_counts,
    read_frames,
    read_readings,
)
from robo_genesis.evidence.strict_json import AGAIN, BundleRefused
from robo_genesis.evidence.traces import read_bodies, read_contact_trace


def judge(folder: Path, manifest: Manifest) -> Judged:
    """Return what the runs of a bundle of L03 give: of the lab, or of the lecture's studies.

    Raises:
        BundleRefused: `cases`, `labels`, `metrics`, `bad-trace`, or as `read_contact_trace` and
            `read_frames`.
    """
    lecture = manifest.predicate.page == l03.STUDY_PAGE
    cases = l03.STUDY_CASES if lecture else l03.CASES
    traces = read_bodies(folder, cases, l03.LINK, read_contact_trace)
    counts = read_counts(folder, "model", l03.EXPECTED_MODEL)
    masses = read_readings(folder, "mass", ("cube",) if lecture else ("cube", "ball"))
    frames = read_frames(folder, manifest)
    posture = "camera" if manifest.predicate.render.mode == "camera" else "schematic"
    try:
        metrics = measure(traces, cases)
    except (IndexError, ValueError) as error:  # too few states for what is asked of a case
        raise BundleRefused("bad-trace", f"arrays: {error} {AGAIN}") from error
    settings = {
        name: read_readings(folder, name, l03.BY_GENESIS if lecture else cases) for name in SETTINGS
    }
    found = metric_records(metrics, counts, masses, settings)
    run = contact_checks.ContactExperiment(
        counts, masses, settings, cases, traces, metrics, posture, frames
    )
    if not lecture:
        return Judged(found, contact_checks.run_checks(run))
    seconds = read_readings(folder, contact_studies.GROUP, l03.STEPS_STUDIED)
    found |= {contact_studies.GROUP: records.readings(seconds, "s")}
    studies = contact_studies.Studies(traces, metrics, seconds)
    outcomes = contact_checks.run_study_checks(run) + contact_studies.run_checks(studies)
    return Judged(found, outcomes)
