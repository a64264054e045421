"""`make execute` and `make pages`: one page at a time, and what there is to execute."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from tiny_book import LAB_FRONT, WRITE_BUNDLE, cell, make_book, notebook

from robo_genesis.build.execute_one import execute_one
from robo_genesis.build.stages import Build, BuildError
from robo_genesis.core.project import ROOT, ProjectError

SCRIPT = ROOT / "build_scripts" / "execute.py"
LAB = notebook(cell(WRITE_BUNDLE), front=LAB_FRONT)


def build(folder: Path, said: list[str]) -> Build:
    return Build(book=folder / "book", cache=folder / "cache", say=said.append)


def command(folder: Path, *more: str, **environment: str) -> subprocess.CompletedProcess[str]:
    arguments = ["--book", str(folder / "book"), "--cache", str(folder / "cache")]
    return subprocess.run(
        [sys.executable, str(SCRIPT), *arguments, *more],
        env={**os.environ, "PYTHONPATH": str(ROOT), **environment},
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )


@pytest.mark.parametrize("asked", ["lab", "l04/lab"])
def test_one_page_is_executed_and_handed_over(tmp_path, asked):
    make_book(tmp_path, broken=notebook(cell("1 / 0")), lab=LAB)
    said: list[str] = []
    last = execute_one(asked, tmp_path / "to", build(tmp_path, said))
    assert last[0] == f"Executed page: {tmp_path / 'to' / 'lab'}"
    assert (tmp_path / "to/lab/outputs/l04/lab/cpu/manifest.json").is_file()
    assert [line.split("] ")[1] for line in said][-1] == "handover lab  executed"
    assert not any("broken" in line for line in said)


def test_a_page_that_the_cache_holds_is_handed_over_without_a_run(tmp_path):
    make_book(tmp_path, page=notebook(cell("1")))
    said: list[str] = []
    for to in ("one", "two"):
        execute_one("page", tmp_path / to, build(tmp_path, said))
    assert said[-1].endswith("handover page  reused")
    assert (tmp_path / "two/page/executed.ipynb").is_file()


@pytest.mark.parametrize("asked", ["", "None/None", "l04/lecture", "text"])
def test_another_page_is_refused_and_the_valid_ones_are_listed(tmp_path, asked):
    make_book(tmp_path, text="# Text\n", lab=LAB, page=notebook(cell("1")))
    valid = rf"PAGE='{asked}' is not valid\. Executed pages of this book: lab, page\."
    with pytest.raises(BuildError, match=valid):
        execute_one(asked, tmp_path / "to", build(tmp_path, []))


def test_a_place_that_cannot_be_written_is_refused_before_the_run(tmp_path, no_file):
    make_book(tmp_path, page=notebook(cell("1")))
    said: list[str] = []
    with pytest.raises(ProjectError, match="is no folder that you may write"):
        execute_one("page", no_file, build(tmp_path, said))
    with pytest.raises(BuildError, match="TO is not set"):
        execute_one("page", None, build(tmp_path, said))
    assert said == []


def test_a_failed_page_is_status_1_its_report_and_no_hand_over(tmp_path):
    make_book(tmp_path, page=notebook(cell("1 / 0")))
    done = command(tmp_path, PAGE="page", TO=str(tmp_path / "to"))
    assert done.returncode == 1
    assert "page, code cell 1, line 10: 1 / 0" in done.stderr
    assert "FAILED: nothing was handed over." in done.stderr
    assert not (tmp_path / "to").exists()


def test_a_page_measures_what_the_build_would_and_names_its_own_command(tmp_path):
    names = ("ROBO_GENESIS_RENDER", "ROBO_GENESIS_BACKEND", "ROBO_GENESIS_COMMAND")
    code = f"import os\nprint(*(os.environ[name] for name in {names}))"
    make_book(tmp_path, page=notebook(cell(code)))
    done = command(tmp_path, PAGE="page", TO=str(tmp_path / "to"), RENDER="0")
    assert done.returncode == 0, done.stderr
    assert r"0 cpu make execute\n" in (tmp_path / "to/page/executed.ipynb").read_text()


def test_the_list_is_one_line_of_json(tmp_path):
    make_book(tmp_path, text="# Text\n", lab=LAB, page=notebook(cell("1")))
    done = command(tmp_path, "--list")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == ["lab", "page"]
    assert done.stdout.count("\n") == 1
