"""Two executions agree if their arrays are equal, or, on two processors, within the tolerances."""

import shutil
from pathlib import Path

import pytest
from checkout import make
from spoilers import CHECKS, both, check, log, measured_elsewhere, part, rewrite, seal

from robo_genesis.core.project import ROOT, ProjectError
from robo_genesis.evidence.bundle import read_manifest
from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.pipeline.agreement import agree
from robo_genesis.pipeline.pages.folder import RECORD, Record

FILES = {
    "outputs/cpu/arrays/a.npz": b"a",
    "outputs/shape.npz": b"s",
    "outputs/cpu/log.txt": b"1",
}
LAB = "lessons/l04-joint-control/lab"


def executed(folder, docname, files: dict[str, bytes], run_id, fingerprint="f") -> Path:
    """Write a folder as `make execute` does, as far as its arrays are concerned."""
    place = folder / docname.replace("/", "--")
    place.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (place / name).parent.mkdir(parents=True, exist_ok=True)
        (place / name).write_bytes(content)
    of_page = {
        "docname": docname,
        "lesson": None,
        "page": None,
        "engine": None,
        "files": {},
    }
    of_run = {
        "fingerprint": fingerprint,
        "code": "0" * 64,
        "run_id": run_id,
        "seconds": 1.0,
    }
    record = Record(**of_page, **of_run, cell_seconds=[])
    (place / RECORD).write_text(record.model_dump_json())
    return place


@pytest.fixture
def machines(tmp_path):
    """Two machines with the same two pages; logs differ."""
    folders = tmp_path / "first" / "artifact", tmp_path / "second"
    for number, folder in enumerate(folders, 1):
        log = {"outputs/cpu/log.txt": bytes([number])}
        executed(folder, "lessons/lab", FILES | log, f"{number}" * 32)
        executed(folder, "text", {}, f"{number}" * 32)
    return tmp_path / "first", tmp_path / "second"


@pytest.mark.parametrize(
    ("files", "run", "said"),
    [
        (
            FILES | {"outputs/shape.npz": b"t"},
            {},
            r"1 of 2 archives differ\. .*shape\.npz m",
        ),
        (
            {"outputs/shape.npz": b"s"},
            {},
            r"cpu/arrays/a\.npz must be equal on a processor w",
        ),
        (FILES | {"outputs/b.npz": b"b"}, {}, r"1 of 3 archives .* outputs/b\.npz"),
        (
            FILES,
            {"run_id": "1" * 32},
            "lessons/lab: both are run 11111111, expected two",
        ),
        (
            FILES,
            {"fingerprint": "g"},
            "lessons/lab: their fingerprints are f and g, expected",
        ),
        (None, {}, r"lessons/lab is not in .*/second\. Execute it: make"),
    ],
)
def test_a_different_or_missing_archive_or_page_is_named(machines, files, run, said):
    shutil.rmtree(machines[1] / "lessons--lab")
    if files:
        executed(machines[1], "lessons/lab", files, **{"run_id": "2" * 32} | run)
    with pytest.raises(ProjectError, match=said):
        agree(*machines)


def test_folders_without_arrays_and_a_page_twice_are_refused(machines, tmp_path):
    for number, name in enumerate(("third", "fourth")):
        executed(tmp_path / name, "text", {}, f"{number}" * 32)
    with pytest.raises(ProjectError, match="has no arrays"):
        agree(tmp_path / "third", tmp_path / "fourth")
    executed(machines[1] / "again", "text", {}, "2" * 32)
    with pytest.raises(ProjectError, match="has text twice"):
        agree(*machines)


def test_make_finds_equal_arrays_at_any_depth_whatever_the_logs_contain(machines):
    first, second = f"FIRST={machines[0]}", f"SECOND={machines[1]}"
    said = make(ROOT, "agree", first, second)
    assert (
        "Pages with arrays that are equal to the last bit: 1 of 1." in said.splitlines()
    )
    assert "SECOND='' is not a folder." in make(ROOT, "agree", first, fails=True)


other_cpu = both(
    part("host", cpu="B"), part("backend", device_name="B"), log("[a CPU]", "[B]")
)
one_ulp = measured_elsewhere  # in an array of each case
flipped_check = check(0, passed=False)
impossible = rewrite("G2", internal_force=lambda force: force + 1)


def other_shape(folder):
    """Leave another shape of the robot beside the bundle."""
    (folder.parent / "shape.npz").write_bytes(b"s")


@pytest.fixture
def twice(folder, tmp_path):
    """Execute L04's lab twice; the second run is spoiled."""

    def run(*spoilers):
        other = Path(shutil.copytree(folder, tmp_path / "other" / "cpu"))
        both(one_ulp, *spoilers, seal)(other)
        for name, bundle in (("first", folder), ("second", other)):
            place = executed(
                tmp_path / name, LAB, {}, read_manifest(bundle).predicate.run_id
            )
            shutil.copytree(bundle, place / "outputs" / "cpu")
            for shape in bundle.parent.glob("*.npz"):
                shutil.copy(shape, place / "outputs")
        return tmp_path / "first", tmp_path / "second"

    return run


def test_rounding_on_another_processor_is_accepted_and_the_largest_is_named(twice):
    lines = agree(*twice(other_cpu))
    assert lines[:2] == [
        "Each page was executed twice, on B and a CPU.",
        "Pages with arrays that are equal to the last bit: 0 of 1.",
    ]
    assert "two processors that round differently: 1." in lines[2]
    assert f"is in {LAB}, " in lines[2]
    assert "internal_force" in lines[2]
    assert "allowed" in lines[2]


@pytest.mark.parametrize(
    ("spoilers", "said"),
    [
        ([], r"lab: 4 of 4 archives differ\. .*G1\.npz must be equal on a CPU\. "),
        (
            [other_cpu, other_shape],
            r"1 of 5 .* outputs/shape\.npz must be equal on B and a",
        ),
        ([other_cpu, impossible], r"lab: motion: .*G2: internal_force"),
        (
            [other_cpu, flipped_check],
            rf"lab: B and a CPU .*{CHECKS[0]}: passed → FAILED",
        ),
    ],
)
def test_any_other_difference_is_refused_by_name(twice, spoilers, said):
    with pytest.raises(ProjectError, match=f"(?s){said}"):
        agree(*twice(*spoilers))


def test_another_processor_must_stay_within_the_tolerances(twice, monkeypatch):
    monkeypatch.setattr(l04, "TOLERANCES", {})
    with pytest.raises(ProjectError, match=r"(?s)lab: B and a CPU .*arrays: differs"):
        agree(*twice(other_cpu))


def test_another_backend_is_not_a_second_execution(twice):
    folders = twice(other_cpu, part("backend", actual="cuda", actual_at_end="cuda"))
    with pytest.raises(
        ProjectError, match=r"(?s)but they differ more.*backend cpu → cuda"
    ):
        agree(*folders, verify=lambda *of: None)
