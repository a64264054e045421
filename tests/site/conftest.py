"""Outputs of a build, for what reads measured values."""

import pytest
from bundles import RENDERER


@pytest.fixture
def outputs(recorder, experiment, monkeypatch):
    """Let the synthetic run of L04's lab be the outputs of this build."""
    recorder.write(experiment, RENDERER)
    monkeypatch.setenv("ROBO_GENESIS_BUILD_OUTPUTS", str(recorder.contract.outputs))
