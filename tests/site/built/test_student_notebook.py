"""What a reader does: the commands of the box, in an empty environment and an empty folder."""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import nbformat
import pytest
from built_site import LESSON_PAGES, parsed
from lessons.exercise_cells import page_of

from robo_genesis.core import project
from robo_genesis.pipeline import stages

pytestmark = [pytest.mark.engine, pytest.mark.slow]
LABS = {
    key: name for key, name in LESSON_PAGES.items() if key[1] in ("lab", "capstone")
}
OURS = ("PYTHON", "VIRTUAL_ENV", "ROBO_GENESIS", "JUPYTER", "IPYTHON")
"""Variables of this environment that a reader's does not have."""


@pytest.fixture
def home() -> Iterator[Path]:
    """A folder outside the checkout; an environment in it fills gigabytes, so it goes again."""
    with tempfile.TemporaryDirectory() as name:
        yield Path(name).resolve()


def run(line: str, folder: Path, environment: dict[str, str]) -> str:
    how = {"cwd": folder, "env": environment, "capture_output": True, "text": True}
    done = subprocess.run(["bash", "-c", line], **how)
    assert done.returncode == 0, f"{line}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
    return done.stdout


def taken(site: Path, lab: str, home: Path) -> list[str]:
    """Take all files of a lab's box home, and return the lines that it tells to run."""
    box = parsed(site, lab).select_one(".run-it-yourself")
    for link in box.select("a.takeaway"):
        shutil.copy((site / lab).parent / link["href"], home)
    return box.select_one("pre").get_text().strip().replace("\\\n", " ").splitlines()


def write_solutions(notebook: Path, lesson: str, page: str) -> None:
    """Write the page's own solutions where the student's notebook leaves functions to write."""
    cells = page_of(lesson, page).notebook.cells
    solved = [c.source for c in cells if "solution" in c.metadata.get("tags", [])]
    left = nbformat.read(notebook, as_version=4)
    for solution in solved:
        head = solution.partition("(")[0] + "("
        (stub,) = (cell for cell in left.cells if cell.source.startswith(head))
        assert "NotImplementedError" in stub.source
        stub.source = solution
    nbformat.write(left, notebook)


def test_the_install_line_is_enough_to_run_each_student_s_notebook(site, home):
    lines = {key: taken(site, lab, home) for key, lab in LABS.items()}
    (install,), *others = {tuple(of[:2]) for of in lines.values()}
    assert others == []  # one environment serves both
    given = {
        name: value for name, value in os.environ.items() if not name.startswith(OURS)
    }
    environment = given | project.engine_cache_environment()
    run(" && ".join(install), home, environment)
    folder = "course"
    where = "import robo_genesis; print(robo_genesis.__file__)"
    assert run(f"{folder}/bin/python -c '{where}'", home, environment).startswith(
        str(home)
    )
    with stages.build_lock(project.CACHE):
        doctor = run(f"{folder}/bin/python -m robo_genesis.doctor", home, environment)
    assert "DOCTOR: all" in doctor
    for (lesson, page), (*_, start) in lines.items():
        execute = start.replace(
            "jupyter lab", f"jupyter execute --output={lesson}-done.ipynb"
        )
        for verdict in ("INCOMPLETE, not passed: ", "PASSED"):
            if verdict == "PASSED":
                write_solutions(home / start.split()[-1], lesson, page)
            with stages.build_lock(project.CACHE):
                run(execute, home, environment)
            done = nbformat.read(home / f"{lesson}-done.ipynb", as_version=4)
            last = [cell for cell in done.cells if cell.cell_type == "code"][-1]
            final = last.outputs[0].text.splitlines()[-1]
            assert final.startswith(f"{lesson.upper()} CHECK: {verdict}")
        assert f"genesis-world {project.engine_pin()}" in done.cells[1].outputs[0].text
        assert (home / start.split()[-1]).is_file()
        assert (home / "outputs" / lesson / page / "cpu" / "manifest.json").is_file()
