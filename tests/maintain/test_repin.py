"""The steps of make repin on a made-up course: no network, no engine, pages in a moment."""

import os
import re
import signal
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import psutil
import pytest
from tiny_book import commit, fails, git, wait

from robo_genesis.core.files import locked
from robo_genesis.core.project import ROOT, ProjectError, engine_pin
from robo_genesis.maintain.repin import run_logged, run_repin

OLD, NEW = engine_pin(), "99.1"
FAILS = {"resolve": "99.2", "install": "99.3", "book": "99.4", "test": "99.5"}
HANGS = "99.6"

PROJECT = '[project]\nname = "made-up"\ndependencies = [\n    "genesis-world=={}", # the pin\n]\n'
LOCK = "# A lock.\ngenesis-world=={}\npytest==" + version("pytest") + "\n"

RESOLVE = f"""
import sys, tomllib
assert sys.argv[1:] == ["--keep"]
pin = tomllib.load(open("pyproject.toml", "rb"))["project"]["dependencies"][0].split("==")[1]
if pin == "{FAILS["resolve"]}":
    sys.exit("ERROR: no set of packages")
forced = "" if pin == "{OLD}" else "zeta==2\\n"
spelled = "{NEW}" if pin == "{NEW}.0" else pin
lock = {LOCK!r}.format(spelled) + forced
open("requirements.lock", "w").write(lock)
"""

MAKEFILE = """
NAMED := timeout 20 sh -c 'until test -f named; do sleep 0.1; done'
PIN := $(shell sed -n 's/^genesis-world==//p' requirements.lock)
.PHONY: book test
book:
\t@echo "[    1.0 s] execute  2 pages"
\t@test "$(PIN)" != %(book)s || { cat failed; $(NAMED) && \\
\t  printf 'lab, code cell 3, line 7: rise()\\n  no rise'; false; }
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
[    2.0 s] execute  lecture  failed in 1 s: AttributeError: no add_entity
[    3.0 s] execute  deeper  refused: contact: a.npz: 0.0, expected 1.2e-05
"""
ROWS = [
    "| page | result | reason | rule or engine? |",
    "| lab | failed | CheckFailed: [rise] 7 m, expected 6 m | Rule, if the run",
    "| lecture | failed | AttributeError: no add_entity | Engine, if its",
    "| deeper | refused | contact: a.npz: 0.0, expected 1.2e-05 | Rule, if the run",
]


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
    (root / "failed").write_text(FAILED)
    (root / ".gitignore").write_text("/.cache\n/.venv\n/book/_build\n")
    (root / "book" / "index.md").write_text("committed\n")
    (root / "book" / "_toc.yml").write_text("format: jb-book\nroot: index\n")
    commit(root)
    return root


def repin(root: Path, genesis: str, **changes) -> list[str]:
    return run_repin(
        genesis, root, root / ".cache", **{"say": lambda line: None} | changes
    )


def state(root: Path) -> tuple[str, str, str]:
    """Return pin, lock and everything else that git sees."""
    texts = [
        (root / name).read_text() for name in ("pyproject.toml", "requirements.lock")
    ]
    return (*texts, git(root, "status", "--porcelain"))


def left(root: Path) -> list[str]:
    """Return what stands in the folder of make repin; nothing before its lock was taken."""
    return sorted(path.name for path in (root / ".cache" / "repin").glob("*"))


def test_pin_and_lock_change_together_with_a_report_and_git_restores_both(root):
    lines = repin(root, f"v{NEW}.0")  # the index spells it NEW
    assert (root / "pyproject.toml").read_text() == PROJECT.format(NEW)
    assert (root / "requirements.lock").read_text() == LOCK.format(NEW) + "zeta==2\n"
    assert (
        git(root, "status", "--porcelain")
        == " M pyproject.toml\n M requirements.lock\n"
    )
    assert f"genesis-world {OLD} → {NEW}" in lines[0]
    assert left(root) == ["lock", "logs"]
    assert not (root / "book" / "_build").exists()
    text = (
        root / ".cache" / "reports" / f"repin-{OLD}-{NEW}" / "report.md"
    ).read_text()
    for row in (f"| genesis-world | {OLD} | {NEW} |", "| zeta |  | 2 |"):
        assert row in text
    assert f"| Measured: 7{OLD} m. | Measured: 7{NEW} m. |" in text
    undo = lines[-1].removesuffix(" restores the old pin.").split()
    git(root, *undo[1:])
    assert state(root)[2] == ""


