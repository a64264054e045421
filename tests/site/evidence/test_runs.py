"""The states of runs on pages follow from their bundles alone."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

from robo_genesis.core.project import engine_pin
from robo_genesis.evidence.bundle import read_manifest
from robo_genesis.pipeline.bundles.status import Status
from robo_genesis.pipeline.pages.page_index import page_bundle
from robo_genesis.site.evidence.runs import PageRun, measured_line, status_list


@pytest.fixture
def accepted(outputs):
    """Return a run as the build accepted it, with another version, start or backend."""
    manifest = read_manifest(page_bundle("l04/lab"))

    def run(started="2026-11-22T10:00", backend="cpu", recorded=False) -> PageRun:
        shown = manifest.model_copy(update={"started": started})
        status = Status("verified", backend, "", shown)
        return PageRun("l04/lab", Path(), status, recorded)

    return run


def test_the_line_names_the_dates_of_the_accepted_runs_of_this_build(accepted):
    one, later = accepted(), accepted("2026-11-24T10:00:00")
    elsewhere = accepted("2020-01-01T00:00:00", "amdgpu", recorded=True)
    missing = replace(one, status=Status("missing", "cpu", "", None))
    measured = f"Measured on CPU with Genesis {engine_pin()}"
    line = f"{measured} on 2026-11-22."
    assert measured_line([one, one, elsewhere]) == line
    assert measured_line([one, missing]) == line
    assert measured_line([missing]) == "No run of this build was accepted."
    line = f"{measured} from 2026-11-22 to 2026-11-24."
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
    status = SimpleNamespace(state=state, backend=backend, manifest=manifest)
    html = status_list([], line=[status]).astext()
    assert f'<span class="status-word state-{state}">{words}</span>' in html


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
    assert run.command == command
