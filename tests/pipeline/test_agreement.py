"""`make agree`: equal arrays pass; each difference is a line that names page and archive."""

import shutil
from pathlib import Path

import pytest
from checkout import make

from robo_genesis.core.project import ROOT, ProjectError
from robo_genesis.pipeline.agreement import agree
from robo_genesis.pipeline.pages.folder import RECORD, Record

FILES = {"outputs/cpu/arrays/a.npz": b"a", "outputs/shape.npz": b"s", "outputs/cpu/log.txt": b"1"}


def executed(folder: Path, docname: str, files: dict[str, bytes]) -> Path:
    """Write a folder as `make execute` does, as far as its arrays are concerned."""
    place = folder / docname.replace("/", "--")
    place.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (place / name).parent.mkdir(parents=True, exist_ok=True)
        (place / name).write_bytes(content)
    of_page = {"docname": docname, "lesson": None, "page": None, "engine": None, "files": {}}
    of_run = {"fingerprint": "f", "code": "0" * 64, "run_id": "1" * 32, "seconds": 1.0}
    record = Record(**of_page, **of_run, cell_seconds=[])
    (place / RECORD).write_text(record.model_dump_json())
    return place


@pytest.fixture
def machines(tmp_path):
    """Two machines with the same two pages; logs differ."""
    folders = tmp_path / "first" / "artifact", tmp_path / "second"
    for number, folder in enumerate(folders):
        executed(folder, "lessons/lab", FILES | {"outputs/cpu/log.txt": bytes([number])})
        executed(folder, "text", {})
    return tmp_path / "first", tmp_path / "second"


@pytest.mark.parametrize(
    ("files", "said"),
    [
        (FILES | {"outputs/shape.npz": b"t"}, r"lessons/lab: outputs/shape\.npz has the digests"),
        ({"outputs/shape.npz": b"s"}, r"arrays/a\.npz has the digests [0-9a-f]{12} and none"),
        (FILES | {"outputs/b.npz": b"b"}, r"outputs/b\.npz has the digests none and [0-9a-f]{12}"),
        (None, r"lessons/lab is not in SECOND\. Execute it there: make"),
    ],
)
def test_a_different_or_missing_archive_or_page_is_named(machines, files, said):
    shutil.rmtree(machines[1] / "lessons--lab")
    if files:
        executed(machines[1], "lessons/lab", files)
    with pytest.raises(ProjectError, match=said):
        agree(*machines)


def test_folders_without_arrays_and_a_page_twice_are_refused(machines, tmp_path):
    executed(tmp_path / "third", "text", {})
    with pytest.raises(ProjectError, match="has no arrays"):
        agree(tmp_path / "third", tmp_path / "third")
    executed(machines[1] / "again", "text", {})
    with pytest.raises(ProjectError, match="has text twice"):
        agree(*machines)


def test_make_finds_equal_arrays_at_any_depth_whatever_the_logs_contain(machines):
    first, second = f"FIRST={machines[0]}", f"SECOND={machines[1]}"
    said = make(ROOT, "agree", first, second)
    assert "Equal: 2 archives of arrays on 2 pages." in said.splitlines()
    assert "SECOND='' is not a folder. Usage: make agree" in make(ROOT, "agree", first, fails=True)
