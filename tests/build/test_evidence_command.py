"""What `make evidence` answers: exit status, what is printed, and the real lab on the CPU."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest
from tiny_book import LAB_FRONT, cell, make_book, notebook

from robo_genesis.core.project import CACHE, ROOT
from robo_genesis.evidence.bundle import evidence_key
from robo_genesis.evidence.verify import verify_bundle

SCRIPT = ROOT / "build_scripts" / "evidence.py"


def command(*arguments: str, **environment: str) -> subprocess.Popen[str]:
    """Start the command with these arguments and variables; none of the caller's own names."""
    names = ("LESSON", "BACKEND", "TO", "RENDER")
    kept = {name: value for name, value in os.environ.items() if name not in names}
    return subprocess.Popen(
        [sys.executable, str(SCRIPT), *arguments],
        env={**kept, "PYTHONPATH": str(ROOT), **environment},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def tiny(folder: Path, code: str, **environment: str) -> subprocess.Popen[str]:
    """Start the command on a tiny book whose lab has one cell."""
    book = make_book(folder, lab=notebook(cell(code), front=LAB_FRONT))
    arguments = ["--book", str(book), "--cache", str(folder / "cache")]
    asked = {"LESSON": "l04", "BACKEND": "cpu", "TO": str(folder / "kept")}
    return command(*arguments, **{**asked, **environment})


@pytest.fixture
def old(tmp_path):
    """A file of a bundle that was recorded before."""
    place = tmp_path / "kept" / "l04" / "cpu"
    place.mkdir(parents=True)
    (place / "manifest.json").write_text("the old one")
    return place / "manifest.json"


def test_make_hands_the_settings_over(tmp_path):
    (tmp_path / "build_scripts").mkdir()
    shutil.copy(ROOT / "Makefile", tmp_path)
    stub = "import os\nprint([os.environ.get(name) for name in ('LESSON', 'BACKEND', 'TO')])\n"
    (tmp_path / "build_scripts" / "evidence.py").write_text(stub)
    settings = ["LESSON=l04", "BACKEND=amdgpu", "TO=a folder", f"PYTHON={sys.executable}"]
    make = ["make", "-C", str(tmp_path), "evidence", *settings]
    done = subprocess.run(make, capture_output=True, text=True, check=False, timeout=60)
    assert "['l04', 'amdgpu', 'a folder']" in done.stdout.splitlines(), done.stderr


def test_a_failing_lab_is_status_1_a_report_and_the_old_bundle(tmp_path, old):
    process = tiny(tmp_path, "1 / 0")
    _, err = process.communicate(timeout=120)
    assert process.returncode == 1
    assert "lab, code cell 1, line " in err
    assert "ZeroDivisionError: division by zero" in err
    assert err.endswith("FAILED: nothing was recorded.\n")
    assert old.read_text() == "the old one"


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("LESSON", "l99", "Lessons with a lab: l04."),
        ("BACKEND", "gpu", "Choices: amdgpu, cuda, cpu"),
        ("RENDER", "0", "always has camera frames. Unset it. Choices: 1."),
    ],
)
def test_invalid_settings_are_refused_with_name_value_and_choices(tmp_path, name, value, said):
    process = tiny(tmp_path, "1", **{name: value})
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert f"{name}={value!r} is not valid" in err
    assert said in err
    assert "Traceback" not in err


def test_a_cache_that_cannot_be_written_is_status_1_and_named(tmp_path, no_file):
    process = command("--cache", str(no_file), LESSON="l04", BACKEND="cpu", TO=str(tmp_path))
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert f"Not a directory: '{no_file}" in err
    assert "Traceback" not in err


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_and_cancelling_end_with_130_no_kernel_and_the_old_bundle(tmp_path, old, sent):
    pid = tmp_path / "kernel.pid"
    code = f"import os, pathlib, time\npathlib.Path({str(pid)!r}).write_text(str(os.getpid()))\n"
    process = tiny(tmp_path, code + "time.sleep(100)")
    end = time.monotonic() + 60
    while not (pid.exists() and pid.read_text()):
        assert time.monotonic() < end
        assert process.poll() is None
        time.sleep(0.05)
    below = psutil.Process(process.pid).children(recursive=True)
    process.send_signal(sent)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Interrupted: nothing was recorded." in err
    assert "Traceback" not in err
    assert psutil.wait_procs(below, timeout=10)[1] == []
    assert old.read_text() == "the old one"


@pytest.mark.engine
def test_the_real_lab_recorded_on_the_cpu_is_accepted_evidence(tmp_path):
    cache, kept = tmp_path / "cache", tmp_path / "kept"
    (CACHE / "engine").mkdir(parents=True, exist_ok=True)
    cache.mkdir()
    (cache / "engine").symlink_to(CACHE / "engine")  # compiled kernels, no executed page
    process = command("--cache", str(cache), LESSON="l04", BACKEND="cpu", TO=str(kept))
    out, err = process.communicate()
    assert process.returncode == 0, err
    place = kept / "l04" / "cpu"
    facts = verify_bundle(place).predicate
    assert [path.name for path in kept.iterdir()] == ["l04"]
    assert facts.command == "make evidence"
    assert facts.render.mode == "camera"
    assert facts.evidence_key == evidence_key(facts.model_dump())
    assert f"Recorded: {place}\nBackend: requested cpu, actual cpu, device " in out
    assert f"Checks passed: {len(facts.checks)} of {len(facts.checks)}." in out
