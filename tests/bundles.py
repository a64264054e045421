"""A bundle of the synthetic run, written by a recorder whose engine is not real."""

import shutil
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest
from spoilers import TORCH

from robo_genesis.core import project
from robo_genesis.core.experiment import Experiment
from robo_genesis.evidence import recorder as record
from robo_genesis.evidence.recorder import Recorder
from robo_genesis.lessons import find_page
from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.pipeline.bundles import verify as evidence_key
from robo_genesis.pipeline.bundles.verify import page_code
from robo_genesis.pipeline.pages.sources import running_modules
from robo_genesis.sim import session
from robo_genesis.sim.camera import frames as camera
from robo_genesis.sim.engine_log import EngineLog

QUADRANTS = project.locked_versions((project.ROOT / "requirements.lock").read_text())[
    "quadrants"
]
RUN_ID = "0123456789abcdef" * 2
RENDERER = camera.Renderer("Mesa", "llvmpipe")
LOG = [("INFO", "Running on [a CPU]"), ("WARNING", "Approximating tendon.")]


@pytest.fixture(scope="session")
def backend():
    return session.Backend(
        "cpu", "cpu", "x64", "cpu", "2.13.0+cpu", None, None, "a CPU"
    )


@pytest.fixture(scope="session")
def engine(backend):
    log = EngineLog()
    log.lines += LOG
    return session.Engine(project.engine_pin(), QUADRANTS, "32", 0, backend, log)


# What draws the frames on each backend.
GRAPHICS = {
    "cpu": RENDERER,
    "amdgpu": camera.Renderer("AMD", "AMD Instinct (radeonsi)"),
    "cuda": camera.Renderer("NVIDIA Corporation", "NVIDIA H100/PCIe/SSE2"),
}


def engine_on(engine: session.Engine, actual: str) -> session.Engine:
    """Return the engine as it would have started on a backend."""
    if actual == "cpu":
        return engine
    found = session.Backend(
        "auto", actual, actual, "cuda", device_name="a GPU", **TORCH[actual]
    )
    return replace(engine, backend=found)


@contextmanager
def without_engine(backend):
    """Replace the engine that the recorder probes, and the digests of its wheel."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(session, "probe", lambda requested: backend)
        patch.setattr(record, "files_match_wheel", lambda *names: True)
        for name in ("RUN_ID", "COMMAND", "PAGE_SHA256", "PAGE_IMPORTS"):
            patch.delenv(f"ROBO_GENESIS_{name}", raising=False)
        yield patch


@pytest.fixture
def quiet(backend):
    with without_engine(backend) as patch:
        yield patch


@pytest.fixture
def recorder(quiet, tmp_path, engine):
    return recorder_of(quiet, engine, tmp_path / "outputs", "l04", "lab")


def recorder_of(patch, engine, outputs: Path, lesson: str, page: str) -> Recorder:
    patch.setenv("ROBO_GENESIS_RUN_ID", RUN_ID)
    name_code(patch, lesson, page)
    rendered = find_page(lesson, page).camera
    contract = session.Contract("cpu", rendered, outputs)
    return Recorder(lesson, page, contract, engine, running_modules(lesson))


def name_code(patch, lesson: str, page: str) -> None:
    """Tell the recorder, as the build does, which page of the course runs."""
    digest, imports = page_code(lesson, page, project.BOOK)
    patch.setenv("ROBO_GENESIS_PAGE_SHA256", digest)
    patch.setenv("ROBO_GENESIS_PAGE_IMPORTS", " ".join(imports))


def written(
    engine, outputs: Path, lesson: str, page: str, experiment: Experiment
) -> Path:
    """Write the bundle of a page below a folder without a real engine, and return its folder."""
    with without_engine(engine.backend) as patch:
        return recorder_of(patch, engine, outputs, lesson, page).write(
            experiment,
            GRAPHICS[engine.backend.actual] if experiment.page.camera else None,
        )


@pytest.fixture(scope="session")
def pristine(tmp_path_factory, engine, experiment) -> Path:
    return written(
        engine, tmp_path_factory.mktemp("pristine"), "l04", "lab", experiment
    )


@pytest.fixture
def folder(pristine, tmp_path) -> Path:
    """A copy of the bundle that a test may spoil."""
    return Path(shutil.copytree(pristine, tmp_path / "l04" / "lab" / "cpu"))


@pytest.fixture
def courses_pages(monkeypatch):
    """Verify bundles of a synthetic book against the pages of the course."""
    monkeypatch.setattr(
        evidence_key, "page_code", lambda *of: page_code(*of[:2], project.BOOK)
    )


@pytest.fixture
def undecided(monkeypatch):
    """Give the orderings that L04 claims margins so wide that no bundle shows them."""
    wide = tuple((pair, metric, order, 1e6) for pair, metric, order, _ in l04.RELATIONS)
    monkeypatch.setattr(l04, "RELATIONS", wide)
