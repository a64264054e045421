"""`python -m robo_genesis.compare`: a student's run beside the site's."""

import shutil
from pathlib import Path

import pytest
from spoilers import metrics, modules, part, predicate, seal

from robo_genesis.compare import main


@pytest.fixture
def mine(folder, tmp_path) -> Path:
    """The bundle of a student's own run, equal to the site's."""
    return Path(shutil.copytree(folder, tmp_path / "mine" / "cpu"))


@pytest.fixture
def archive(folder, tmp_path) -> str:
    """The site's bundle as the ledger offers it."""
    return shutil.make_archive(str(tmp_path / "site"), "zip", folder)


def spoil(folder, change):
    change(folder)
    seal(folder)


def test_an_equal_run_agrees_with_the_archive_and_with_the_folder(mine, archive, folder, capsys):
    for site in (archive, str(folder)):
        assert main([str(mine), site]) == 0
        assert "Your run agrees with the site's" in capsys.readouterr().out


def test_another_value_is_named_with_both_values_and_the_usual_reason(mine, archive, capsys):
    def change(records):
        records["G2"]["overshoot"]["value"] *= 1.5

    spoil(mine, metrics(change))
    assert main([str(mine), archive]) == 1
    said = capsys.readouterr().out
    assert "Your run differs from the site's" in said
    assert "overshoot" in said
    assert "a changed cell of the notebook" in said


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (part("engine", version="9.9.9"), "The engines differ: 9.9.9 and"),
        (modules(**{"core.trace": "0" * 64}), "The course's code differs"),
    ],
)
def test_what_may_explain_a_difference_is_said(mine, archive, change, reason, capsys):
    spoil(mine, change)
    main([str(mine), archive])
    assert reason in capsys.readouterr().out


@pytest.mark.parametrize("change", [predicate(page="lecture"), predicate(seed=1)])
def test_runs_of_different_questions_are_not_compared(mine, archive, change, capsys):
    spoil(mine, change)
    assert main([str(mine), archive]) == 2
    said = "".join(capsys.readouterr())
    assert "Give two bundles of the same page" in said or "different questions" in said


def test_a_file_that_is_no_bundle_is_refused_with_what_is_valid(mine, tmp_path, capsys):
    (tmp_path / "notes.txt").write_text("no bundle")
    for given in ("nowhere", str(tmp_path / "notes.txt")):
        assert main([str(mine), given]) == 2
        assert "neither a folder nor a zip archive" in capsys.readouterr().err
