"""`make verify`: a line for each bundle, and the exit status of the worst."""

import shutil

import pytest
from spoilers import filed_as, older_compiler, on

from robo_genesis.core.project import engine_pin
from robo_genesis.pipeline.bundles import overview


@pytest.fixture
def verify(tmp_path, courses_pages):
    """Verify a book without bundles, or one folder; return the exit status."""
    return lambda folder=None: overview.verify(folder, tmp_path / "book")


@pytest.fixture
def recorded(folder, tmp_path):
    place = tmp_path / "book" / "evidence" / "l04"
    return on("amdgpu")(shutil.copytree(folder, place / "cpu"))


@pytest.fixture
def built(folder, tmp_path):
    return shutil.copytree(
        folder, tmp_path / "book" / "_build" / "evidence" / "l04" / "cpu"
    )


def test_no_bundle_is_said_and_no_error(verify, capsys):
    assert verify() == 0
    assert capsys.readouterr().out.startswith("No bundle is recorded in book/evidence")


def test_each_bundle_has_a_line(verify, recorded, built, capsys):
    assert verify() == 0
    lines = [line.split(maxsplit=4) for line in capsys.readouterr().out.splitlines()]
    assert [line[:4] for line in lines] == [
        ["l04", "recorded", "amdgpu", "verified"],
        ["l04", "built", "cpu", "verified"],
    ]
    assert all(f"Genesis {engine_pin()}, " in line[4] for line in lines)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (
            older_compiler,
            "stale        stale: manifest.json: engine.quadrants_version is 1.2.9, expected",
        ),
        (filed_as("rocm"), "rocm     refused      backend: "),
    ],
)
def test_what_is_not_current_is_status_1(verify, recorded, built, capsys, spoil, said):
    spoil(recorded)
    assert verify() == 1
    out = capsys.readouterr().out
    assert said in out
    assert "l04 built      cpu      verified" in out


def test_what_does_not_show_the_claims_is_status_1(verify, recorded, undecided, capsys):
    assert verify() == 1
    assert (
        "inconclusive Not shown of what the lesson claims: peak_speed"
        in capsys.readouterr().out
    )


@pytest.fixture
def check(verify, capsys):
    """Check one folder alone; return exit status and lines."""
    return lambda folder: (verify(folder), capsys.readouterr().out.splitlines())


def test_one_folder_is_checked_alone(check, recorded, folder, tmp_path):
    older_compiler(recorded)
    status, lines = check(folder)
    assert (status, len(lines)) == (0, 1)
    status, lines = check(tmp_path / "cpu")
    assert (status, lines[0].endswith(" There is no such folder.")) == (1, True)
