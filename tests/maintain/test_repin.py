"""The steps of make repin on a made-up course: no network, no engine, pages in a moment."""

import os
import shutil
import signal
import subprocess
import sys
import time
from importlib.metadata import version
from pathlib import Path

import psutil
import pytest

from robo_genesis.core.project import ROOT, engine_pin
from robo_genesis.maintain.logged import run_logged
from robo_genesis.maintain.pin import RepinError
from robo_genesis.maintain.repin import Repin, only_repin, run_repin

OLD, NEW = engine_pin(), "99.1"
FAILS = {"resolve": "99.2", "install": "99.3", "book": "99.4", "test": "99.5"}
HANGS = "99.6"
KNOWN = ["0.1.0", OLD, NEW, *FAILS.values(), HANGS]

PROJECT = '[project]\nname = "made-up"\ndependencies = [\n    "genesis-world=={}", # the pin\n]\n'
LOCK = "# A lock.\ngenesis-world=={}\npytest==" + version("pytest") + "\n"

RESOLVE = f"""
import sys, tomllib
assert sys.argv[1:] == ["--keep"]
pin = tomllib.load(open("pyproject.toml", "rb"))["project"]["dependencies"][0].split("==")[1]
if pin == "{FAILS["resolve"]}":
    sys.exit("ERROR: no set of packages")
forced = "" if pin == "{OLD}" else "zeta==2\\n"
lock = {LOCK!r}.format(pin) + forced
open("requirements.lock", "w").write(lock)
"""

MAKEFILE = """
PIN := $(shell sed -n 's/^genesis-world==//p' requirements.lock)
.PHONY: book test
book:
\t@echo "the book says $(PIN)"; test "$(PIN)" != %(book)s
\t@test -n "$(PYTHON)" || test -f .venv/.installed
\t@mkdir -p book/_build/html
\t@echo '<p>Measured with $(PIN).</p><p>Same.</p>' > book/_build/html/index.html
\t@if test "$(PIN)" = %(hangs)s; then echo $$$$ > sleeper; exec sleep 600; fi
.venv/.installed: requirements.lock
\t@test "$(PIN)" != %(install)s
\t@mkdir -p .venv && touch .venv/.installed
test:
\t@test "$(PIN)" != %(test)s
""" % (FAILS | {"hangs": HANGS})


@pytest.fixture
def root(tmp_path) -> Path:
    """A course in a repository, in one commit."""
    root = tmp_path / "a course"
    (root / "build_scripts").mkdir(parents=True)
    (root / "book").mkdir()
    (root / "build_scripts" / "lock.py").write_text(RESOLVE)
    (root / "Makefile").write_text(MAKEFILE)
    (root / "pyproject.toml").write_text(PROJECT.format(OLD))
    (root / "requirements.lock").write_text(LOCK.format(OLD))
    (root / ".gitignore").write_text("/.cache\n/.venv\n/book/_build\n")
    (root / "book" / "index.md").write_text("committed\n")
    git(root, "init", "--quiet")
    commit(root)
    return root


