"""A change of several files is applied as a whole, whenever the process is killed."""

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from robo_genesis import apply, command
from robo_genesis.project import ROOT

NAMES = ("pyproject.toml", "requirements.lock", "below/third.txt")
CALLS = ("os.replace", "os.unlink", "os.fsync", "os.open", "shutil.rmtree", "shutil.copymode")


def tree(folder: Path, text: str) -> Path:
    for name in NAMES:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(f"{text} {name}\n")
    return folder


def texts(root: Path) -> set[str]:
    """Return the first words of the files: one word where they belong to one state."""
    return {(root / name).read_text().split()[0] for name in NAMES}


def before(root: Path) -> dict[str, str]:
    return {name: apply.digest(root / name) for name in NAMES}


@pytest.fixture
def root(tmp_path) -> Path:
    return tree(tmp_path / "checkout", "old")


@pytest.fixture
def source(tmp_path) -> Path:
    return tree(tmp_path / "copy", "new")


def rubbish(root: Path) -> list[str]:
    """Return what stands in the checkout besides its files and the lock of applying."""
    expected = {*NAMES, str(apply.LOCK)}
    files = (path.relative_to(root).as_posix() for path in root.rglob("*") if path.is_file())
    return sorted(set(files) - expected)


def test_all_files_are_replaced_and_nothing_is_left_behind(root, source):
    (root / NAMES[0]).chmod(0o640)
    apply.apply(root, source, before(root))
    assert texts(root) == {"new"}
    assert rubbish(root) == []
    assert (root / NAMES[0]).stat().st_mode & 0o777 == 0o640


def test_a_file_that_changed_meanwhile_is_kept_and_nothing_is_applied(root, source):
    was = before(root)
    (root / NAMES[1]).write_text("mine\n")
    with pytest.raises(apply.ApplyError, match=r"requirements\.lock changed while .* again"):
        apply.apply(root, source, was)
    assert texts(root) == {"old", "mine"}
    assert rubbish(root) == []


def test_a_new_file_that_cannot_be_read_leaves_the_old_state(root, source):
    (source / NAMES[2]).unlink()
    with pytest.raises(FileNotFoundError):
        apply.apply(root, source, before(root))
    apply.recover(root)
    assert texts(root) == {"old"}
    assert rubbish(root) == []


def test_without_anything_left_recovery_touches_nothing(root):
    apply.recover(root)
    assert not (root / ".cache").exists()


# Kills itself for good just before the given call of any function that touches the disk.
KILLED = f"""
import os, shutil, signal, sys
from pathlib import Path
from robo_genesis import apply
calls = 0
def counted(call):
    def instead(*args, **kwargs):
        global calls
        if calls == int(sys.argv[3]):
            os.kill(os.getpid(), signal.SIGKILL)
        calls += 1
        return call(*args, **kwargs)
    return instead
for name in {CALLS!r}:
    module, _, function = name.partition(".")
    setattr(globals()[module], function, counted(getattr(globals()[module], function)))
root, source = Path(sys.argv[1]), Path(sys.argv[2])
apply.apply(root, source, {{name: apply.digest(root / name) for name in {NAMES!r}}})
print(calls)
"""


def killed(root: Path, source: Path, at: int) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", KILLED, str(root), str(source), str(at)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


def test_a_kill_before_any_step_is_undone_or_completed_by_the_next_command(tmp_path, source):
    steps = int(killed(tree(tmp_path / "whole", "old"), source, -1).stdout)
    assert steps > 15  # every staged file, the journal, every move, the tidying
    found = []
    for at in range(steps):
        root = tree(tmp_path / f"killed before {at}", "old")
        assert killed(root, source, at).returncode == -signal.SIGKILL
        half = texts(root) == {"old", "new"}
        shutil.copy(ROOT / "robo_genesis" / "apply.py", root / "below")
        subprocess.run([sys.executable, "-S", root / "below" / "apply.py"], check=True)
        (root / "below" / "apply.py").unlink()
        assert texts(root) in ({"old"}, {"new"}), at
        assert rubbish(root) == [], at
        found.append((half, *texts(root)))
    assert [state for _, state in found] == sorted((s for _, s in found), reverse=True)
    assert {(False, "old"), (True, "new"), (False, "new")} == set(found)


def test_a_recovery_that_is_killed_as_well_is_completed_by_the_next(root, source, monkeypatch):
    replace, moves = os.replace, []

    def dies(*paths):
        if len(moves) == 2:
            raise KeyboardInterrupt
        moves.append(replace(*paths))

    with monkeypatch.context() as patch:
        patch.setattr(os, "replace", dies)
        for _ in range(2):  # the journal and one file; then nothing more
            with pytest.raises(KeyboardInterrupt):
                apply.apply(root, source, before(root)) if not moves else apply.recover(root)
    assert texts(root) == {"old", "new"}
    apply.recover(root)
    assert texts(root) == {"new"}


def test_a_move_that_fails_half_way_says_that_the_change_is_decided(root, source, capsys):
    in_the_way = root / "below" / ".third.txt.repin"
    in_the_way.mkdir()
    was = before(root)

    def task() -> list[str]:
        apply.apply(root, source, was)
        return []

    assert command.run(task, "changed", (apply.ApplyError,)) == 1
    said = capsys.readouterr().err
    reason = f"[Errno 21] Is a directory: '{in_the_way}'"
    assert f"The change is decided and not complete: {reason}" in said
    assert said.endswith("FAILED: the change is not complete.\n")
    assert "nothing was changed" not in said
    assert texts(root) == {"old", "new"}
    in_the_way.rmdir()
    apply.recover(root)
    assert texts(root) == {"new"}
    assert rubbish(root) == []


def test_what_fails_right_after_the_journal_was_written_is_decided_too(root, source, monkeypatch):
    flush = apply._flush_folders

    def fails(folders) -> None:
        if (root / apply.STAGED / apply.JOURNAL).exists():
            raise OSError("no space")
        flush(folders)

    with monkeypatch.context() as patch:
        patch.setattr(apply, "_flush_folders", fails)
        with pytest.raises(apply.UnfinishedError, match="no space"):
            apply.apply(root, source, before(root))
    assert texts(root) == {"old"}
    apply.recover(root)
    assert texts(root) == {"new"}


def test_staged_files_that_cannot_be_removed_do_not_undo_a_whole_change(root, source, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(shutil, "rmtree", lambda folder: (_ for _ in ()).throw(OSError("busy")))
        apply.apply(root, source, before(root))
    assert texts(root) == {"new"}
    (root / NAMES[0]).write_text("later\n")
    apply.recover(root)
    assert texts(root) == {"new", "later"}
    assert rubbish(root) == []


def test_what_was_edited_after_a_kill_is_never_overwritten(root, source, monkeypatch):
    monkeypatch.setattr(apply, "_replace", lambda *paths: (_ for _ in ()).throw(OSError("full")))
    with pytest.raises(apply.UnfinishedError, match=r"is decided and not complete: full\. Clear"):
        apply.apply(root, source, before(root))
    monkeypatch.undo()
    (root / NAMES[1]).write_text("mine\n")
    with pytest.raises(apply.ApplyError, match=r"requirements\.lock was edited since"):
        apply.recover(root)
    assert texts(root) == {"old", "mine"}
    shutil.rmtree(root / apply.STAGED)  # the way out that the message offers
    apply.recover(root)
    assert texts(root) == {"old", "mine"}
