"""The processes that L01 starts: what they print, and failures on purpose."""

import json
import tempfile
from pathlib import Path

import pytest

from robo_genesis.core import project
from robo_genesis.lessons.l01 import machine, text


def report(broken=None):
    place = len(machine.STEPS) if broken is None else machine.STEPS.index(broken)
    states = ["ok"] * place + ["broken"] + ["not run"] * len(machine.STEPS)
    pairs = zip(machine.STEPS, states, strict=False)
    steps = [
        {"step": step, "state": state, "found": f"about {step}"}
        for step, state in pairs
    ]
    return {"steps": steps, "broken": broken}


def test_steps_that_did_not_run_have_not_passed():
    assert machine.passed(report()) == dict.fromkeys(machine.STEPS, 1)
    found = machine.passed(report("build"))
    assert [name for name, count in found.items() if not count] == list(
        machine.STEPS[4:]
    )


def test_the_doctor_s_lines_fit_a_phone():
    step = {
        "step": "model_file",
        "state": "ok",
        "found": "xml/franka_emika_panda/panda.xml " * 9,
    }
    lines = text.doctor_lines([step, step | {"state": "not run"}]).splitlines()
    assert lines == [
        " 1  model_file: ok;",
        *["    xml/franka_emika_panda/panda.xml"] * 9,
    ]


@pytest.mark.parametrize(
    ("left", "shared"),
    [([], True), (["kernels/a.qdc"], False), (["numba/geom/a.nbi"], False)],
)
def test_both_starts_share_one_folder_which_is_that_of_all_pages_while_it_is_empty(
    monkeypatch, tmp_path, left, shared
):
    monkeypatch.setenv(project.KERNELS, str(tmp_path / "kernels"))
    monkeypatch.setenv(project.NUMBA, str(tmp_path / "numba"))
    for name in left:
        (tmp_path / name).parent.mkdir(parents=True)
        (tmp_path / name).touch()
    seen = []

    def output(arguments, changed):
        seen.append(changed)
        return "a line of the engine\n" + json.dumps([1, 2, 3, 4, len(seen)])

    monkeypatch.setattr(machine, "run_python", output)
    found = machine.measure_starts()
    assert seen[0] == seen[1]
    if shared:
        assert seen[0] == {}
    else:
        own = Path(seen[0][project.KERNELS])
        assert own.is_relative_to(tempfile.gettempdir())
        assert not own.is_relative_to(tmp_path)
    assert all((tmp_path / name).is_file() for name in left)  # a reader's stay
    assert list(found) == [
        f"{start}_{part}" for start in machine.STARTS for part in machine.PARTS
    ]
    assert (found["first_first_step"], found["second_first_step"]) == (1, 2)
