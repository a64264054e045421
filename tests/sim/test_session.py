"""The environment contract, the start of the engine, its backend and its log."""

import inspect
import logging
import os
import subprocess
import sys
from dataclasses import replace
from types import SimpleNamespace
from unittest.mock import Mock

import numpy as np
import pytest

from robo_genesis.core import project
from robo_genesis.sim import session
from robo_genesis.sim.session import (
    Backend,
    Contract,
    EngineError,
    read_contract,
    start,
)

BACKEND, RENDER, OUTPUTS = (
    f"ROBO_GENESIS_{name}" for name in ("BACKEND", "RENDER", "OUTPUTS_DIR")
)


def test_the_environment_has_the_contract(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert read_contract({}) == Contract("cpu", True, tmp_path / "outputs")
    given = {BACKEND: "auto", RENDER: "0", OUTPUTS: "deep/outputs"}
    assert read_contract(given) == Contract("auto", False, tmp_path / "deep/outputs")


@pytest.mark.parametrize(
    ("environ", "message"),
    [
        ({BACKEND: "gpu"}, f"{BACKEND}='gpu' is not valid. Choose one of: auto, cpu."),
        ({RENDER: "true"}, f"{RENDER}='true' is not valid. Choose one of: 0, 1."),
        ({OUTPUTS: "file"}, "cannot be written"),
    ],
)
def test_a_value_that_is_not_valid_is_refused(tmp_path, monkeypatch, environ, message):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").touch()
    with pytest.raises(session.ContractError) as caught:
        read_contract(environ)
    assert message in str(caught.value)


def test_a_start_without_the_engine_names_what_installs_it(tmp_path, monkeypatch):
    monkeypatch.setattr(session.ctypes, "CDLL", Mock())
    monkeypatch.setitem(sys.modules, "genesis", None)  # as if it were not installed
    with pytest.raises(
        EngineError, match=r"Genesis cannot be imported: .* requirements\.lock"
    ):
        start(Contract("cpu", True, tmp_path))


def test_a_started_engine_is_not_started_again(tmp_path, monkeypatch):
    started = SimpleNamespace(_initialized=True, backend=SimpleNamespace(name="cuda"))
    monkeypatch.setattr(session, "import_engine", lambda: started)
    with pytest.raises(EngineError, match=r"backend cuda.*restart the kernel"):
        start(Contract("cpu", True, tmp_path))


class FakeEngine(SimpleNamespace):
    """An engine that starts as the real one and logs a line."""

    cpu, gpu, __version__, _initialized = "cpu", "gpu", "1.3.3", False

    def init(
        self,
        *,
        backend,
        seed,
        precision="32",
        use_deterministic_algorithms=False,
        **log,
    ):
        self._initialized, self.SEED = True, seed
        self.backend = SimpleNamespace(name=backend)
        self.np_float = {"32": np.float32, "64": np.float64}[precision]
        self.use_deterministic_algorithms = use_deterministic_algorithms
        if log.get("logging_level") == "info":
            logging.getLogger("genesis").warning("initialised")


@pytest.fixture
def fake_engine(monkeypatch):
    for name in [
        name for name in os.environ if name.startswith(project.ENGINE_PREFIXES)
    ]:
        monkeypatch.delenv(name)
    engine = FakeEngine()
    found = Backend("cpu", "cpu", "x64", "cpu", "2.13.0", None, None, "a CPU")
    monkeypatch.setattr(session, "import_engine", lambda: engine)
    monkeypatch.setitem(
        sys.modules, "genesis", SimpleNamespace(__file__="/packages/genesis/x")
    )
    monkeypatch.setitem(sys.modules, "quadrants", SimpleNamespace(__version__=(1, 2)))
    monkeypatch.setattr(
        session, "probe", lambda requested: replace(found, requested=requested)
    )
    monkeypatch.setitem(sys.modules, "genesis.styles", SimpleNamespace())
    for kept in ("handlers", "filters"):
        monkeypatch.setattr(logging.getLogger("genesis"), kept, [])
    return engine


def test_a_start_keeps_the_log_and_the_user_s_switches(
    fake_engine, tmp_path, monkeypatch
):
    monkeypatch.setenv("GS_ENABLE_ZEROCOPY", "0")
    monkeypatch.setenv("QD_ENABLE_PYBUF", "1")  # as the import of the real engine does
    engine = start(Contract("cpu", True, tmp_path))
    assert engine.switches == {"GS_ENABLE_ZEROCOPY": "0"}
    assert engine.log.text() == "WARNING initialised\n"


VALID = session.ARGUMENTS
KEPT = {"logging_level": "info"}


@pytest.mark.parametrize(
    ("asked", "given", "message"),
    [
        (
            True,
            VALID | KEPT | {"seed": None},
            "'seed': None.*valid is .*'seed': 0.*Restart the",
        ),
        (True, VALID, r"its log was not kept. Restart the kernel .*\*\*rg.PLAIN_LOG"),
        (False, VALID | KEPT, "its log was not kept"),
    ],
)
def test_an_engine_with_other_arguments_is_refused(
    fake_engine, tmp_path, asked, given, message
):
    contract = Contract("cpu", True, tmp_path)
    backend = session.requested_backend(contract) if asked else "cpu"
    fake_engine.init(backend=backend, **given)
    with pytest.raises(EngineError, match=message):
        session.started(contract)


def test_the_device_has_the_name_in_the_log(fake_engine, tmp_path):
    session.requested_backend(Contract("cpu", True, tmp_path))
    line = "Running on ~~<[A [fast] CPU]>~~ with backend ~~<gs.cpu>~~. Memory: 8 GB."
    logging.getLogger("genesis").warning(line)
    assert session._device_name(None) == "A [fast] CPU"


@pytest.mark.engine
def test_the_engine_itself_sets_no_other_switch_when_it_is_imported():
    code = (
        "from robo_genesis.core.project import engine_switches as found; "
        "before = found(); import genesis; assert found() == before"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=project.ROOT)


CUDA = Backend("auto", "cuda", "cuda", "cuda", "2.13.0", None, "12.8", "device")


@pytest.mark.parametrize("change", [{"torch_device": "cpu"}, {"requested": "cpu"}])
def test_a_disagreement_names_the_remedy(change):
    session.require_agreement(CUDA)
    with pytest.raises(EngineError, match=r"disagree about .*Unset QD_ARCH"):
        session.require_agreement(replace(CUDA, **change))


def test_python_knows_the_module_of_its_frozen_importer(monkeypatch):
    """Without an entry it searches all modules, for each function that Quadrants decorates."""
    name = "<frozen importlib._bootstrap>"
    monkeypatch.delitem(inspect.modulesbyfile, name, raising=False)
    with monkeypatch.context() as patch:
        patch.setattr(session.importlib, "import_module", Mock())
        session.import_engine()
    assert inspect.getmodule(inspect.currentframe(), name).__name__.endswith(
        "importlib._bootstrap"
    )
