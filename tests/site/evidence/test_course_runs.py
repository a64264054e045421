"""The line on the measurement of the course follows from the bundles of this build alone."""

from dataclasses import replace
from pathlib import Path

import pytest

from robo_genesis.evidence.bundle import read_manifest
from robo_genesis.pipeline.bundles.status import Status
from robo_genesis.pipeline.pages.page_index import page_outputs
from robo_genesis.site.evidence.course_runs import executed_once, measured_line
from robo_genesis.site.evidence.ledger_data import PageRun


@pytest.fixture
def accepted(outputs):
    """Return a run as the build accepted it, with another version, start or backend."""
    manifest = read_manifest(page_outputs("l04/lab") / "cpu")

    def run(
        version="1.4.5", started="2026-11-22T10:00", backend="cpu", recorded=False
    ) -> PageRun:
        engine = manifest.engine.model_copy(update={"version": version})
        changed = {"engine": engine, "started": started}
        shown = manifest.model_copy(update=changed)
        return PageRun(
            "l04/lab", Path(), Status("verified", backend, "", shown), recorded
        )

    return run


def test_the_line_names_versions_and_dates_of_the_accepted_runs_of_this_build(accepted):
    one, later = accepted(), accepted("1.3.3", "2026-11-24T10:00:00")
    elsewhere = accepted("1.3.3", "2020-01-01T00:00:00", "amdgpu", recorded=True)
    missing = replace(one, status=Status("missing", "cpu", "", None))
    line = "Measured on CPU with Genesis 1.4.5 on 2026-11-22."
    assert measured_line([one, one, elsewhere]) == line
    assert measured_line([one, missing]) == f"{line} 1 of 2 runs were not accepted."
    assert measured_line([missing]) == "No run of this build was accepted."
    assert (
        executed_once([one, missing, one]) == "Each page was executed once, on a CPU."
    )
    assert executed_once([elsewhere, missing]) == "No run of this build was accepted."
    line = "Measured on CPU with Genesis 1.3.3 and 1.4.5 from 2026-11-22 to 2026-11-24."
    assert measured_line([later, one]) == line
