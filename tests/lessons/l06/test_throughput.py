"""The throughput protocol, its model and its exercise on machines whose clock is known."""

import numpy as np
import pytest

from robo_genesis.lessons.l06 import throughput
from robo_genesis.lessons.l06.throughput import Protocol
from robo_genesis.lessons.l06.throughput_exercises import Machine
from robo_genesis.lessons.l06.throughput_exercises import throughput as exercise

SHORT = Protocol(sizes=(1, 4), warm_up=2, steps=5, repeats=3)


class Scene:
    """A scene on a pretended machine: its first step compiles, each other costs a + b · B."""

    def __init__(self, machine, size):
        self.machine, self.size, self.steps = machine, size, 0
        self.q, self.n_envs, self.scene = np.zeros((size, 9)), size, self

    def step(self):
        self.machine.now += 2.0 if self.steps == 0 else 0.001 + 0.0001 * self.size
        self.steps += 1

    def get_dofs_position(self):
        return self.q

    def set_dofs_position(self, q, zero_velocity):
        self.machine.now += 1000
        self.q = q

    def control_dofs_position(self, q, dofs):
        assert q.shape == (self.size, len(dofs))


@pytest.fixture
def measured():
    machine, scenes = Machine({}), {}

    def build(size):
        machine.now += 10 + size
        scenes[size] = Scene(machine, size)
        return scenes[size], scenes[size]

    memory = lambda: 50.0 + 3 * sum(scenes)  # noqa: E731
    return *throughput.measure(build, SHORT, machine.clock, memory), scenes


@pytest.mark.parametrize("size", SHORT.sizes)
def test_building_and_stepping_are_timed_apart_and_after_a_warm_up(measured, size):
    found, differ, scenes = measured
    time = dict.fromkeys(("step", "fastest", "slowest"), 0.001 + 0.0001 * size)
    expected = {"build": 10 + size, "memory": 3 * size, **time}
    assert {n: found[f"{n}_{size}"] for n in expected} == pytest.approx(expected)
    assert scenes[size].steps == SHORT.warm_up + SHORT.steps * SHORT.repeats
    assert differ[str(size)] == 0


def test_all_readings_are_declared_and_no_check_judges_a_time(measured):
    found, differ, _ = measured
    declared = SHORT.readings()
    assert declared[throughput.GROUP].kind == "performance"
    assert set(found) == set(declared[throughput.GROUP].units)
    assert set(differ) == set(declared[throughput.EQUAL].units)


def test_a_row_that_ends_elsewhere_is_counted(measured):
    *_, scenes = measured

    def build(size):
        scenes[size].set_dofs_position = lambda q, zero_velocity: scenes[size].q[-1:].fill(1)
        return scenes[size], scenes[size]

    _, differ = throughput.measure(build, SHORT, iter(range(999)).__next__, lambda: 0.0)
    assert differ == {"1": 0, "4": 1}


def written(step, finish, clock, warm_up, steps, repeats, *, middle=np.median, before=True,
            after=True, share=True, warm=True):  # fmt: skip
    """A solution; the last arguments make mistakes."""
    for _ in range(warm_up if warm else 0):
        step()
    times = []
    for _ in range(repeats):
        if before:
            finish()
        begin = clock()
        for _ in range(steps):
            step()
        if after:
            finish()
        times.append((clock() - begin) / (steps if share else 1))
    return middle(times)


def test_a_right_measurement_passes():
    (check,) = exercise(written)
    assert check.passed, check.detail


@pytest.mark.parametrize(
    "wrong",
    [
        {"middle": np.mean}, {"middle": max}, {"before": False}, {"after": False},
        {"share": False}, {"warm": False}, {"middle": lambda times: None},
    ],
)  # fmt: skip
def test_a_wrong_measurement_fails(wrong):
    (check,) = exercise(lambda *arguments: written(*arguments, **wrong))
    assert not check.passed
    assert "expected" in check.detail or "raised" in check.detail
