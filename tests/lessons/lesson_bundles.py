"""Writer and spoilers of bundles, shared by the tests of all lessons."""

import re
from dataclasses import replace

import pytest
from bundles import written
from spoilers import METRICS, facts, put, seal

from robo_genesis.core import project
from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.evidence.reader import from_bundle
from robo_genesis.pipeline.bundles import verify as evidence_key
from robo_genesis.pipeline.bundles.status import bundle_status
from robo_genesis.pipeline.bundles.verify import verify_bundle


def metric(group, name, value):
    return put(METRICS, group, name, value=value)


def refused(folder) -> str:
    """Return the refusal of a spoiled bundle with correct digests and key."""
    seal(folder)
    with pytest.raises(BundleRefused) as caught:
        verify_bundle(folder)
    return str(caught.value)


def accepted_then_refused(engine, outputs, lesson, page, run, spoil) -> str:
    """Require that the bundle of a run is accepted, and return the refusal once it is spoiled."""
    folder = written(engine, outputs, lesson, page, run)
    assert all(check.passed for check in verify_bundle(folder).checks)
    spoil(folder)
    return refused(folder)


def judged_again(folder, monkeypatch, judgements):
    """Require that each other judging value changes the verdict of one check, and nothing else.

    Args:
        folder: a sound bundle.
        monkeypatch: the fixture of pytest.
        judgements: module, name and value with which a check fails, and the name of the
            check.
    """
    manifest = bundle.read_manifest(folder)
    experiment = from_bundle(folder, manifest, bundle.read_metrics(folder))
    for module, name, value, check in judgements:
        with monkeypatch.context() as context:
            context.setattr(module, name, value)
            outcomes = replace(experiment).outcomes()
        assert [found.name for found in outcomes if not found.passed] == [check], name
    with monkeypatch.context() as context:
        for module, name, value, _ in judgements:
            context.setattr(module, name, value)
        found = manifest.model_dump()
        of_page = (found["lesson"], found["page"], project.ROOT, project.BOOK)
        key = bundle.evidence_key(found | evidence_key.question(*of_page))
        status = bundle_status(folder)
    assert key == manifest.evidence_key
    assert (status.state, status.code) == ("failed", "failed")
    failed = {check for *_, check in judgements}
    assert set(re.findall(r" \[(\w+)\] ", status.reason)) == failed
    claimed = [record.model_dump() for record in manifest.checks]
    for record in claimed:
        record["passed"] = record["name"] not in failed
    facts(checks=claimed)(folder)
    assert all(record.passed for record in verify_bundle(folder).checks)
