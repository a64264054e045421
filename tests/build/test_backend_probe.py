import sys
from pathlib import Path

import pytest

from robo_genesis.build.backend_probe import backend_of, foreseen_backend
from robo_genesis.core.project import ProjectError


@pytest.mark.parametrize(
    ("hip", "cuda", "count", "backend"),
    [
        ("7.0.1", None, 1, "amdgpu"),
        ("7.0.1", None, 0, "cpu"),
        (None, "13.0", 2, "cuda"),
        (None, "13.0", 0, "cpu"),
        (None, None, 0, "cpu"),
    ],
)
def test_torch_s_build_and_devices_foretell_the_backend(hip, cuda, count, backend):
    assert backend_of(hip, cuda, count) == backend


def fake_python(folder: Path, script: str) -> str:
    path = folder / "python"
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)
    return str(path)


def test_torch_is_asked_in_a_process_of_its_own(tmp_path, monkeypatch):
    answer = "echo 'a warning of the driver'; echo '[\"7.0\", null, 1]'"
    monkeypatch.setattr(sys, "executable", fake_python(tmp_path, answer))
    assert foreseen_backend() == "amdgpu"


@pytest.mark.parametrize(
    ("script", "said"),
    [("echo 'ImportError: libamdhip64.so' >&2; exit 1", "ImportError: libamdhip64.so"), ("", "")],
)
def test_a_torch_that_does_not_answer_is_named_with_the_mend(tmp_path, monkeypatch, script, said):
    python = fake_python(tmp_path, script)
    monkeypatch.setattr(sys, "executable", python)
    with pytest.raises(ProjectError, match=f"Torch of {python} does not say .*{said}") as error:
        foreseen_backend()
    assert "PYTHON=path" in str(error.value)
