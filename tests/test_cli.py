"""The Makefile and `make serve`: their messages about a wrong environment."""

import os
import re
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
    (folder / "requirements.lock").touch()
    stub = (
        "import os\nprint(os.environ['PYTHONPATH'], os.environ.get('TO'), sep='\\n')\n"
    )
    for name in ("serve.py", "evidence_rocm.py"):
        (folder / "build_scripts" / name).write_text(stub)
    return folder


def python(folder: Path, *options: str) -> Path:
    """Write a Python command that always has these options."""
    path = folder / "python"
    path.write_text(f"#!/bin/sh\nexec '{sys.executable}' {' '.join(options)} \"$@\"\n")
    path.chmod(0o755)
    return path


def make(folder: Path, *words: str, **set_: str) -> subprocess.CompletedProcess[str]:
    command = ["make", "-C", str(folder), f"BASE_PYTHON={sys.executable}", *words]
    given = {
        "PATH": os.environ["PATH"]
    } | set_  # no variable of a make around these tests
    return subprocess.run(
        command, env=given, capture_output=True, text=True, timeout=60
    )


@pytest.mark.parametrize("target", ["serve", "evidence-rocm"])
def test_paths_and_settings_may_contain_spaces_and_a_container_needs_no_venv(
    checkout, target
):
    words = [] if target == "evidence-rocm" else [f"PYTHON={python(checkout)}"]
    done = make(
        checkout, target, *words, TO="a folder", ROWS="prose live=fast", PAGE=""
    )
    assert done.returncode == 0, done.stderr
    assert {str(checkout), "a folder"} <= {*done.stdout.splitlines()}
    assert not (checkout / ".venv").exists()
    assert (
        f"make {target} does not read ROWS TO, which the environment has" in done.stderr
    )


@pytest.mark.parametrize(
    ("target", "words", "said"),
    [
        # Recording needs no package of the tests and linters.
        (
            "serve",
            ["PYTHON={bare}"],
            "PYTHON={bare} lacks genesis, jupyter_book, pytest, ",
        ),
        (
            "evidence",
            ["PYTHON={bare}"],
            "PYTHON={bare} lacks genesis, jupyter_book. Install",
        ),
        (
            "serve",
            ["PYTHON=nowhere/python"],
            "PYTHON=nowhere/python is not a Python command",
        ),
        ("serve", ["PYTHON=/tmp"], "PYTHON=/tmp is not a Python command"),
        ("serve", ["PYTHON=ls"], "PYTHON=ls is not a Python command"),
        (
            "evidence-rocm",
            ["BASE_PYTHON=nopy"],
            "BASE_PYTHON=nopy is not a command of Python 3",
        ),
        (
            ".venv/.installed",
            ["BASE_PYTHON=ls"],
            "BASE_PYTHON=ls is not a command of Python 3",
        ),
        (
            "serve",
            ["jobs=2"],
            "make serve does not read jobs. It reads BASE_PYTHON PORT PYTHON ",
        ),
        (
            "serve",
            ["site_url=https://example.org/a=b"],
            "make serve does not read site_url.",
        ),
        (
            "book",
            ["LESSON=l77"],
            "make book does not read LESSON. It reads BASE_PYTHON EXECUTED",
        ),
        (
            "test",
            ["JOB=3"],
            "make test does not read JOB. It reads BASE_PYTHON EXECUTED JOBS",
        ),
        (
            "clean",
            ["ROWS=a TO=b"],
            "make clean does not read ROWS. It reads BASE_PYTHON PYTHON ",
        ),
        (
            "serve",
            ["test", "PORT=1", "RUNS=3"],
            "make serve test does not read RUNS. It reads B",
        ),
        ("lessons", ["NEW=l07"], "No rule to make target 'lessons'"),
    ],
)
def test_a_wrong_environment_is_refused_with_the_fix(checkout, target, words, said):
    bare = python(checkout, "-S")
    done = make(checkout, target, *(word.format(bare=bare) for word in words))
    assert done.returncode != 0
    assert said.format(bare=bare) in done.stderr
    assert "Traceback" not in done.stderr
    assert (
        str(checkout) not in done.stdout.splitlines()
    )  # what the stub of the command prints


def test_each_target_says_what_it_reads():
    text = (ROOT / "Makefile").read_text()
    targets = set(re.findall(r"^([a-z-]+):", text, re.MULTILINE))
    said = set(re.findall(r"^([a-z-]+)_READS", text, re.MULTILINE))
    (without,) = re.findall(r"foreach name,(.*),\$\(eval", text)
    assert targets == (said | {*without.split()}) - {".venv/.installed"} | {
        "has-packages"
    }


def test_an_environment_whose_python_is_gone_or_was_not_made_by_make_is_named(checkout):
    foreign = checkout / ".venv" / "bin" / "python"
    foreign.parent.mkdir(parents=True)
    foreign.symlink_to("/nowhere/python")
    done = make(checkout, "distclean")
    assert ".venv was not made by make, so it stays" in done.stderr
    assert foreign.is_symlink()
    (checkout / ".venv/.installed").touch()
    done = make(checkout, "serve")
    assert (
        ".venv/bin/python is not a Python command. The Python that made it was re"
        in done.stderr
    )
    assert make(checkout, "distclean").returncode == 0
    assert not foreign.parent.exists()


def test_a_path_with_a_colon_is_refused(checkout):
    done = make(checkout.rename(checkout.with_name("a:b")), "help")
    assert (
        "a:b has a colon, which separates the entries of PYTHONPATH. Rename"
        in done.stderr
    )


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
        command = [sys.executable, str(ROOT / "build_scripts" / "serve.py")]
        given = os.environ | {"PYTHONPATH": str(tmp_path), "PORT": port}
        done = subprocess.run(
            command, env=given, capture_output=True, text=True, timeout=60
        )
    assert done.returncode == 1
    assert done.stderr == f"PORT={port}: Address already in use. Choose a free port.\n"
