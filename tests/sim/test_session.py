"""The environment contract, the start of the engine, its backend and its log."""

import logging
import os
import sys
from dataclasses import replace
from types import SimpleNamespace

import pytest

from robo_genesis.core import project
from robo_genesis.sim import session
from robo_genesis.sim.session import (
    Backend,
    Contract,
    ContractError,
    EngineError,
    EngineLog,
    import_engine,
    read_contract,
    require_agreement,
    start,
)

BACKEND, RENDER, OUTPUTS = (f"ROBO_GENESIS_{name}" for name in ("BACKEND", "RENDER", "OUTPUTS_DIR"))


@pytest.mark.parametrize(
    ("environ", "backend", "render", "folder"),
    [
        ({}, "cpu", True, "outputs"),
        ({BACKEND: "auto", RENDER: "0", OUTPUTS: "deep/outputs"}, "auto", False, "deep/outputs"),
    ],
)
def test_the_contract_is_read_from_the_environment(
    tmp_path, monkeypatch, environ, backend, render, folder
):
    monkeypatch.chdir(tmp_path)
    contract = Contract(backend, render, tmp_path / folder)
    assert read_contract(environ) == contract
    assert list(contract.outputs.iterdir()) == []
    for variable in (BACKEND, RENDER, OUTPUTS):
        monkeypatch.delenv(variable, raising=False)
    for variable, value in environ.items():
        monkeypatch.setenv(variable, value)
    assert read_contract() == contract


@pytest.mark.parametrize(
    ("variable", "value", "choices"),
    [(BACKEND, value, "auto, cpu") for value in ("gpu", "amdgpu", "CPU", " cpu", "")]
    + [(RENDER, value, "0, 1") for value in ("true", "2", "01", "")],
)
def test_any_other_value_names_variable_value_and_choices(tmp_path, variable, value, choices):
    with pytest.raises(ContractError) as caught:
        read_contract({OUTPUTS: str(tmp_path), variable: value})
    assert str(caught.value) == f"{variable}={value!r} is not valid. Choose one of: {choices}."


def test_an_outputs_folder_that_cannot_be_made_is_refused(no_file):
    for path in (no_file, no_file.parent):  # below a file, and the file itself
        with pytest.raises(ContractError, match=f"{OUTPUTS}='{path}' cannot be written"):
            read_contract({OUTPUTS: str(path)})


def test_an_outputs_folder_that_cannot_be_written_is_refused(tmp_path, monkeypatch):
    def refuse(dir):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(session.tempfile, "TemporaryFile", refuse)
    with pytest.raises(ContractError, match="Permission denied"):
        read_contract({OUTPUTS: str(tmp_path)})


def test_a_start_without_egl_names_the_command_that_installs_it(tmp_path, monkeypatch):
    def load(name):
        if name == "libEGL.so.1":
            raise OSError(f"{name}: cannot open shared object file")

    monkeypatch.setattr(session.ctypes, "CDLL", load)
    monkeypatch.setitem(sys.modules, "genesis", None)  # as if: its import must not be reached
    with pytest.raises(EngineError, match=r"libEGL\.so\.1 .*apt install libegl1 libgl1"):
        start(Contract("cpu", True, tmp_path))


def test_a_missing_engine_names_the_lock(monkeypatch):
    monkeypatch.setitem(sys.modules, "genesis", None)
    monkeypatch.setattr(session, "require_libraries", lambda *names: None)
    with pytest.raises(EngineError, match=r"requirements.lock"):
        import_engine()


def test_a_started_engine_is_not_started_again(tmp_path, monkeypatch):
    started = SimpleNamespace(_initialized=True, backend=SimpleNamespace(name="cuda"))
    monkeypatch.setattr(session, "import_engine", lambda: started)
    with pytest.raises(EngineError, match=r"backend cuda.*restart the kernel"):
        start(Contract("cpu", True, tmp_path))


