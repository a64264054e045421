"""Runs without the engine for most tests; one real engine and one built scene for the rest."""

import os
import signal
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import settings
from lessons.changed_runs import passed
from robot_runs import driven
from xdist.scheduler import LoadScopeScheduling

from robo_genesis.core import project
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import CAMERA, DT, FRAME_SHAPE, SUBSTEPS
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.lessons.l04.pages import LAB
from robo_genesis.pipeline import stages
from robo_genesis.sim import session
from robo_genesis.sim.arm import joints as robot_model
from robo_genesis.sim.arm.franka import FRANKA_MJCF, JOINT_NAMES, per_joint
from robo_genesis.sim.arm.joints import JointMap

pytest_plugins = ("bundles", "built_site")

# Tests send SIGINT to the commands that they start; a shell that starts pytest with &
# ignores it.
signal.signal(signal.SIGINT, signal.default_int_handler)

# The same examples each time, and no time limit: shared machines stall.
settings.register_profile("course", derandomize=True, deadline=None)
settings.load_profile("course")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--slow", action="store_true", help="run the slow tests as well")


def pytest_collection_modifyitems(
    config: pytest.Config, items: list[pytest.Item]
) -> None:
    """Leave slow tests out unless `--slow` asks for them, and put long ones first.

    What runs the engine and the visits of all pages come first, because they are the
    longest scopes of one process. The tests that use the engine of this process precede
    those that start one elsewhere or build. Small tests come last, so that all
    processes end at about the same time.
    """
    for item in items:
        if uses_engine(item) and not item.get_closest_marker("engine"):
            raise pytest.UsageError(
                f"{item.nodeid} starts the engine. Give it the mark `engine`."
            )
    left_out = (
        [] if config.option.slow else [i for i in items if i.get_closest_marker("slow")]
    )
    config.hook.pytest_deselected(items=left_out)

    def turn(item: pytest.Item) -> tuple[int, bool]:
        order = [ENGINE, SWEEP, BUILDS, BROWSER, SMALL]
        return order.index(kind(item.path)), not uses_engine(item)

    items[:] = sorted((item for item in items if item not in left_out), key=turn)


ENGINE, SWEEP, BUILDS, BROWSER, SMALL = "engine", "sweep", "builds", "browser", "small"


@cache
def kind(path: Path) -> str:
    """Return what most tests of a file need."""
    if path.name == "test_sweep.py":
        return SWEEP
    text = path.read_text()
    if "mark.browser" in text:
        return BROWSER
    if "mark.engine" in text:
        return ENGINE
    return BUILDS if {"pipeline", "maintain"} & {*path.parts} else SMALL


