"""The stages of a build in separate clones that share nothing but the executed pages.

Each clone is a copy of the checkout's files with caches of its own, and a small book: the cells of
the L04 lab without its prose, and a ball that falls. The commands are those of the workflow.
"""

import re
import shutil
from pathlib import Path

import pytest
from checkout import copy_checkout, make
from tiny_book import cell, make_book, notebook

from robo_genesis.core.project import BOOK
from robo_genesis.pipeline import npm

pytestmark = [pytest.mark.engine, pytest.mark.slow]

CELLS = re.compile(r"^```\{code-cell\}.*?^```$", re.M | re.S)
BALL = """\
from robo_genesis.sim import session as runtime
engine = runtime.start(runtime.read_contract())
import genesis as gs
scene = gs.Scene(show_viewer=False)
ball = scene.add_entity(gs.morphs.Sphere(radius=0.1, pos=(0, 0, 1)))
scene.build()
for _ in range(10):
    scene.step()
print("height", float(ball.get_pos()[2]))"""


def clone(folder: Path, name: str) -> Path:
    """Copy the checkout's files, with a small book; only npm's packages are shared."""
    work = copy_checkout(folder / name)
    shutil.rmtree(work / "book")
    (work / ".cache").mkdir()
    (work / ".cache" / "npm").symlink_to(npm.packages().parents[1])
    _, front, body = (BOOK / "lessons/l04-joint-control/lab.md").read_text().split("---\n", 2)
    lab = f"---\n{front}---\n# Lab\n\n" + "\n\n".join(CELLS.findall(body))
    make_book(work, lab=lab, ball=notebook(cell(BALL), title="Ball"))
    return work


def arrays(bundle: Path) -> dict[str, bytes]:
    """Return every file of arrays of a bundle."""
    return {path.stem: path.read_bytes() for path in (bundle / "arrays").glob("*.npz")}


def kernels(work: Path) -> list[Path]:
    """Return the kernels that were compiled in a clone."""
    return list(work.glob(".cache/engine/*/kernels/**/*.qdc"))


@pytest.fixture(scope="module")
def clones(tmp_path_factory) -> Path:
    """The folder of clone `lab`, whose kernels start cold, and clone `ball`, both executed."""
    folder = tmp_path_factory.mktemp("clones")
    for name, page in (("lab", "l04/lab"), ("ball", "ball")):
        to = f"TO={folder / 'executed' / name}"
        said = make(clone(folder, name), "execute", f"PAGE={page}", to)
        assert f"{name}  executed in" in said
    return folder


@pytest.fixture(scope="module")
def exported(clones) -> dict[str, bytes]:
    """The lab's arrays as they were exported: executed alone, with a cold cache of kernels."""
    found = arrays(clones / "executed/lab/lab/outputs/cpu")
    assert found.keys() == {"baseline", "G1", "G2", "G3"}
    return found


def test_the_site_is_built_from_the_executed_pages_alone(clones, exported):
    site = clone(clones, "site")  # it never runs the engine
    said = make(site, "book", f"EXECUTED={clones / 'executed'}")
    assert "Pages: 0 executed, 2 reused." in said
    assert "lab  accepted" in said
    assert "height 0.9" in (site / "book/_build/html/ball.html").read_text()
    assert arrays(site / "book/_build/evidence/l04/cpu") == exported
    assert kernels(clones / "lab")
    assert not kernels(site)


def test_results_depend_neither_on_jobs_nor_on_the_caches(clones, exported):
    """The same lab, executed again beside another page, with the kernels of the first run."""
    work = clones / "lab"
    for folder in (work / ".cache" / "pages").iterdir():
        shutil.rmtree(folder)
    said = make(work, "book", "JOBS=2")
    assert "Pages: 2 executed, 0 reused." in said
    assert arrays(work / "book/_build/evidence/l04/cpu") == exported
