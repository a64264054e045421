"""The command line, and the Makefile, which passes settings to it."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from robo_genesis import __main__ as cli
from robo_genesis.core.project import ROOT
from robo_genesis.pipeline import release


@pytest.fixture
def checkout(tmp_path):
    """The Makefile in a folder with a space in its name, with a Python that says its words."""
    folder = tmp_path / "a course"
    folder.mkdir()
    shutil.copy(ROOT / "Makefile", folder)
    python = folder / "python"
    python.write_text('#!/bin/sh\nprintf "%s|" "$@"\n')
    python.chmod(0o755)
    return folder


def make(folder: Path, *words: str, **given: str) -> str:
    python = folder / "python"
    command = ["make", f"PYTHON={python}", f"BASE_PYTHON={python}", *words]
    environment = {
        "PATH": os.environ["PATH"]
    } | given  # none of a make around the tests
    done = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize(
    ("target", "given", "words"),
    [
        ("book", {}, "book"),
        (
            "book",
            {"JOBS": "2", "SITE_URL": "https://a.b/c d", "RELEASE": "1"},
            "book|--jobs=2|--release=1|--site-url=https://a.b/c d",
        ),
        ("execute", {"PAGE": "l04/lab", "RENDER": "0"}, "execute|--render=0|l04/lab"),
        (
            "evidence",
            {"BACKEND": "cuda", "TO": "a b"},
            "evidence|--backend=cuda|--to=a b",
        ),
        ("evidence-rocm", {"LESSON": "l04"}, "evidence-rocm|--lesson=l04"),
        ("compare", {"OLD": "a b", "NEW": "c"}, "compare|a b|c"),
        ("lesson", {"NEW": "l09"}, "lesson|l09"),
        ("repin", {"GENESIS": "1.4.5"}, "repin|1.4.5"),
        ("lock", {"UPGRADE": "numpy"}, "lock|--upgrade=numpy"),
        ("live", {"PORT": "0"}, "live|--port=0"),
    ],
)
@pytest.mark.parametrize("before", [False, True])
def test_make_passes_settings_written_after_or_before_it(
    checkout, target, given, words, before
):
    after = [] if before else [f"{name}={value}" for name, value in given.items()]
    said = make(checkout, target, *after, **(given if before else {}))
    assert said == f"-m|robo_genesis|{words}|"
    cli.parser().parse_args(words.split("|"))


def test_clean_keeps_what_the_engine_compiled_and_distclean_does_not(checkout):
    compiled = checkout / ".cache" / "engine" / "1-a" / "kernels" / "kernel.qdc"
    executed = checkout / ".cache" / "pages" / "lab" / "executed.ipynb"
    for path in (compiled, executed):
        path.parent.mkdir(parents=True)
        path.touch()
    make(checkout, "clean")
    assert (compiled.exists(), executed.exists()) == (True, False)
    make(checkout, "distclean")
    assert not compiled.exists()


@pytest.mark.parametrize(
    "words", ["bok", "book --job-count=2", "book --render=2", "evidence --backend=cupa"]
)
def test_a_word_that_is_not_known_is_refused(words, capsys):
    with pytest.raises(SystemExit) as end:
        cli.main(words.split())
    assert end.value.code == 2
    assert "usage: python -m robo_genesis" in capsys.readouterr().err


def test_a_release_needs_camera_frames(monkeypatch, capsys):
    monkeypatch.setattr(os, "environ", dict(os.environ))
    monkeypatch.setattr(release, "build", pytest.fail)
    assert cli.main(["book", "--release=1", "--render=0"]) == 1
    assert "leave RENDER=0 out" in capsys.readouterr().err
