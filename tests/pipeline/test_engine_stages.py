"""A page of the course executed alone and beside another, in a clone with caches of its own.

The clone has a small book: the cells of the L04 lab without its prose, and a ball that
    falls.
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
    _, front, body = (
        (BOOK / "lessons/l04-joint-control/lab.md").read_text().split("---\n", 2)
    )
    lab = f"---\n{front}---\n# Lab\n\n" + "\n\n".join(CELLS.findall(body))
    make_book(work, lab=lab, ball=notebook(cell(BALL), title="Ball"))
    return work


def arrays(bundle: Path) -> dict[str, bytes]:
    """Return every file of arrays of a bundle."""
    return {path.stem: path.read_bytes() for path in (bundle / "arrays").glob("*.npz")}


def test_results_depend_neither_on_jobs_nor_on_the_caches(tmp_path):
    """The lab alone with a cold cache, then beside another page with the kernels of that run."""
    work = clone(tmp_path, "lab")
    said = make(work, "execute", "PAGE=l04/lab")
    assert "lab  executed in" in said
    [cold] = (work / ".cache/pages").glob("lab/*/outputs/cpu")
    cold_arrays = arrays(cold)
    assert cold_arrays.keys() == {"baseline", "G1", "G2", "G3"}
    assert list(work.glob(".cache/engine/*/kernels/**/*.qdc"))
    for folder in (work / ".cache" / "pages").iterdir():
        shutil.rmtree(folder)
    said = make(work, "book", "JOBS=2")
    assert "Pages: 2 executed, 0 reused." in said
    assert arrays(work / "book/_build/evidence/l04/cpu") == cold_arrays
