import csv
import io
import json
import os
import shutil
import subprocess
import sys
import zipfile
from email import message_from_bytes

import numpy as np

from robo_genesis.core import project
from robo_genesis.evidence.trace_files import write_traces
from robo_genesis.site.takeaways import files

LINKS = ["link0", "link4", "hand"]
UP_TO_THE_ENGINE = """
import json
from robo_genesis import doctor
from robo_genesis.sim import session

def start(contract):
    raise OSError("the engine would start now")

session.start = start
print(json.dumps([*doctor.examine()][-1]))
"""


def test_each_number_is_in_its_table_with_its_unit_and_none_is_made_up(
    tmp_path, traces, joints
):
    run = traces["G2"]
    described = write_traces(tmp_path, {"G2": run}, joints, LINKS)
    table = list(csv.DictReader(io.StringIO(files.csv_text(run, described, "G2"))))

    def column(name: str) -> np.ndarray:
        return np.array([row[name] for row in table], dtype=np.float32)

    assert len(table) == len(run.t)
    assert np.array_equal([float(row["t [s]"]) for row in table], run.t)
    assert np.array_equal(column("q joint4 [rad]"), run.q[:, 3])
    assert np.array_equal(column("q finger_joint2 [m]"), run.q[:, 8])
    assert np.array_equal(column("link_pos hand x [m]"), run.link_pos[:, 2, 0])
    assert np.array_equal(column("link_quat hand w [1]"), run.link_quat[:, 2, 0])
    for field, unit in (("qd", "rad/s"), ("control_force", "N·m")):
        name = f"{field} joint4 [{unit}]"
        assert np.array_equal(column(name)[1:], getattr(run, field)[:, 3])
        assert np.float32(table[0][name]) == getattr(run, f"start_{field}")[3]
    assert {row["effort_limit joint4 [N·m]"] for row in table} == {
        str(run.effort_limit[3])
    }
    empty = {name.split()[0] for name, value in table[0].items() if value == ""}
    assert empty == {"target", "internal_force"}
    assert [name for name, value in table[1].items() if value == ""] == []


def test_the_wheel_pins_the_engine_and_is_the_same_each_time(tmp_path):
    root, lesson = tmp_path / "checkout", "robo_genesis/lessons/l01/"
    shutil.copytree(project.ROOT / files.PACKAGE, root / files.PACKAGE)
    for name in files.SOURCES:
        shutil.copy(project.ROOT / name, root)
    (root / lesson / "data").mkdir()
    data = {f"{lesson}arm.xml", f"{lesson}data/arm"}
    for name in (*data, f"{lesson}arm.xml~", f"{lesson}.arm.xml.swp"):
        (root / name).touch()
    first = files.build_wheel(tmp_path, root)
    assert files.built_wheel(root) == first.read_bytes()
    with zipfile.ZipFile(first) as wheel:
        names = wheel.namelist()
        (about,) = (name for name in names if name.endswith("/METADATA"))
        metadata = message_from_bytes(wheel.read(about))
    assert f"genesis-world=={project.engine_pin()}" in metadata.get_all("Requires-Dist")
    sources = {
        path.relative_to(project.ROOT).as_posix()
        for path in (project.ROOT / "robo_genesis").rglob("*")
        if path.is_file() and path.suffix not in (".pyc", ".tmpl")
    }
    shipped = {name for name in names if not name.startswith("robo_genesis-")}
    assert shipped == sources | data


def test_the_doctor_and_the_pin_work_from_the_wheel_without_a_checkout(tmp_path):
    """The metadata of the wheel has the pin; an unpacked wheel is what pip installs."""
    home, installed = tmp_path / "home", tmp_path / "installed"
    home.mkdir()
    with zipfile.ZipFile(files.build_wheel(tmp_path)) as wheel:
        wheel.extractall(installed)
    given = os.environ | {"PYTHONPATH": str(installed), "HOME": str(home)}
    command = [sys.executable, "-c", UP_TO_THE_ENGINE]
    done = subprocess.run(
        command, cwd=home, env=given, capture_output=True, text=True, check=False
    )
    version, libraries, backend = json.loads(done.stdout)["steps"][:3]
    assert f"genesis-world {project.engine_pin()}, as pinned" in version["found"]
    assert libraries["state"] == "ok"
    assert "the engine would start now" in backend["found"]