@pytest.mark.parametrize(
    ("stage", "why", "packages"),
    [
        ("resolve", "ERROR: no set of packages", "Nothing was found here"),
        ("install", "Error 1", "| zeta |  | 2 |"),
        ("book", "lab, code cell 3, line 7: rise()", "| zeta |  | 2 |"),
        ("test", "Error 1", "| zeta |  | 2 |"),
    ],
)
def test_a_step_that_fails_ends_with_a_report_and_leaves_the_tree(
    root, stage, why, packages
):
    before, named = (
        state(root),
        root / ".cache" / "repin" / "work" / "checkout" / "named",
    )
    with pytest.raises(
        ProjectError
    ) as caught:  # the build ends when each page was named
        repin(
            root,
            FAILS[stage],
            say=lambda line: "deeper  refused: " in line and named.touch(),
        )
    message = str(caught.value)
    remedy = f"The checkout still pins {OLD}. Give another version, or change what failed so that"
    places = re.findall("^(?:Log|Report): (.*)$", message, re.MULTILINE)
    assert Path(places[1]).name == "report.md"
    text = Path(places[1]).read_text().replace("\\", "")
    for said in (f"Failed: {stage} ", remedy, why):
        assert said in message
        assert said in text
    assert packages in text
    assert "execute  2 pages" not in text
    table = re.findall(
        r"^\| \w.*", text, re.MULTILINE
    )  # the tests print pages of other books
    found = [line[: len(row)] for line, row in zip(table, ROWS, strict=False)]
    assert (found == ROWS, "CheckFailed" in text) == (stage == "book", stage == "book")
    assert state(root) == before
    assert left(root) == ["lock", "logs"]


def commit_another_lock(root: Path) -> None:
    (root / "requirements.lock").write_text("pip==0.1\n")
    commit(root)


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        (
            lambda root: (root / "new.txt").touch(),
            r"1 changed or new files \(new.txt\)\. .*: commit or stash",
        ),
        (commit_another_lock, r"differs from .*: pip \S+ instead of 0\.1\. Install"),
        (
            lambda root: (root / ".git").rename(root.parent / ".git.away"),
            r"is not a git checkout: .* clone the repository",
        ),
    ],
)
def test_what_cannot_be_tried_is_refused_before_anything_runs(root, spoil, says):
    spoil(root)
    with pytest.raises(ProjectError, match=says):
        repin(root, NEW)
    assert (root / "pyproject.toml").read_text() == PROJECT.format(OLD)
    assert not (root / ".cache" / "repin").exists()


def test_two_at_once_are_refused(root):
    with (
        locked(root / ".cache" / "repin" / "lock", "Another"),
        pytest.raises(
            ProjectError, match=rf"make repin runs here \(process {os.getpid()}\)"
        ),
    ):
        repin(root, NEW)


def test_a_pin_that_is_edited_meanwhile_is_kept(root):
    mine = PROJECT.format(OLD) + "# mine\n"

    def edit_during_the_tests(line: str) -> None:
        if "] test " in line:
            (root / "pyproject.toml").write_text(mine)

    with pytest.raises(
        ProjectError, match=r"pyproject\.toml .* changed while .* again"
    ):
        repin(root, NEW, say=edit_during_the_tests)
    assert (root / "pyproject.toml").read_text() == mine
    assert (root / "requirements.lock").read_text() == LOCK.format(OLD)


def test_a_command_gets_no_variable_that_was_meant_for_the_outer_make(
    tmp_path, monkeypatch
):
    meant = {"RELEASE", "BUNDLE", "GENESIS", "PYTHON", "MAKEFLAGS"}
    for name in (*meant, "JOBS"):
        monkeypatch.setenv(name, "given")
    assert run_logged(["env"], tmp_path, tmp_path / "log") == 0
    found = {
        line.partition("=")[0] for line in (tmp_path / "log").read_text().splitlines()
    }
    assert "JOBS" in found
    assert not found & meant


def test_the_command_refuses_without_a_traceback(tmp_path):
    end = f"GENESIS={OLD} is the pin already. Give another version.\n\nFAILED: nothing was changed."
    assert fails("repin.py", tmp_path, GENESIS=OLD) == f"\n{end}\n"


RUN = """
import sys
from pathlib import Path
from robo_genesis.pipeline.command import run
from robo_genesis.maintain.repin import run_repin
root = Path(sys.argv[1])
sys.exit(run(lambda: run_repin(sys.argv[2], root, root / ".cache"), "changed"))
"""


@pytest.mark.parametrize(
    ("sent", "status"), [(signal.SIGTERM, 130), (signal.SIGKILL, -9)]
)
def test_an_end_by_signal_takes_the_children_along_and_the_next_one_works(
    root, sent, status
):
    before, sleeper = (
        state(root),
        root / ".cache" / "repin" / "work" / "checkout" / "sleeper",
    )
    process = subprocess.Popen([sys.executable, "-c", RUN, str(root), HANGS], cwd=ROOT)
    wait(process, sleeper)
    child = psutil.Process(int(sleeper.read_text()))
    process.send_signal(sent)
    assert process.wait() == status
    assert not psutil.wait_procs([child], timeout=30)[1]
    assert state(root) == before
    repin(root, NEW)
    assert (root / "pyproject.toml").read_text() == PROJECT.format(NEW)
    assert left(root) == ["lock", "logs"]