def test_the_switches_are_those_of_before_the_engine(tmp_path, monkeypatch):
    """The engine sets some itself while it is imported, and again when it starts."""
    for name in [name for name in os.environ if name.startswith(project.ENGINE_PREFIXES)]:
        monkeypatch.delenv(name)
    monkeypatch.setenv("GS_ENABLE_ZEROCOPY", "0")
    engine = SimpleNamespace(cpu="cpu", __version__="1", init=lambda **options: None)

    def imported():
        monkeypatch.setenv("QD_ENABLE_PYBUF", "1")
        return engine

    monkeypatch.setattr(session, "import_engine", imported)
    monkeypatch.setitem(sys.modules, "quadrants", SimpleNamespace(__version__=(1, 2)))
    monkeypatch.setattr(session, "probe", lambda requested: None)
    monkeypatch.setitem(sys.modules, "genesis.styles", SimpleNamespace())
    for kept in ("handlers", "filters"):
        monkeypatch.setattr(logging.getLogger("genesis"), kept, [])
    assert start(Contract("cpu", True, tmp_path)).switches == {"GS_ENABLE_ZEROCOPY": "0"}


CUDA = Backend("auto", "cuda", "cuda", "cuda", "2.13.0", None, "12.8", "device")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"torch_device": "cpu"}, "disagree about the backend.*Unset QD_ARCH"),
        ({"requested": "cpu"}, "disagree about the backend.*Unset QD_ARCH"),
        ({"actual": "vulkan"}, "'vulkan' is unknown. Known: cpu, cuda, amdgpu, metal"),
    ],
)
def test_a_disagreement_names_the_remedy_or_the_known_backends(change, message):
    require_agreement(CUDA)
    with pytest.raises(EngineError, match=message):
        require_agreement(replace(CUDA, **change))


@pytest.fixture
def log():
    logger, log = logging.getLogger("engine under test"), EngineLog()
    logger.setLevel(logging.DEBUG)
    logger.addHandler(log)
    yield SimpleNamespace(logger=logger, kept=log)
    logger.removeHandler(log)


def test_the_log_drops_marks_and_keeps_everything_else(log):
    log.logger.info("Adding ~<RigidEntity>~ for ~~~<panda.xml>~~~, ~~~~<%s>~~~~ ~ 2 > 1", "twice")
    assert log.kept.text() == "INFO Adding RigidEntity for panda.xml, twice ~ 2 > 1\n"


def test_warnings_are_kept_in_order(log):
    for level, text in (("info", "a"), ("warning", "b"), ("debug", "c"), ("error", "d")):
        getattr(log.logger, level)(text)
    assert log.kept.warnings == ["b", "d"]
    assert log.kept.text() == "INFO a\nWARNING b\nDEBUG c\nERROR d\n"


def test_the_log_names_neither_the_environment_nor_the_user(monkeypatch, tmp_path):
    engine = SimpleNamespace(__file__=str(tmp_path / "packages" / "genesis" / "__init__.py"))
    monkeypatch.setitem(sys.modules, "genesis", engine)
    monkeypatch.setenv("HOME", str(tmp_path / "someone"))
    text = f"Read {tmp_path}/packages/genesis/a.xml, wrote ~<{tmp_path}/someone/.cache/b.gsd>~."
    record = logging.LogRecord("genesis", logging.INFO, "", 0, text, None, None)
    assert session.remove_private_paths(record)
    assert record.getMessage() == "Read site-packages/genesis/a.xml, wrote ~<~/.cache/b.gsd>~."


@pytest.mark.parametrize(("newer", "name"), [(True, "raw"), (False, "dumb")])
def test_the_theme_without_colours_has_the_name_that_the_engine_gives_it(monkeypatch, newer, name):
    styles = SimpleNamespace(**({"THEME": object} if newer else {}))
    monkeypatch.setitem(sys.modules, "genesis.styles", styles)
    assert session.plain_theme() == name
