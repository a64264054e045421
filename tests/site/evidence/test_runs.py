"""The states of runs on pages follow from their bundles alone."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
from docutils import nodes

from robo_genesis.evidence.bundle import read_manifest
from robo_genesis.pipeline.bundles.status import Status
from robo_genesis.pipeline.pages.page_index import page_outputs
from robo_genesis.site.evidence.ledger import run_block
from robo_genesis.site.evidence.runs import PageRun, measured_line, status_line


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
    line = "Measured on CPU with Genesis 1.3.3 and 1.4.5 from 2026-11-22 to 2026-11-24."
    assert measured_line([later, one]) == line


@pytest.mark.parametrize(
    ("state", "backend", "words"),
    [
        ("verified", "amdgpu", "Measured on AMD GPU with Genesis 9.8.7"),
        ("inconclusive", "amdgpu", "AMD GPU run: inconclusive"),
        ("stale", "x<y", "x&lt;y run: stale"),
    ],
)
def test_the_line_of_an_accepted_run_alone_has_its_engine_and_no_markup(
    state, backend, words
):
    manifest = SimpleNamespace(engine=SimpleNamespace(version="9.8.7"))
    status = Status(state, backend, "", manifest)
    assert (
        status_line([status])
        == f'<span class="status-word state-{state}">{words}</span>'
    )


@pytest.mark.parametrize(
    ("recorded", "key", "command"),
    [
        (False, "l04/lab/cpu", "$ make book"),
        (True, "l04/lab/cpu/recorded", "$ make evidence LESSON=l04 BACKEND=cpu"),
    ],
)
def test_a_recorded_run_has_its_own_key_and_command(tmp_path, recorded, key, command):
    run = PageRun("l04/lab", tmp_path, Status("stale", "cpu", "old", None), recorded)
    assert run.key == key
    block = run_block("", run)
    assert [code.astext() for code in block.findall(nodes.literal_block)] == [command]
