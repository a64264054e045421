"""What a reader does: the commands of the box, in an empty environment and an empty folder."""

import os
import shlex
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import nbformat
import pytest
from bs4 import BeautifulSoup

from robo_genesis import build, project

pytestmark = pytest.mark.engine
LAB = "lessons/l04-joint-control/lab"
OURS = ("PYTHON", "VIRTUAL_ENV", "ROBO_GENESIS", "JUPYTER", "IPYTHON")
"""Variables of this environment that a reader's does not have."""


@pytest.fixture
def home() -> Iterator[Path]:
    """A folder outside the checkout; an environment in it fills gigabytes, so it goes again."""
    with tempfile.TemporaryDirectory() as name:
        yield Path(name).resolve()


def run(line: str, folder: Path, environment: dict[str, str]) -> str:
    done = subprocess.run(
        shlex.split(line), cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, f"{line}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
    return done.stdout


def test_the_install_line_is_enough_to_run_the_student_s_notebook(site, home):
    box = BeautifulSoup((site / f"{LAB}.html").read_text(), "html.parser").select_one(
        ".run-it-yourself"
    )
    for link in box.select("a.takeaway"):
        shutil.copy((site / LAB).parent / link["href"], home)
    make, install, start = box.select_one("pre").get_text().strip().splitlines()
    given = {name: value for name, value in os.environ.items() if not name.startswith(OURS)}
    # Versions as the lock has them; which packages come is the wheel's and the line's to say.
    given["PIP_CONSTRAINT"] = str(project.ROOT / "requirements.lock")
    given["PIP_NO_COMPILE"] = "1"  # thousands of files less to write and to remove
    environment = given | project.engine_cache_environment()
    run(make, home, environment)
    run(install, home, environment)
    folder = make.split()[-1]
    where = "import robo_genesis; print(robo_genesis.__file__)"
    assert run(f"{folder}/bin/python -c '{where}'", home, environment).startswith(str(home))
    notebook = start.split()[-1]
    execute = start.replace("jupyter lab", "jupyter execute --output=done.ipynb")
    with build.only_build(project.CACHE):
        run(execute, home, environment)
    done = nbformat.read(home / "done.ipynb", as_version=4)
    assert f"genesis-world {project.engine_pin()}" in done.cells[1].outputs[0].text
    last = [cell for cell in done.cells if cell.cell_type == "code"][-1]
    assert "L04 CHECK: PASSED" in last.outputs[-1].text
    assert (home / notebook).is_file()
    assert (home / "outputs" / "l04" / "lab" / "cpu" / "manifest.json").is_file()
