import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import psutil
import pytest
from tiny_book import LAB_FRONT, WRITE_BUNDLE, cell, make_book, notebook, published_marker

from robo_genesis.build import Build, BuildError, only_build, run_build
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.project import ROOT, ProjectError

SCRIPT = ROOT / "build_scripts" / "book.py"
FACTS = SimpleNamespace(
    engine=SimpleNamespace(version="1.2.3"),
    backend=SimpleNamespace(requested="cpu", actual="cpu"),
    render=SimpleNamespace(mode="camera", renderer="llvmpipe"),
    checks=["one", "two", "three"],
)


def accept(folder: Path, run_id: str) -> SimpleNamespace:
    """Stand in for the verification of evidence, which needs the engine's records."""
    assert (folder / "manifest.json").is_file()
    assert run_id
    return SimpleNamespace(predicate=FACTS)


def refuse(folder: Path, run_id: str) -> SimpleNamespace:
    raise BundleRefused("metrics", "metrics.json g1.rise_time is not what the arrays say.")


def build(folder: Path, said: list[str] | None = None, **settings) -> list[str]:
    settings = {"verify": accept, "say": (said if said is not None else []).append} | settings
    return run_build(Build(book=folder / "book", cache=folder / "cache", **settings))


def command(folder: Path, **environment: str) -> subprocess.Popen[str]:
    """Start `make book`'s command on a tiny book."""
    arguments = ["--book", str(folder / "book"), "--cache", str(folder / "cache")]
    return subprocess.Popen(
        [sys.executable, str(SCRIPT), *arguments],
        env={**os.environ, "PYTHONPATH": str(ROOT), **environment},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def test_a_build_publishes_site_and_evidence_and_says_with_what(tmp_path):
    lab = notebook(cell(WRITE_BUNDLE), front=LAB_FRONT)
    book = make_book(tmp_path, lab=lab, lecture=notebook(cell("print('seen')")))
    marker = published_marker(book)
    said: list[str] = []
    last = build(tmp_path, said)
    assert marker.read_text() != "the old site"
    assert (book / "_build/evidence/l04/cpu/manifest.json").is_file()
    assert last == [
        f"Site: {marker}",
        f"Engine: genesis-world {last[1].split()[-1]}",
        "Lesson l04: engine 1.2.3, backend requested cpu, actual cpu, render camera (llvmpipe)",
        "Pages: 2 executed, 0 reused.",
        "Checks passed: 3 on what was measured, 4 on the site.",
    ]
    stages = list(dict.fromkeys(line.split("] ")[1].split()[0] for line in said))
    assert stages == ["execute", "verify", "render", "check", "publish"]
    assert "Pages: 0 executed, 2 reused." in build(tmp_path)


def test_a_broken_page_fails_with_status_1_a_report_and_the_old_site(tmp_path):
    broken = cell("import sys\nprint('engine: last words', file=sys.stderr)\n1 / 0")
    book = make_book(tmp_path, broken=notebook(broken), good=notebook(cell("1")))
    marker = published_marker(book)
    process = command(tmp_path, JOBS="2")
    out, err = process.communicate(timeout=120)
    assert process.returncode == 1
    assert "good  executed in" in out
    assert "1 of 2 pages failed." in err
    assert "broken, code cell 1, line 10: import sys" in err
    assert "ZeroDivisionError: division by zero" in err
    assert "| engine: last words" in err
    assert marker.read_text() == "the old site"


@pytest.mark.parametrize(
    ("page", "settings", "said"),
    [
        (notebook(cell(WRITE_BUNDLE), front=LAB_FRONT), {"verify": refuse}, "metrics: metrics.js"),
        ("# Page\n\n<img src='https://example.org/a.png' alt='A picture of it'>\n", {}, "third p"),
    ],
)
def test_a_refused_bundle_or_site_leaves_the_old_site(tmp_path, page, settings, said):
    marker = published_marker(make_book(tmp_path, page=page))
    with pytest.raises(BuildError, match=said):
        build(tmp_path, **settings)
    assert marker.read_text() == "the old site"


def test_ctrl_c_ends_with_130_no_kernel_and_the_old_site(tmp_path):
    pid = tmp_path / "kernel.pid"
    code = f"import os, pathlib, time\npathlib.Path({str(pid)!r}).write_text(str(os.getpid()))\n"
    book = make_book(tmp_path, page=notebook(cell(code + "time.sleep(100)")))
    marker = published_marker(book)
    process = command(tmp_path)
    end = time.monotonic() + 60
    while not (pid.exists() and pid.read_text()):
        assert time.monotonic() < end
        assert process.poll() is None
        time.sleep(0.05)
    below = psutil.Process(process.pid).children(recursive=True)
    assert int(pid.read_text()) in {child.pid for child in below}
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Interrupted: nothing was published." in err
    assert "Traceback" not in err
    assert psutil.wait_procs(below, timeout=10)[1] == []
    assert marker.read_text() == "the old site"


@pytest.mark.parametrize(
    ("name", "value", "choices"),
    [("RENDER", "yes", "0, 1"), ("ROBO_GENESIS_BACKEND", "tpu", "auto, cpu"), ("JOBS", "0", "1")],
)
def test_invalid_settings_are_refused_with_name_value_and_choices(tmp_path, name, value, choices):
    process = command(tmp_path, **{name: value})
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert f"{name}={value!r}" in err
    assert choices in err


def test_another_installed_engine_stops_the_build_before_any_page(tmp_path, monkeypatch):
    make_book(tmp_path, page=notebook(cell("1")))
    monkeypatch.setattr("robo_genesis.project.installed_version", lambda name: "0.0.1")
    said: list[str] = []
    with pytest.raises(ProjectError, match=r"Installed is genesis-world 0\.0\.1, pinned"):
        build(tmp_path, said)
    assert said == []


def test_a_second_build_at_the_same_time_is_refused_with_the_first_one_s_process(tmp_path):
    with (
        only_build(tmp_path),
        pytest.raises(BuildError, match=rf"process {os.getpid()}\)"),
        only_build(tmp_path),
    ):
        pass
    with only_build(tmp_path):
        pass


def test_a_build_puts_the_old_site_back_that_a_kill_left_aside(tmp_path):
    book = make_book(tmp_path, page=notebook(cell("1 / 0")))
    published_marker(book)
    (book / "_build").rename(book / "_build.old")
    with pytest.raises(BuildError, match="ZeroDivisionError"):
        build(tmp_path)
    assert (book / "_build/html/index.html").read_text() == "the old site"
