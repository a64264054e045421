"""The panel of a reference run shows what its bundle holds, or what is missing and makes it."""

import base64
import re

import pytest

from robo_genesis import sphinx_panel
from robo_genesis.evidence import bundle
from robo_genesis.evidence.status import Status, recorded_status
from robo_genesis.evidence.traces import read_trace
from robo_genesis.evidence.verify import verify_bundle
from robo_genesis.metrics import format_value


@pytest.fixture
def verified(folder) -> Status:
    return Status("verified", "cpu", "", verify_bundle(folder))


def test_a_missing_run_is_named_with_its_command(tmp_path):
    text = sphinx_panel.missing_text("l04", recorded_status(tmp_path, "l04", "amdgpu"))
    assert "**Reference run on amdgpu: missing.**" in text
    assert "$ make evidence LESSON=l04 BACKEND=amdgpu" in text


def test_backend_facts_are_the_manifest_s(verified):
    text = sphinx_panel.backend_text(verified)
    predicate = verified.manifest.predicate
    for fact in (predicate.backend.device_name, predicate.run_id[:8], predicate.render.renderer):
        assert f"| {fact} |" in text


def test_the_figure_changes_with_the_bundle_s_arrays(folder, verified, monkeypatch):
    html = sphinx_panel.figure_html(folder, verified)
    assert base64.b64decode(re.search(r"base64,([^\"]+)", html)[1]).startswith(b"<?xml")
    assert "joint4 over time on cpu" in html
    assert sphinx_panel.figure_html(folder, verified) == html
    shown = {"G1": "G2", "G2": "G1", "G3": "G3"}
    monkeypatch.setattr(
        sphinx_panel, "read_trace", lambda f, a, case: read_trace(f, a, shown[case])
    )
    assert sphinx_panel.figure_html(folder, verified) != html


def test_frames_are_shown_small_and_only_where_there_are_any(folder, verified):
    assert sphinx_panel.frames_html(folder, verified).count("data:image/webp") == 2
    for frame in (folder / "frames").glob("*.png"):
        frame.unlink()
    assert sphinx_panel.frames_html(folder, verified) == ""


def test_metrics_stand_side_by_side(folder):
    text = sphinx_panel.metrics_text(folder, folder, "cuda")
    record = bundle.read_metrics(folder)["G2"]["overshoot"]
    value = format_value(record.value, record.unit)
    assert f"| G2 | overshoot | {value} | {value} |" in text
    assert "cuda, recorded" in text.splitlines()[0]


def test_warnings_are_escaped_and_folded():
    html = sphinx_panel.warnings_html(["a < b"])
    assert (
        html == "<details><summary>1 engine warnings</summary><ol><li>a &lt; b</li></ol></details>"
    )
