"""Landings, slides and bounces of a bundle, as their page had them, from its files."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from robo_genesis import contact_checks, contact_studies, l03, records
from robo_genesis.contact_metrics import measure, metric_records
from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import Manifest
from robo_genesis.evidence.recompute import (
    Judged,
    read_counts,
    read_frames,
    read_readings,
)
from robo_genesis.evidence.strict_json import AGAIN, BundleRefused, expect
from robo_genesis.evidence.traces import read_contact_trace
from robo_genesis.trace import ContactTrace


def judge(folder: Path, manifest: Manifest) -> Judged:
    """Return what the runs of a bundle of L03 give: of the lab, or of the lecture's studies.

    Raises:
        BundleRefused: `cases`, `labels`, `metrics`, `bad-trace`, or as `read_contact_trace` and
            `read_frames`.
    """
    lecture = manifest.predicate.page == l03.STUDY_PAGE
    cases = l03.STUDY_CASES if lecture else l03.CASES
    traces = read_traces(folder, list(cases))
    counts = read_counts(folder, "model", l03.EXPECTED_MODEL)
    masses = read_readings(folder, "mass", ("cube",) if lecture else ("cube", "ball"))
    frames = read_frames(folder, manifest)
    posture = "camera" if manifest.predicate.render.mode == "camera" else "schematic"
    try:
        metrics = measure(traces, cases)
    except (IndexError, ValueError) as error:  # too few states for what is asked of a case
        raise BundleRefused("bad-trace", f"arrays: {error} {AGAIN}") from error
    found = metric_records(metrics, counts, masses)
    run = contact_checks.ContactExperiment(counts, masses, cases, traces, metrics, posture, frames)
    if not lecture:
        return Judged(found, contact_checks.run_checks(run))
    seconds = read_readings(folder, contact_studies.GROUP, l03.STEP_CASES)
    found |= {contact_studies.GROUP: records.readings(seconds, "s")}
    studies = contact_studies.Studies(traces, metrics, seconds)
    outcomes = contact_checks.run_study_checks(run) + contact_studies.run_checks(studies)
    return Judged(found, outcomes)


def read_traces(folder: Path, cases: Iterable[str]) -> Mapping[str, ContactTrace]:
    """Return the traces of a bundle by case, which must be those cases.

    Raises:
        BundleRefused: `cases`, `labels`, or as `read_contact_trace`.
    """
    expected = sorted(cases)
    arrays = bundle.read_arrays(folder)
    expect("cases", "arrays.json", "list of cases", sorted(arrays.cases), expected)
    present = sorted(path.stem for path in (folder / "arrays").glob("*.npz"))
    expect("cases", "arrays/", "list of archives", present, expected)
    expect("labels", "arrays.json", "names of coords", sorted(arrays.coords), ["link"])
    expect("labels", "arrays.json", "list of links", arrays.coords["link"], [l03.LINK])
    return {case: read_contact_trace(folder, arrays, case) for case in expected}
