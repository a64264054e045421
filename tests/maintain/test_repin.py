"""The steps of make repin on a made-up course: no network, no engine, pages in a moment."""

import re
import signal
import subprocess
import sys
from pathlib import Path

import psutil
import pytest
from tiny_book import commit, git, wait

from robo_genesis.core.project import ROOT, ProjectError, engine_pin
from robo_genesis.maintain import repin
from robo_genesis.maintain.repin import run_logged, run_repin

OLD, NEW = engine_pin(), "99.1"
FAILS = {"resolve": "99.2", "install": "99.3", "book": "99.4", "test": "99.5"}
HANGS = "99.6"

PROJECT = '[project]\nname = "made-up"\ndependencies = [\n    "genesis-world=={}", # the pin\n]\n'
LOCK = "# A lock.\ngenesis-world=={}\n"

MAKEFILE = """
PIN := $(shell sed -n 's/^genesis-world==//p' requirements.lock)
.PHONY: book test
book:
\t@echo "[    1.0 s] execute  2 pages"
\t@test "$(PIN)" != %(book)s || { cat failed; echo '  no rise'; false; }
\t@test -n "$(PYTHON)" || test -f .venv/.installed
\t@mkdir -p book/_build/html
\t@echo '<p>Measured: 7$(PIN) m.</p><p>Same.</p>' > book/_build/html/index.html
\t@if test "$(PIN)" = %(hangs)s; then echo $$$$ > sleeper; exec sleep 600; fi
.venv/.installed: requirements.lock
\t@test "$(PIN)" != %(install)s
\t@mkdir -p .venv && touch .venv/.installed
test:
\t@test "$(PIN)" != %(test)s || { cat failed; false; }
""" % (FAILS | {"hangs": HANGS})

FAILED = """\
[    2.0 s] execute  lab  failed in 1 s: CheckFailed: [rise] 7 m, expected 6 m
[    3.0 s] execute  deeper  refused: contact: a.npz: 0.0, expected 1.2e-05
"""
ROWS = [
    "| lab | failed | CheckFailed: [rise] 7 m, expected 6 m |",
    "| deeper | refused | contact: a.npz: 0.0, expected 1.2e-05 |",
]


def write_lock(root: Path) -> None:
    """Resolve the made-up course."""
    pin = engine_pin(root)
    if pin == FAILS["resolve"]:
        raise ProjectError("no set of packages")
    (root / "requirements.lock").write_text(LOCK.format(pin))


@pytest.fixture
def root(tmp_path, monkeypatch) -> Path:
    """A course in a repository, in one commit."""
    monkeypatch.setattr(repin, "write_lock", write_lock)
    root = tmp_path / "a course"
    (root / "book").mkdir(parents=True)
    (root / "Makefile").write_text(MAKEFILE)
    (root / "pyproject.toml").write_text(PROJECT.format(OLD))
    (root / "requirements.lock").write_text(LOCK.format(OLD))
    (root / "failed").write_text(FAILED)
    (root / ".gitignore").write_text("/.cache\n/.venv\n/book/_build\n")
    (root / "book" / "index.md").write_text("# Committed\n")
    (root / "book" / "_toc.yml").write_text("format: jb-book\nroot: index\n")
    commit(root)
    return root


def run(root: Path, genesis: str, say=lambda line: None) -> list[str]:
    return run_repin(genesis, root, root / ".cache", say)


def pin_of(root: Path) -> tuple[str, str]:
    """Return pin and lock."""
    names = ("pyproject.toml", "requirements.lock")
    first, second = ((root / name).read_text() for name in names)
    return first, second


def test_pin_and_lock_change_together_with_a_report_and_git_restores_both(root):
    lines = run(root, f"v{NEW}")
    assert pin_of(root) == (PROJECT.format(NEW), LOCK.format(NEW))
    changed = git(root, "status", "--porcelain")
    assert changed == " M pyproject.toml\n M requirements.lock\n"
    assert f"genesis-world {OLD} → {NEW}" in lines[0]
    assert not (root / ".cache" / "repin" / "work").exists()
    assert not (root / "book" / "_build").exists()
    report = root / ".cache" / "reports" / f"repin-{OLD}-{NEW}" / "report.md"
    assert f"| Measured: 7{OLD} m. | Measured: 7{NEW} m. |" in report.read_text()
    undo = lines[-1].removesuffix(" restores the old pin.").split()
    git(root, *undo[1:])
    assert pin_of(root) == (PROJECT.format(OLD), LOCK.format(OLD))


@pytest.mark.parametrize("stage", [*FAILS])
def test_a_step_that_fails_ends_with_a_report_and_leaves_the_tree(root, stage):
    with pytest.raises(ProjectError) as caught:
        run(root, FAILS[stage])
    assert git(root, "status", "--porcelain") == ""
    if stage == "resolve":
        assert str(caught.value) == "no set of packages"
        return
    log, report = re.findall("^(?:Log|Report): (.*)$", str(caught.value), re.MULTILINE)
    assert Path(log).is_file()
    text = Path(report).read_text().replace("\\", "")
    assert f"The checkout still pins {OLD}." in text
    rows = re.findall(r"^\| (?:lab|deeper) \|.*", text, re.MULTILINE)
    assert rows == (ROWS if stage == "book" else [])  # the tests print pages of others
    assert ("no rise" in str(caught.value)) == (stage == "book")
    run(root, NEW)  # the worktree that was left is replaced


@pytest.mark.parametrize("given", ["", OLD, f"v{OLD}"])
def test_no_other_version_is_refused(root, given):
    with pytest.raises(ProjectError, match=rf"another version than the pin, {OLD}"):
        run(root, given)


def test_changes_are_refused_before_anything_runs(root):
    (root / "new.txt").touch()
    with pytest.raises(ProjectError, match=r"1 changed or new files \(new.txt\)"):
        run(root, NEW)


def test_a_command_gets_no_variable_that_was_meant_for_the_outer_make(
    tmp_path, monkeypatch
):
    meant = {"RELEASE", "GENESIS", "PYTHON", "MAKEFLAGS"}
    for name in (*meant, "JOBS"):
        monkeypatch.setenv(name, "given")
    assert run_logged(["env"], tmp_path, tmp_path / "log") == 0
    lines = (tmp_path / "log").read_text().splitlines()
    variables = {line.partition("=")[0] for line in lines}
    assert "JOBS" in variables
    assert not variables & meant


RUN = f"""
import sys
from pathlib import Path
from robo_genesis.maintain import repin
from robo_genesis.pipeline.command import run
def write_lock(root):
    (root / "requirements.lock").write_text({LOCK.format(HANGS)!r})
repin.write_lock = write_lock
root = Path(sys.argv[1])
sys.exit(run(lambda: repin.run_repin({HANGS!r}, root, root / ".cache"), "changed"))
"""


@pytest.mark.parametrize(
    ("sent", "status"), [(signal.SIGTERM, 130), (signal.SIGKILL, -9)]
)
def test_an_end_by_signal_takes_the_children_along_and_the_next_one_works(
    root, sent, status
):
    sleeper = root / ".cache" / "repin" / "work" / "sleeper"
    process = subprocess.Popen([sys.executable, "-c", RUN, str(root)], cwd=ROOT)
    wait(process, sleeper)
    child = psutil.Process(int(sleeper.read_text()))
    process.send_signal(sent)
    assert process.wait() == status
    assert not psutil.wait_procs([child], timeout=30)[1]
    assert pin_of(root) == (PROJECT.format(OLD), LOCK.format(OLD))
    run(root, NEW)
    assert pin_of(root) == (PROJECT.format(NEW), LOCK.format(NEW))