def uses_engine(item: pytest.Item) -> bool:
    """Return whether a test uses the engine of this process."""
    return "real_engine" in getattr(item, "fixturenames", ())


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> None:
    """End the engine after the last test that uses it: tests that build need the lock."""
    if uses_engine(item) and not (nextitem and uses_engine(nextitem)):
        item.config.stash[STARTED].close()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> LoadScopeScheduling:
    """Run all modules that start the engine in one process: they take the lock of builds.

    Tests in a browser read the site that was built before.
    """
    # Groups of pytest-xdist 3.8 have no effect with pytest 9.2 (its issue 1386).

    class ByModule(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            file = nodeid.partition("::")[0]
            if kind(config.rootpath / file) == SWEEP:
                return nodeid.partition("[")[2].partition("-")[
                    0
                ]  # each way to visit all pages
            return ENGINE if kind(config.rootpath / file) == ENGINE else file

    return ByModule(config, log)


LINKS = ("link0", "link4", "hand")


@pytest.fixture(scope="session")
def make_trace() -> Callable[..., Trace]:
    """Build a run of one joint from its positions; arrays that are not given are zero."""

    def build(q, target, *, dt=DT, effort_limit=87.0, **given) -> Trace:
        n = len(q) - 1
        steps = {"qd": 0.0, "control_force": 0.0, "internal_force": 0.0} | given
        return Trace(
            t=np.arange(n + 1) * dt,
            q=np.reshape(q, (-1, 1)),
            target=np.full((n, 1), np.reshape(target, (-1, 1)), float),
            **{
                name: np.full((n, 1), np.reshape(v, (-1, 1)), float)
                for name, v in steps.items()
            },
            start_control_force=np.zeros(1),
            start_qd=np.zeros(1),
            effort_limit=np.array([effort_limit]),
            link_pos=np.zeros((n + 1, 1, 3)),
            link_quat=np.zeros((n + 1, 1, 4)),
        )

    return build


@pytest.fixture(scope="session")
def joints() -> JointMap:
    """The Franka's map as the engine reports it."""
    return JointMap(
        names=JOINT_NAMES,
        types=l04.EXPECTED_TYPES,
        dofs_idx_local=np.arange(9),
        qs_idx_local=np.arange(9),
        lower=per_joint(
            -2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973, 0, 0
        ),
        upper=per_joint(
            2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973, 0.04, 0.04
        ),
    )


@pytest.fixture(scope="session")
def traces() -> dict[str, Trace]:
    """Runs of the four cases of L04 by the engine's rule of stepping."""
    return {name: driven(case, LINKS) for name, case in l04.CASES.items()}


@pytest.fixture(scope="session")
def frames() -> dict[str, np.ndarray]:
    """Two different pictures of the course's shape."""
    initial = (
        np.arange(np.prod(FRAME_SHAPE), dtype=np.uint32)
        .astype(np.uint8)
        .reshape(FRAME_SHAPE)
    )
    final = initial.copy()
    final[200:300] += 1
    return {"initial": initial, "final": final}


@pytest.fixture(scope="session")
def experiment(joints, traces, frames) -> Experiment:
    """A synthetic run of L04's lab that passes every check."""
    readings = {"model": l04.EXPECTED_MODEL, **passed(LAB)}
    return Experiment(
        LAB, traces, LINKS, readings, frames, rendered=True, joints=joints
    )


STARTED = pytest.StashKey[ExitStack]()


@pytest.fixture(scope="session")
def real_engine(request, tmp_path_factory) -> Iterator[SimpleNamespace]:
    """Real engine, started once in this process; `pytest_runtest_teardown` ends it.

    It holds the lock of builds, because a build would remove the lock files of the
    engine as stale."""
    contract = session.Contract("cpu", True, tmp_path_factory.mktemp("outputs"))
    with ExitStack() as started:
        request.config.stash[STARTED] = started
        started.enter_context(stages.build_lock(project.CACHE))
        # The engine sets switches, too; with one left, a build would execute every page
        # again.
        started.enter_context(
            patch.dict(os.environ, project.engine_cache_environment())
        )
        engine = session.start(contract)
        import genesis as gs

        # It saves the compiled kernels, while the log can still be written.
        started.callback(gs.destroy)
        yield SimpleNamespace(gs=gs, contract=contract, engine=engine)


@pytest.fixture(scope="session")
def lab(real_engine: SimpleNamespace) -> SimpleNamespace:
    """The scene of the lab of L04, built once."""
    gs = real_engine.gs
    scene = gs.Scene(
        sim_options=gs.options.SimOptions(dt=DT, substeps=SUBSTEPS), show_viewer=False
    )
    scene.add_entity(gs.morphs.Plane())
    franka = scene.add_entity(gs.morphs.MJCF(file=FRANKA_MJCF))
    camera = scene.add_camera(**CAMERA)
    scene.build()
    joints = robot_model.resolve_joints(franka, JOINT_NAMES)
    made = {"scene": scene, "franka": franka, "camera": camera, "joints": joints}
    return SimpleNamespace(**vars(real_engine), **made)


@pytest.fixture
def no_file(tmp_path: Path) -> Path:
    """A path that nobody may create, root included: its parent is a regular file."""
    (tmp_path / "file").write_text("")
    return tmp_path / "file" / "below"