def git(root: Path, *arguments: str) -> str:
    command = ["git", "-C", str(root), *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def commit(root: Path) -> None:
    git(root, "add", ".")
    git(root, "-c", "user.name=a", "-c", "user.email=a@b", "commit", "--quiet", "-m", "a")


def asked(root: Path, genesis: str, **changes) -> Repin:
    values = {"versions": lambda prereleases: KNOWN, "say": lambda line: None} | changes
    return Repin(genesis=genesis, root=root, cache=root / ".cache", **values)


def state(root: Path) -> tuple[str, str, str]:
    """Return pin, lock and everything else that git sees."""
    texts = [(root / name).read_text() for name in ("pyproject.toml", "requirements.lock")]
    return (*texts, git(root, "status", "--porcelain"))


def left(root: Path) -> list[str]:
    """Return what stands in the folder of make repin; nothing before its lock was taken."""
    assert len(git(root, "worktree", "list").splitlines()) == 1
    return sorted(path.name for path in (root / ".cache" / "repin").glob("*"))


def test_pin_and_lock_change_together_and_git_brings_both_back(root):
    before = state(root)
    lines = run_repin(asked(root, NEW))
    assert (root / "pyproject.toml").read_text() == PROJECT.format(NEW)
    assert (root / "requirements.lock").read_text() == LOCK.format(NEW) + "zeta==2\n"
    assert git(root, "status", "--porcelain") == " M pyproject.toml\n M requirements.lock\n"
    assert f"genesis-world {OLD} → {NEW}" in lines[0]
    assert "Nothing is committed" in lines[0]
    assert left(root) == ["lock", "logs"]
    assert not (root / "book" / "_build").exists()
    undo = lines[-1].removesuffix(" brings the old pin back.").split()
    assert undo == ["git", "restore", "pyproject.toml", "requirements.lock"]
    git(root, *undo[1:])
    assert state(root) == before


@pytest.mark.parametrize("name", ["book/index.md", "new.txt"])
def test_a_changed_or_new_file_is_refused_by_name_before_anything_runs(root, name):
    (root / name).write_text("mine\n")
    before = state(root)
    with pytest.raises(
        RepinError, match=rf"1 changed or new files \({name}\)\. .*: commit or stash"
    ):
        run_repin(asked(root, NEW))
    assert state(root) == before
    assert left(root) == []


def test_the_report_names_packages_and_the_sentence_that_moved(root):
    run_repin(asked(root, NEW))
    folder = root / ".cache" / "reports" / f"repin-{OLD}-{NEW}"
    text = (folder / "report.md").read_text()
    assert f"| genesis-world | {OLD} | {NEW} |" in text
    assert "| zeta |  | 2 |" in text
    assert f"| Measured with {OLD}. | Measured with {NEW}. |" in text
    assert "Same." not in text
    assert f"<td>Measured with {NEW}.</td>" in (folder / "report.html").read_text()


def test_there_and_back_restores_every_byte(root, monkeypatch):
    before = state(root)
    run_repin(asked(root, NEW))
    commit(root)
    monkeypatch.setattr("robo_genesis.maintain.repin.require_locked_packages", lambda root: None)
    run_repin(asked(root, OLD))
    assert state(root)[:2] == before[:2]


@pytest.mark.parametrize("stage", FAILS)
def test_a_step_that_fails_leaves_the_tree_as_it_was_and_names_its_log(root, stage):
    before = state(root)
    with pytest.raises(RepinError, match=f"{stage} .* failed") as caught:
        run_repin(asked(root, FAILS[stage]))
    message = str(caught.value)
    assert f"still pins {OLD}" in message
    (log,) = (line.removeprefix("Log: ") for line in message.split("\n") if "Log: " in line)
    assert Path(log).is_file()
    if stage == "resolve":
        assert "ERROR: no set of packages" in message
    if stage == "book":
        assert f"the book says {FAILS[stage]}" in message
    assert state(root) == before
    assert left(root) == ["lock", "logs"]


@pytest.mark.parametrize(
    ("genesis", "says"),
    [
        ("", r"GENESIS is not given\. Usage: make repin GENESIS="),
        ("newest", r"GENESIS='newest' is not a version\. Usage"),
        (OLD, r"is the pin already"),
        (f"v{OLD}.0", r"is the pin already"),
    ],
)
def test_a_wrong_wish_is_refused_before_anything_is_asked_or_copied(root, genesis, says):
    before = state(root)
    with pytest.raises(RepinError, match=says):
        run_repin(asked(root, genesis, versions=None))
    assert state(root) == before
    assert left(root) == []


def test_a_version_that_is_not_there_is_refused_with_those_there_are(root):
    before = state(root)
    with pytest.raises(RepinError, match=r"no genesis-world 9\.9\.9 .*: 99\.6, 99\.5, .* one of"):
        run_repin(asked(root, "9.9.9"))
    assert state(root) == before
    assert left(root) == []


def test_an_environment_that_is_not_the_locked_one_is_refused(root):
    (root / "requirements.lock").write_text(LOCK.format(OLD) + "pip==0.1\n")
    commit(root)
    with pytest.raises(RepinError, match=r"does not hold .*: pip \S+ instead of 0\.1\. Install"):
        run_repin(asked(root, NEW))
    assert left(root) == []


def test_two_at_once_are_refused(root):
    with (
        only_repin(root / ".cache" / "repin"),
        pytest.raises(RepinError, match=rf"Another make repin runs here \(process {os.getpid()}\)"),
    ):
        run_repin(asked(root, NEW))


def test_a_pin_that_is_edited_meanwhile_is_kept(root):
    mine = PROJECT.format(OLD) + "# mine\n"

    def edit_during_the_tests(line: str) -> None:
        if "] test " in line:
            (root / "pyproject.toml").write_text(mine)

    with pytest.raises(RepinError, match=r"pyproject\.toml .* changed while .* again"):
        run_repin(asked(root, NEW, say=edit_during_the_tests))
    assert (root / "pyproject.toml").read_text() == mine
    assert (root / "requirements.lock").read_text() == LOCK.format(OLD)


def test_a_checkout_that_is_no_repository_is_refused(root):
    shutil.rmtree(root / ".git")
    with pytest.raises(RepinError, match=r"is no git checkout: .* clone the repository"):
        run_repin(asked(root, NEW))
    assert (root / "pyproject.toml").read_text() == PROJECT.format(OLD)


def test_a_worktree_whose_making_was_killed_is_removed_first(root):
    work = root / ".cache" / "repin" / "work"
    git(root, "worktree", "add", "--detach", "--lock", str(work), "HEAD")
    run_repin(asked(root, NEW))
    assert left(root) == ["lock", "logs"]


def test_a_command_gets_no_variable_that_was_meant_for_the_outer_make(tmp_path, monkeypatch):
    meant = {"RELEASE", "BUNDLE", "GENESIS", "PYTHON", "MAKEFLAGS"}
    for name in (*meant, "JOBS"):
        monkeypatch.setenv(name, "given")
    assert run_logged(["env"], tmp_path, tmp_path / "log") == 0
    found = {line.partition("=")[0] for line in (tmp_path / "log").read_text().splitlines()}
    assert "JOBS" in found
    assert not found & meant


@pytest.mark.parametrize("name", ["pyproject.toml", "requirements.lock"])
def test_a_linked_file_of_the_pin_is_refused_and_what_it_leads_to_is_kept(root, tmp_path, name):
    elsewhere = (root / name).rename(tmp_path / name)
    (root / name).symlink_to(elsewhere)
    text = elsewhere.read_bytes()
    with pytest.raises(RepinError, match=rf"^{name} in .*: a link, expected the file itself.*"):
        run_repin(asked(root, NEW))
    assert elsewhere.read_bytes() == text
    assert left(root) == []


def test_the_command_refuses_without_a_traceback():
    before = [(ROOT / name).read_bytes() for name in ("pyproject.toml", "requirements.lock")]
    command = [sys.executable, str(ROOT / "build_scripts" / "repin.py")]
    environment = os.environ | {"PYTHONPATH": str(ROOT), "GENESIS": OLD}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stderr == (
        f"\nGENESIS={OLD} is the pin already. Give another version.\n\n"
        "FAILED: nothing was changed.\n"
    )
    after = [(ROOT / name).read_bytes() for name in ("pyproject.toml", "requirements.lock")]
    assert after == before


RUN = """
import sys
from pathlib import Path
from robo_genesis.build.command import run
from robo_genesis.maintain.pin import RepinError
from robo_genesis.maintain.repin import Repin, run_repin
root = Path(sys.argv[1])
asked = Repin(sys.argv[2], root, root / ".cache", lambda prereleases: [sys.argv[2]])
sys.exit(run(lambda: run_repin(asked), "changed", (RepinError,)))
"""


@pytest.mark.parametrize(
    ("sent", "status"),
    [(signal.SIGINT, 130), (signal.SIGTERM, 130), (signal.SIGKILL, -signal.SIGKILL)],
)
def test_an_end_by_signal_takes_the_children_along_and_the_next_one_works(root, sent, status):
    before, sleeper = state(root), root / ".cache" / "repin" / "work" / "sleeper"
    process = subprocess.Popen([sys.executable, "-c", RUN, str(root), HANGS], cwd=ROOT)
    while not (sleeper.exists() and sleeper.read_text().strip()):
        assert process.poll() is None
        time.sleep(0.05)
    child = psutil.Process(int(sleeper.read_text()))
    process.send_signal(sent)
    assert process.wait() == status
    assert not psutil.wait_procs([child], timeout=30)[1]
    assert state(root) == before
    run_repin(asked(root, NEW))
    assert (root / "pyproject.toml").read_text() == PROJECT.format(NEW)
    assert left(root) == ["lock", "logs"]
