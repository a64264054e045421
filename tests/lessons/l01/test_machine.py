"""The processes that L01 starts: what they print, and failures on purpose."""

import json
import tempfile
from pathlib import Path

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


def test_both_starts_share_one_folder_of_kernels(monkeypatch):
    seen = []

    def output(arguments, changed):
        seen.append(changed)
        return "a line of the engine\n" + json.dumps([1, 2, 3, 4, len(seen)])

    monkeypatch.setattr(machine, "run_python", output)
    found = machine.measure_starts()
    assert seen[0] == seen[1]
    assert Path(seen[0][project.KERNELS]).is_relative_to(tempfile.gettempdir())
    assert list(found) == [
        f"{start}_{part}" for start in machine.STARTS for part in machine.PARTS
    ]
    assert (found["first_first_step"], found["second_first_step"]) == (1, 2)
