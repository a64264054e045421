import json
import os
import shutil
import subprocess
import sys
import zipfile
from email import message_from_bytes

from robo_genesis.core import project
from robo_genesis.site.takeaways import files

UP_TO_THE_ENGINE = """
import json
from robo_genesis import doctor
from robo_genesis.sim import session

def start(contract):
    raise OSError("the engine would start now")

session.start = start
print(json.dumps([*doctor.examine()][-1]))
"""


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


def test_a_download_that_is_renamed_or_short_is_noticed(tmp_path):
    command = ["bash", "-c", files.check_command(tmp_path)]
    constraints = tmp_path / files.CONSTRAINTS
    renamed = tmp_path / "constraints (1).txt"
    shutil.copy(files.LOCK, constraints)

    def status() -> int:
        return subprocess.run(command, cwd=tmp_path, check=False).returncode

    assert status() == 0
    constraints.rename(renamed)
    assert status() == 1
    constraints.write_bytes(renamed.read_bytes()[:-9])
    assert status() == 1


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
