"""`python -m robo_genesis.compare`: a student's run beside the site's."""

import re
import shutil
import subprocess
import sys
from pathlib import Path
from textwrap import dedent

import pytest
from spoilers import both, facts, metrics, modules, part, seal

from robo_genesis.compare import main
from robo_genesis.core.project import ROOT


@pytest.fixture
def mine(folder, tmp_path) -> Path:
    """The bundle of a student's own run, equal to the site's."""
    return Path(shutil.copytree(folder, tmp_path / "mine" / "cpu"))


@pytest.fixture
def archive(folder, tmp_path) -> str:
    """The site's bundle as the ledger offers it."""
    return shutil.make_archive(str(tmp_path / "site"), "zip", folder)


def test_an_equal_run_agrees_with_the_archive_and_with_the_folder(
    mine, archive, folder, capsys
):
    for site in (archive, str(folder)):
        assert main([str(mine), site]) == 0
        said = capsys.readouterr().out
        assert "Your run agrees with the site's" in said
        assert "clean checkout" not in said


def test_the_site_s_own_run_is_not_taken_for_a_student_s(mine, archive, capsys):
    for change, named in (
        (seal, True),
        (both(facts(run_id="0" * 32), seal), False),
    ):
        change(mine)
        assert main([str(mine), archive]) == 0
        said = capsys.readouterr().out
        assert ("This is the site's own run or an edited copy of it" in said) == named


accelerated = part("backend", actual="cuda", actual_at_end="cuda")
DIFFERS = "Your run differs from the site's"


@pytest.mark.parametrize(
    ("change", "status", "said"),
    [
        (
            metrics(lambda m: m["G2"]["overshoot"].update(value=1.5)),
            1,
            (DIFFERS, "overshoot", "a changed cell of the notebook"),
        ),
        (part("engine", version="9.9.9"), 0, ("The engines differ: 9.9.9 (",)),
        (part("engine", quadrants_version="9.9.9"), 0, ("(quadrants 9.9.9) and",)),
        (
            part("engine", files_match_wheel=False),
            1,
            ("files of one engine were changed",),
        ),
        (modules(**{"core.trace": "0" * 64}), 0, ("The course's code differs",)),
        (
            both(part("engine", version="9.9.9"), accelerated),
            2,
            (
                "cannot be compared",
                "The engines differ: 9.9.9",
                "The backends differ: cuda and cpu",
            ),
        ),
        (facts(page="lecture"), 2, ("Give two bundles of the same page",)),
        (facts(seed=1), 2, ("cannot be compared",)),
    ],
)
def test_what_differs_and_what_may_explain_it_is_said(
    mine, archive, change, status, said, capsys
):
    both(change, seal)(mine)
    assert main([str(mine), archive]) == status
    printed = "".join(capsys.readouterr())
    assert all(words in printed for words in said)
    assert (DIFFERS in printed) == (DIFFERS in said or "files of" in said[0])


@pytest.mark.usefixtures("undecided")
def test_an_undecided_ordering_is_not_called_a_difference(mine, archive, capsys):
    assert main([str(mine), archive]) == 1
    said = capsys.readouterr().out
    assert "is undecided: see the inconclusive lines" in said
    assert DIFFERS not in said


def test_a_file_that_is_no_bundle_is_refused_with_what_is_valid(mine, tmp_path, capsys):
    (tmp_path / "notes.txt").write_text("no bundle")
    for given in ("nowhere", str(tmp_path / "notes.txt")):
        assert main([str(mine), given]) == 2
        assert "neither a folder nor a zip archive" in capsys.readouterr().err


def test_the_commands_for_teachers_grade_each_student_and_leave_the_bundles(
    mine, folder, tmp_path
):
    """The block of ADOPTING.md, run twice: its output must not become a part of a bundle."""
    text = (ROOT / "ADOPTING.md").read_text()
    [block] = re.findall(r"(?m)^    mkdir -p compared\n(?:    .*\n)+", text)
    work = tmp_path / "course"
    bundles = {"submitted/ada": mine, "book/_build/evidence/l04/cpu": folder}
    for place, bundle in bundles.items():
        shutil.copytree(bundle, work / place)
    shutil.copytree(mine, work / "submitted/bob lee")
    (work / "submitted/bob lee/notes.txt").write_text("not listed")
    python = work / ".venv/bin/python"
    python.parent.mkdir(parents=True)
    python.write_text(
        f"#!/bin/sh\nPYTHONPATH='{ROOT}' exec '{sys.executable}' \"$@\"\n"
    )
    python.chmod(0o755)
    for _ in range(2):
        command = ["bash", "-c", dedent(block)]
        done = subprocess.run(
            command, cwd=work, capture_output=True, text=True, check=True
        )
        assert done.stdout.splitlines() == ["ada 0", "bob lee 2"]
    assert "agrees with the site's" in (work / "compared/ada.txt").read_text()
    assert "notes.txt" in (work / "compared/bob lee.txt").read_text()
