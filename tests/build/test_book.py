import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import psutil
import pytest
from tiny_book import (
    LAB_FRONT,
    WRITE_BUNDLE,
    cell,
    make_book,
    notebook,
    published_marker,
    raising,
)

from robo_genesis.build.execute_one import execute_one
from robo_genesis.build.stages import Build, BuildError, only_build, run_build
from robo_genesis.core.project import ROOT, ProjectError, page_cache_folder
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.lessons.book_pages import PageError, find_pages, fingerprint

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


def command(folder: Path, *more: str, **environment: str) -> subprocess.Popen[str]:
    """Start `make book`'s command on a tiny book, with more arguments and variables."""
    arguments = ["--book", str(folder / "book"), "--cache", str(folder / "cache")]
    return subprocess.Popen(
        [sys.executable, str(SCRIPT), *arguments, *more],
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
    assert stages == ["execute", "verify", "render", "pack", "check", "publish"]
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


SLOW = notebook(cell("import time\ntime.sleep(60)"), front="execution: {timeout: 1}\n")


@pytest.mark.parametrize(
    ("page", "said"),
    [
        (notebook(cell("raise KeyError('kp')")), "KeyError: 'kp'"),
        (notebook(cell("import os\nos._exit(3)")), "DeadKernelError: Kernel died"),
        (SLOW, "CellTimeoutError: A cell timed out"),
        (notebook(raising("1 + 1", "ValueError: no")), "expected was 'ValueError: no'"),
    ],
    ids=["raising cell", "dead kernel", "timeout", "exception that does not come"],
)
def test_a_failed_page_is_status_1_its_report_and_the_old_site(tmp_path, page, said):
    marker = published_marker(make_book(tmp_path, page=page))
    process = command(tmp_path)
    _, err = process.communicate(timeout=120)
    assert process.returncode == 1
    assert "page, code cell 1, line " in err
    assert said in err
    assert marker.read_text() == "the old site"


def test_a_book_without_camera_is_published(tmp_path):
    asked = "import os\nprint('render', os.environ['ROBO_GENESIS_RENDER'])"
    book = make_book(tmp_path, page=notebook(cell(asked)))
    process = command(tmp_path, RENDER="0")
    _, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    assert "render 0" in (book / "_build/html/page.html").read_text()


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("ROBO_GENESIS_RENDER", "0", "render.mode is 'camera', this build asked for 'skip'"),
        ("ROBO_GENESIS_BACKEND", "auto", "requested is 'cpu', this build asked for 'auto'"),
    ],
)
def test_a_bundle_of_another_kind_of_run_is_refused(tmp_path, monkeypatch, name, value, said):
    make_book(tmp_path, lab=notebook(cell(WRITE_BUNDLE), front=LAB_FRONT))
    monkeypatch.setenv(name, value)
    with pytest.raises(BuildError, match=said):
        build(tmp_path)


def test_a_build_removes_stale_kernel_locks_before_it_reads_a_page(tmp_path):
    stale = tmp_path / "cache/engine/1-a/kernels/qdcache.lock"
    stale.parent.mkdir(parents=True)
    stale.touch()
    (make_book(tmp_path) / "_toc.yml").unlink()
    with pytest.raises(PageError):
        build(tmp_path)
    assert not stale.exists()


def test_a_build_forgets_page_caches_of_long_ago(tmp_path):
    make_book(tmp_path, text="# Text\n\nNo cells.\n")
    old = [tmp_path / "cache/pages" / name for name in "abcde"]
    for folder in old:
        folder.mkdir(parents=True)
    build(tmp_path)
    assert sum(folder.exists() for folder in old) == 3


def test_a_wrong_address_of_the_site_stops_before_any_page(tmp_path):
    make_book(tmp_path, page=notebook(cell("1")))
    said, error = command(tmp_path, SITE_URL="example.org/course").communicate()
    assert "SITE_URL is 'example.org/course'; valid is an address like https://" in error
    assert "FAILED: nothing was published." in error
    assert "execute" not in said


def test_a_cache_that_cannot_be_written_is_status_1_and_named(tmp_path, no_file):
    make_book(tmp_path)
    process = command(tmp_path, "--cache", str(no_file))
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert f"Not a directory: '{no_file}" in err
    assert "free space or write access" in err
    assert "Traceback" not in err


@pytest.mark.parametrize(
    "spoil",
    [Path.mkdir, lambda database: database.symlink_to("no folder/global.db")],
    ids=["unreadable", "cannot be created"],
)
def test_a_cache_of_pages_that_cannot_be_used_is_status_1_and_named(tmp_path, spoil):
    pages = find_pages(make_book(tmp_path, page=notebook(cell("1"))))
    folder = page_cache_folder(fingerprint(pages), tmp_path / "cache")
    (folder / "notebooks").mkdir(parents=True)
    spoil(folder / "notebooks" / "global.db")
    process = command(tmp_path)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert f"in {folder} cannot be kept" in err
    assert "unable to open database file" in err
    assert "free space or write access" in err
    assert "Traceback" not in err


