import shutil
from dataclasses import replace

import pytest

from robo_genesis.evidence.status import page_status, recorded_status
from robo_genesis.project import engine_pin


@pytest.fixture
def outputs(folder):
    return folder.parents[2]


def test_a_sound_bundle_is_verified(outputs):
    status = page_status(outputs, "l04", "lab", "cpu")
    assert (status.state, status.reason) == ("verified", "")
    assert status.sentence.startswith("cpu: verified. Run by hand, Genesis ")
    assert "12 of 12 checks passed, camera frames by llvmpipe, measured 20" in status.sentence


def test_a_run_by_the_build_is_called_a_clean_kernel(recorder, measured, monkeypatch):
    monkeypatch.setenv("ROBO_GENESIS_COMMAND", "make book")
    written = recorder.write(measured)
    assert "Clean kernel" in page_status(written.parents[2], "l04", "lab", "cpu").sentence


def test_another_backend_s_evidence_is_missing_until_it_is_recorded(folder, tmp_path):
    status = recorded_status(tmp_path, "l04", "amdgpu")
    assert (status.state, status.backend) == ("missing", "amdgpu")
    assert f"recorded for Genesis {engine_pin()}." in status.sentence
    shutil.copytree(folder, tmp_path / "evidence" / "l04" / "cpu")
    assert recorded_status(tmp_path, "l04", "cpu").state == "verified"


def test_no_bundle_is_missing(outputs):
    status = page_status(outputs, "l04", "lab", "amdgpu")
    assert (status.state, status.manifest) == ("missing", None)
    assert status.sentence == "amdgpu: missing. No bundle was recorded for l04/lab."


def test_a_spoiled_bundle_is_refused_with_its_reason(outputs, folder):
    (folder / "log.txt").unlink()
    status = page_status(outputs, "l04", "lab", "cpu")
    assert (status.state, status.manifest) == ("refused", None)
    assert status.sentence.startswith("cpu: refused. files: listed but absent: ['log.txt']")


def test_a_copy_for_another_backend_is_refused(outputs, folder):
    shutil.copytree(folder, folder.with_name("amdgpu"))
    assert page_status(outputs, "l04", "lab", "amdgpu").state == "refused"


def test_a_run_without_a_camera_says_skip(outputs, folder, recorder, measured):
    recorder.contract = replace(recorder.contract, render=False)
    written = recorder.write(replace(measured, frames={}, renderer=None))
    status = page_status(written.parents[2], "l04", "lab", "cpu")
    assert "camera SKIP" in status.sentence
