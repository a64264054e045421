"""A new process of Python: its output, and errors that say how it ended."""

import pytest

from robo_genesis.sim import fresh_process
from robo_genesis.sim.fresh_process import StartError, last_value, run_python


def test_it_prints_with_the_changed_environment():
    code = "import os; print(os.environ['GIVEN'])"
    assert run_python(["-c", code], {"GIVEN": "a value"}) == "a value\n"


def test_a_process_without_output_is_an_error():
    with pytest.raises(StartError, match="exit status 0, expected 0 and some output"):
        run_python(["-c", ""], {})


def test_a_failed_process_is_an_error_with_its_last_lines():
    with pytest.raises(StartError, match=r"status 1, expected 0 (.|\n)*begun\n(.|\n)*NameError"):
        run_python(["-c", "print('begun'); nothing"], {})


def test_other_statuses_can_be_valid():
    arguments = ["-c", "print('broken'); raise SystemExit(1)"]
    assert run_python(arguments, {}, statuses=(0, 1)) == "broken\n"
    with pytest.raises(StartError, match="status 1, expected 0 or 2"):
        run_python(arguments, {}, statuses=(0, 2))


def test_a_process_that_hangs_is_an_error(monkeypatch):
    monkeypatch.setattr(fresh_process, "TIMEOUT", 1)
    hanging = "import time; print('waits', flush=True); time.sleep(60)"
    with pytest.raises(StartError, match=r"not ended after 1 s and was killed[^:]*:\nwaits"):
        run_python(["-c", hanging], {})


def test_the_value_is_on_the_last_line():
    assert last_value("a line of the engine\n[1, 2]\n\n") == [1, 2]
    with pytest.raises(StartError, match="found: 'no JSON'"):
        last_value("[1]\nno JSON\n")