@pytest.mark.parametrize(
    ("page", "settings", "said"),
    [
        (notebook(cell(WRITE_BUNDLE), front=LAB_FRONT), {"verify": refuse}, "metrics: metrics.js"),
        ("# Page\n\n<script src='https://example.org/a.js'></script>\n", {}, "third p"),
    ],
)
def test_a_refused_bundle_or_site_leaves_the_old_site(tmp_path, page, settings, said):
    marker = published_marker(make_book(tmp_path, page=page))
    with pytest.raises(BuildError, match=said):
        build(tmp_path, **settings)
    assert marker.read_text() == "the old site"


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_and_cancelling_end_with_130_no_kernel_and_the_old_site(tmp_path, sent):
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
    process.send_signal(sent)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Interrupted: nothing was published." in err
    assert "Traceback" not in err
    assert psutil.wait_procs(below, timeout=10)[1] == []
    assert marker.read_text() == "the old site"


@pytest.mark.parametrize(
    ("name", "value", "choices"),
    [
        ("RENDER", "yes", "0, 1"),
        ("ROBO_GENESIS_BACKEND", "auto", "accelerators are recorded apart. Unset it. Choices: cpu"),
        ("JOBS", "0", "1"),
        ("RELEASE", "yes", "0, 1"),
    ],
)
def test_invalid_settings_are_refused_with_name_value_and_choices(tmp_path, name, value, choices):
    process = command(tmp_path, **{name: value})
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert f"{name}={value!r}" in err
    assert choices in err


def test_a_release_without_camera_frames_is_refused(tmp_path):
    process = command(tmp_path, RELEASE="1", RENDER="0")
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert "RENDER='0' is not valid with RELEASE=1" in err


def test_a_release_from_a_changed_tree_stops_before_any_page(tmp_path, monkeypatch):
    marker = published_marker(make_book(tmp_path, page=notebook(cell("1"))))
    monkeypatch.setattr(
        "robo_genesis.build.stages.unclean", lambda root: ["The tree has 1 changed file"]
    )
    said: list[str] = []
    with pytest.raises(BuildError, match=r"RELEASE=1 cannot be met\.\nThe tree has 1 changed file"):
        build(tmp_path, said, release=True)
    assert said == []
    assert marker.read_text() == "the old site"


def test_a_release_that_lacks_evidence_leaves_the_old_site(tmp_path, monkeypatch):
    marker = published_marker(make_book(tmp_path, page=notebook(cell("1"))))
    monkeypatch.setattr("robo_genesis.build.stages.unclean", lambda root: [])
    monkeypatch.setattr(
        "robo_genesis.build.stages.lacking", lambda *given: ["l04 requires evidence"]
    )
    with pytest.raises(BuildError, match="l04 requires evidence"):
        build(tmp_path, release=True)
    assert marker.read_text() == "the old site"


def test_a_release_executes_what_an_ordinary_build_would_reuse(tmp_path, monkeypatch):
    make_book(tmp_path, page=notebook(cell("1")))
    monkeypatch.setattr("robo_genesis.build.stages.unclean", lambda root: [])
    build(tmp_path)
    assert "Pages: 0 executed, 1 reused." in build(tmp_path)
    assert "Pages: 1 executed, 0 reused." in build(tmp_path, release=True)


def test_pages_from_elsewhere_are_built_without_a_run(tmp_path):
    lab = notebook(cell(WRITE_BUNDLE), front=LAB_FRONT)
    there, here = (make_book(tmp_path / name, lab=lab).parent for name in ("there", "here"))
    execute_one("lab", tmp_path / "executed", Build(book=there / "book", cache=there / "cache"))
    said: list[str] = []
    last = build(here, said, executed=tmp_path / "executed")
    assert "Pages: 0 executed, 1 reused." in last
    assert (here / "book/_build/evidence/l04/cpu/manifest.json").is_file()
    assert any("handover lab  run " in line for line in said)


def test_pages_from_elsewhere_that_are_not_all_there_leave_the_old_site(tmp_path):
    marker = published_marker(make_book(tmp_path, page=notebook(cell("1"))))
    build(tmp_path)
    marker.write_text("the old site")
    (tmp_path / "executed").mkdir()
    process = command(tmp_path, EXECUTED=str(tmp_path / "executed"))
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert "page is not among them. Execute the page again" in err
    assert "FAILED: nothing was published." in err
    assert marker.read_text() == "the old site"


def test_a_release_takes_no_pages_from_elsewhere(tmp_path):
    process = command(tmp_path, RELEASE="1", EXECUTED="executed")
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert "EXECUTED='executed' is not valid with RELEASE=1" in err


def test_another_installed_engine_stops_the_build_before_any_page(tmp_path, monkeypatch):
    make_book(tmp_path, page=notebook(cell("1")))
    monkeypatch.setattr("robo_genesis.core.project.installed_version", lambda name: "0.0.1")
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
