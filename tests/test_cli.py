"""The Makefile and `make serve`: their messages about a wrong environment."""

import os
import shutil
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from robo_genesis.core.project import ROOT


@pytest.fixture
def checkout(tmp_path):
    """The Makefile in a folder with a space in its name, with a stub instead of the server."""
    folder = tmp_path / "a course"
    (folder / "build_scripts").mkdir(parents=True)
    shutil.copy(ROOT / "Makefile", folder)
    stub = "import os\nprint(os.environ['PYTHONPATH'], os.environ.get('TO'), sep='\\n')\n"
    for name in ("serve.py", "evidence_rocm.py"):
        (folder / "build_scripts" / name).write_text(stub)
    return folder


def python(folder: Path, *options: str) -> Path:
    """Write a Python command that always has these options."""
    path = folder / "python"
    path.write_text(f"#!/bin/sh\nexec '{sys.executable}' {' '.join(options)} \"$@\"\n")
    path.chmod(0o755)
    return path


def make(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    command = ["make", "-C", str(folder), *words, f"BASE_PYTHON={sys.executable}"]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)


@pytest.mark.parametrize("target", ["serve", "evidence-rocm"])
def test_a_path_and_a_setting_may_contain_spaces_and_what_runs_in_a_container_needs_no_venv(
    checkout, target
):
    words = [] if target == "evidence-rocm" else [f"PYTHON={python(checkout)}"]
    done = make(checkout, target, *words, "TO=a folder", "ROWS=prose live=fast", "pip_option=x")
    assert done.returncode == 0, done.stderr
    assert {str(checkout), "a folder"} <= {*done.stdout.splitlines()}
    assert not (checkout / ".venv").exists()


@pytest.mark.parametrize(
    ("target", "words", "said"),
    [
        # Recording needs no package of the tests and linters.
        ("serve", ["PYTHON={bare}"], "PYTHON={bare} lacks genesis, jupyter_book, pytest, "),
        ("evidence", ["PYTHON={bare}"], "PYTHON={bare} lacks genesis, jupyter_book. Install"),
        ("serve", ["PYTHON=nowhere/python"], "PYTHON=nowhere/python is not a Python command"),
        ("serve", ["PYTHON=/tmp"], "PYTHON=/tmp is not a Python command"),
        ("serve", ["PYTHON=ls"], "PYTHON=ls is not a Python command"),
        ("serve", ["jobs=2"], "jobs would be ignored: variables are in capitals. Write JOBS"),
        ("serve", ["site_url=https://example.org/a=b"], "site_url would be ignored"),
        ("serve", ["Page=l04/lab", "to=folder"], "Write "),
    ],
)
def test_a_wrong_environment_is_refused_with_the_fix(checkout, target, words, said):
    bare = python(checkout, "-S")
    done = make(checkout, target, *(word.format(bare=bare) for word in words))
    assert done.returncode != 0
    assert said.format(bare=bare) in done.stderr
    assert "Traceback" not in done.stderr
    assert str(checkout) not in done.stdout.splitlines()  # what the stub of the command prints


def test_clean_keeps_what_the_engine_compiled_and_distclean_does_not(checkout):
    compiled = checkout / ".cache" / "engine" / "1-a" / "kernels" / "kernel.qdc"
    executed = checkout / ".cache" / "pages" / "b" / "notebooks" / "global.db"
    for path in (compiled, executed):
        path.parent.mkdir(parents=True)
        path.touch()
    assert make(checkout, "clean").returncode == 0
    assert compiled.exists()
    assert not executed.exists()
    assert make(checkout, "distclean").returncode == 0
    assert not compiled.exists()


def test_a_port_in_use_is_refused(tmp_path):
    (tmp_path / "book/_build/html").mkdir(parents=True)
    (tmp_path / "book/_build/html/index.html").touch()
    shutil.copytree(ROOT / "robo_genesis", tmp_path / "robo_genesis")
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = str(server.getsockname()[1])
        done = subprocess.run(
            [sys.executable, str(ROOT / "build_scripts" / "serve.py")],
            env=os.environ | {"PYTHONPATH": str(tmp_path), "PORT": port},
            capture_output=True,
            text=True,
            check=False,
            timeout=60,
        )
    assert done.returncode == 1
    assert done.stderr == f"PORT={port}: Address already in use. Choose a free port.\n"
