"""What the lab's page offers to take away, as it stands in the built site."""

import json

import nbformat
import numpy as np
import pytest
from built_site import parsed

from robo_genesis.core import project
from robo_genesis.evidence import bundle

pytestmark = pytest.mark.engine
LAB = "lessons/l04-joint-control/lab"
FOLDER = "takeaways/l04-lab"
OF_THE_SITE = ("{measured}", "{term}", "{takeaways}", ":::", "Take it with you")


@pytest.fixture(scope="module")
def page(site):
    return parsed(site, LAB)


@pytest.fixture(scope="module")
def run(site):
    return site.parent / "evidence" / "l04" / "cpu"


def test_the_page_links_every_file_with_its_size(site, page):
    links = page.select("a.takeaway")
    files = {(site / LAB).parent.joinpath(link["href"]).resolve() for link in links}
    there = {path for path in (site / FOLDER).rglob("*") if path.is_file()}
    there |= {path for path in (site / "takeaways").iterdir() if path.is_file()}
    assert files == there
    for link in links:
        size = (site / LAB).parent.joinpath(link["href"]).stat().st_size
        assert str(link.next_sibling).startswith(f" ({max(1, round(size / 1000))} kB)")


def test_the_box_names_the_files_that_are_there(site, page):
    box = page.select_one(".run-it-yourself")
    commands = box.select_one("pre").get_text().replace(" \\\n ", "").split("\n")
    assert commands[0] == "python3 -m venv course"
    (wheel,) = (site / "takeaways").glob("*.whl")
    assert " install -c constraints.txt --extra-index-url https://" in commands[1]
    assert commands[1].endswith(f" ./{wheel.name} jupyterlab")
    constraints = (site / "takeaways" / "constraints.txt").read_text()
    assert constraints == (project.ROOT / "requirements.lock").read_text()
    assert commands[2].endswith(" l04-lab.ipynb")


@pytest.mark.parametrize("name", ["l04-lab.ipynb", "l04-lab-executed.ipynb"])
def test_notebooks_are_valid_and_plain_and_name_no_private_path(site, name):
    path = site / FOLDER / name
    found = nbformat.read(path, as_version=4)
    nbformat.validate(found)
    prose = "\n".join(cell.source for cell in found.cells if cell.cell_type == "markdown")
    assert [words for words in OF_THE_SITE if words in prose] == []
    text = path.read_text()
    assert str(project.ROOT) not in text
    assert project.without_home(text) == text


def test_the_student_s_notebook_has_no_outputs_and_the_executed_one_has(site, run):
    student, ran = (
        nbformat.read(site / FOLDER / name, as_version=4)
        for name in ("l04-lab.ipynb", "l04-lab-executed.ipynb")
    )
    code = [cell for cell in student.cells if cell.cell_type == "code"]
    assert all(cell.outputs == [] and cell.execution_count is None for cell in code)
    assert f"'genesis-world': '{project.engine_pin()}'" in code[0].source
    executed = [cell for cell in ran.cells if cell.cell_type == "code"]
    given = [c.source for c in executed if "solution" not in c.metadata.get("tags", [])]
    assert given == [cell.source for cell in code[1:]]
    assert len(executed) - len(given) == 4  # resolver, loop, law, metrics
    assert "L04 CHECK: PASSED" in executed[-1].outputs[-1].text
    assert bundle.read_manifest(run).predicate.run_id[:8] in ran.cells[0].source


def test_arrays_are_the_bundle_s(site, run):
    described = bundle.read_arrays(run)
    assert json.loads((site / FOLDER / "arrays.json").read_text()) == json.loads(
        (run / "arrays.json").read_text()
    )
    for case, arrays in described.cases.items():
        archive = site / FOLDER / f"{case}.npz"
        assert archive.read_bytes() == (run / arrays.file).read_bytes()
        head, *rows = (site / FOLDER / f"{case}.csv").read_text().splitlines()
        column = head.split(",").index("q joint4 [rad]")
        values = np.array([row.split(",")[column] for row in rows], dtype=np.float32)
        assert np.array_equal(values, np.load(archive)["q_rad_or_m"][:, 3])


def test_figures_are_those_of_the_page(site, page):
    figures = {figure["id"] for figure in page.select("figure[id]")}
    drawn = {path.stem: path.read_text() for path in (site / FOLDER).glob("*.svg")}
    assert drawn.keys() == figures
    assert all("<svg" in text for text in drawn.values())
    for name, text in drawn.items():
        shown = page.select_one(f"#{name} :is(img, svg)")
        image = (site / LAB).parent.joinpath(shown.get("src") or shown["data-file"])
        assert image.read_text() == text
