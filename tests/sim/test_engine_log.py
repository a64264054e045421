"""What is kept of the engine's log, and which paths it must not name."""

import logging
import sysconfig
from types import SimpleNamespace

import pytest

from robo_genesis.core.project import ROOT
from robo_genesis.sim.engine_log import EngineLog, remove_private_paths


@pytest.fixture
def log():
    logger, log = logging.getLogger("engine under test"), EngineLog()
    logger.setLevel(logging.DEBUG)
    logger.addHandler(log)
    yield SimpleNamespace(logger=logger, kept=log)
    logger.removeHandler(log)


def test_the_log_drops_marks_and_keeps_everything_else_in_order(log):
    log.logger.info(
        "Adding ~<RigidEntity>~ for ~~~<panda.xml>~~~, ~~~~<%s>~~~~ ~ 2 > 1", "twice"
    )
    for level, text in (("warning", "b"), ("debug", "c"), ("error", "d")):
        getattr(log.logger, level)(text)
    assert log.kept.warnings == ["b", "d"]
    said = "INFO Adding RigidEntity for panda.xml, twice ~ 2 > 1\n"
    assert log.kept.text() == f"{said}WARNING b\nDEBUG c\nERROR d\n"


def test_the_log_names_neither_the_environment_nor_the_user(monkeypatch, tmp_path):
    monkeypatch.setenv("HOME", str(tmp_path / "someone"))
    text = f"Read {sysconfig.get_path('purelib')}/genesis/a.xml, "
    text += f"wrote ~<{tmp_path}/someone/.cache/b.gsd>~, {ROOT}/robo_genesis/lessons/l07/door.xml."
    record = logging.LogRecord("genesis", logging.INFO, "", 0, text, None, None)
    assert remove_private_paths(record)
    said = "Read site-packages/genesis/a.xml, wrote ~<~/.cache/b.gsd>~, "
    assert record.getMessage() == f"{said}robo_genesis/lessons/l07/door.xml."
