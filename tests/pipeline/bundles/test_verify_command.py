"""`make verify`: a line for each bundle, and the exit status of the worst."""

import importlib.util
import shutil

import pytest
from loading import ENGINE, JUPYTER, run_watched
from spoilers import (
    SPOILED,
    both,
    drop_case,
    failing,
    found,
    log,
    measured_elsewhere,
    metric,
    modules,
    on,
    part,
    predicate,
    seal,
)

from robo_genesis.core.project import ROOT, engine_pin
from robo_genesis.evidence import advice


@pytest.fixture
def command(tmp_path, monkeypatch, courses_pages):
    """The script, on a book without bundles."""
    spec = importlib.util.spec_from_file_location("verify", ROOT / "build_scripts" / "verify.py")
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    monkeypatch.setattr(script, "BOOK", tmp_path / "book")
    monkeypatch.delenv("BUNDLE", raising=False)
    return script


@pytest.fixture
def recorded(folder, tmp_path):
    place = tmp_path / "book" / "evidence" / "l04"
    there = shutil.copytree(folder, place / "cpu")
    measured_elsewhere(there)
    return on("amdgpu")(there)


@pytest.fixture
def built(folder, tmp_path):
    return shutil.copytree(folder, tmp_path / "book" / "_build" / "evidence" / "l04" / "cpu")


def test_no_bundle_is_said_and_no_error(command, capsys):
    assert command.main() == 0
    assert capsys.readouterr().out.startswith("No bundle is recorded in book/evidence")


def test_each_bundle_has_a_line(command, recorded, built, capsys):
    assert command.main() == 0
    lines = [line.split(maxsplit=4) for line in capsys.readouterr().out.splitlines()]
    assert [line[:4] for line in lines] == [
        ["l04", "recorded", "amdgpu", "verified"],
        ["l04", "built", "cpu", "verified"],
    ]
    assert all(line[4].endswith(f"Genesis {engine_pin()}") for line in lines)


stale = both(part("engine", quadrants_version="1.2.9"), seal)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (stale, "stale        stale: manifest.json: engine.quadrants_version is '1.2.9', expected"),
        (lambda folder: (folder / "log.txt").unlink(), "refused      files: listed but absent"),
        (lambda folder: folder.rename(folder.with_name("rocm")), "rocm     refused      backend: "),
    ],
)
def test_what_is_not_current_is_status_1(command, recorded, built, capsys, spoil, said):
    spoil(recorded)
    assert command.main() == 1
    out = capsys.readouterr().out
    assert said in out
    assert "l04 built      cpu      verified" in out


def test_what_does_not_show_the_claims_is_status_1(command, recorded, undecided, capsys):
    assert command.main() == 1
    assert "inconclusive Not shown of what the lesson claims: peak_speed" in capsys.readouterr().out


def test_one_folder_is_checked_alone(command, recorded, folder, tmp_path, monkeypatch, capsys):
    stale(recorded)
    monkeypatch.setenv("BUNDLE", str(folder))
    assert command.main() == 0
    assert len(capsys.readouterr().out.splitlines()) == 1
    monkeypatch.setenv("BUNDLE", str(tmp_path / "cpu"))
    assert command.main() == 1
    assert "missing      There is no such folder." in capsys.readouterr().out


OLDER = both(part("engine", version="1.2.0"), log("version: ", "version: 1.2.0, was: "), seal)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (OLDER, "Another version of the engine computed. Install the course's versions"),
        (both(part("source", page="0" * 64), seal), "Your code cells differ from the page's. Your"),
        (both(part("source", page=None), seal), "A notebook that is run by hand does not name"),
        (both(modules(metrics="0" * 64), seal), "Your copy of the course's modules differs"),
        (both(part("parameters", rise_fraction=0.5), seal), "Your run has other settings. Your"),
        (both(predicate(seed=1), log("seed: 0", "seed: 1"), seal), "Your run started from another"),
        (predicate(schema_version=0), "The bundle was recorded with an older state"),
        (part("engine", files_match_wheel=False), "A file of your installed engine differs"),
        (part("backend", torch_device="cuda"), "Genesis and Torch used different devices"),
        (both(metric(value=0.0), seal), "The recorded metrics are not those of the recorded"),
        (both(found("mapping", "links", 12), seal), "The recorded outcomes of the checks are"),
        (failing("two joints on one DOF", seal), "The files are sound, but a check of the run"),
        (both(drop_case, seal), "The bundle does not have exactly the page's runs."),
    ],
)  # fmt: skip
def test_a_student_learns_what_a_refusal_means(command, folder, monkeypatch, capsys, spoil, said):
    spoil(folder)
    monkeypatch.setenv("BUNDLE", str(folder))
    assert command.main() == 1
    assert f"What this means: {said}" in capsys.readouterr().out


def test_damage_gets_no_advice(command, folder, monkeypatch, capsys):
    (folder / "log.txt").unlink()
    monkeypatch.setenv("BUNDLE", str(folder))
    assert command.main() == 1
    assert len(capsys.readouterr().out.splitlines()) == 1


def test_every_advice_is_for_a_code_or_change_that_exists():
    codes = {code for *both_codes, _ in SPOILED.values() for code in both_codes}
    assert {*advice.BY_CODE} <= codes


def test_one_folder_is_compared_with_the_build(command, folder, built, monkeypatch, capsys):
    both(OLDER, metric(value=0.5), seal)(folder)
    monkeypatch.setenv("BUNDLE", str(folder))
    assert command.main() == 1
    out = capsys.readouterr().out
    assert "Compared with this build's run on the CPU (build → yours):\nL04 lab: engine" in out
    assert "\n    G2.overshoot: " in out
    monkeypatch.setenv("BUNDLE", str(built))
    assert command.main() == 0
    assert len(capsys.readouterr().out.splitlines()) == 1


def test_a_copy_of_the_build_s_run_is_not_an_accelerator_s(
    command, folder, built, monkeypatch, capsys
):
    monkeypatch.setenv("BUNDLE", str(on("amdgpu")(folder)))
    assert command.main() == 1
    assert "refused      copy: manifest.json: backend.actual is 'amdgpu', but a run on the CPU" in (
        capsys.readouterr().out
    )


def test_neither_verification_nor_comparison_loads_the_engine_or_jupyter(folder):
    for _ in range(2):  # the first reads the pages, which takes Jupyter's packages
        said, loaded = run_watched("verify.py", BUNDLE=str(folder))
    assert "verified" in said
    assert "numpy" in loaded
    assert not loaded & {*ENGINE, *JUPYTER}
    said, loaded = run_watched(
        "compare.py", "--report", str(folder.parent), str(folder), str(folder)
    )
    assert "\nEqual. Rows: " in said
    assert not loaded & {*ENGINE, *JUPYTER}


def test_a_broken_book_is_named(command, recorded, monkeypatch):
    monkeypatch.undo()
    monkeypatch.setattr(command, "BOOK", recorded.parents[2])
    assert str(command.main()).startswith("Nothing can be verified: The table of contents")
