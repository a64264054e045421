import sys

import pytest

from robo_genesis.build.backend_probe import expected_backend
from robo_genesis.core.project import ProjectError


@pytest.fixture
def answer(tmp_path, monkeypatch):
    """Let a shell script answer in the place of Python; return the path of that Python."""

    def replace(script: str) -> str:
        path = tmp_path / "python"
        path.write_text(f"#!/bin/sh\n{script}\n")
        path.chmod(0o755)
        monkeypatch.setattr(sys, "executable", str(path))
        return str(path)

    return replace


@pytest.mark.parametrize(
    ("torch", "backend"),
    [
        ('["7.0.1", null, 1]', "amdgpu"),
        ('["7.0.1", null, 0]', "cpu"),
        ('[null, "13.0", 2]', "cuda"),
        ('[null, "13.0", 0]', "cpu"),
        ("[null, null, 0]", "cpu"),
    ],
)
def test_torch_s_build_and_devices_decide_the_expected_backend(answer, torch, backend):
    answer(f"echo 'a warning of the driver'; echo '{torch}'")
    assert expected_backend() == backend


@pytest.mark.parametrize("said", ["ImportError: libamdhip64.so", ""])
def test_a_torch_that_does_not_answer_is_named_with_the_fix(answer, said):
    python = answer(f"echo '{said}' >&2; exit 1" if said else "")
    with pytest.raises(ProjectError, match=f"Torch of {python} does not .*{said}") as error:
        expected_backend()
    assert "PYTHON=path" in str(error.value)
