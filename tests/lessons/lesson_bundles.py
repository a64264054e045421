"""Writer and spoilers of bundles, shared by the tests of all lessons."""

import pytest
from bundles import written
from spoilers import METRICS, put, seal

from robo_genesis.evidence.bundle import BundleRefused
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
