"""The throughput protocol, its model and its exercise on machines whose clock is known."""

from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.lessons.l06 import text, throughput
from robo_genesis.lessons.l06.exercises import Machine
from robo_genesis.lessons.l06.throughput import Protocol
from robo_genesis.sim.throughput import Model

SHORT = Protocol(sizes=(1, 4), warm_up=2, steps=5, repeats=3)


class Scene:
    """A scene on a simulated machine: its first step compiles, each other costs a + b · B."""

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
        self.q[:, dofs] = q


@pytest.fixture
def measured():
    machine, scenes = Machine(), {}

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
    assert scenes[size].steps == (SHORT.warm_up + SHORT.steps) * SHORT.repeats
    assert differ[str(size)] == 0


def test_a_row_that_ends_elsewhere_or_did_not_move_is_counted():
    q = np.tile(throughput.Q_START, (4, 1))
    assert throughput.unequal(q) == 4
    q[:, :7] += throughput.RAISED
    q[2, 8] += 1e-7
    assert (throughput.unequal(q), throughput.unequal(q[:2])) == (1, 0)


@pytest.fixture
def known():
    """Times that follow the model below 1024 environments, and memory of 100 + B MiB."""
    of = Model(0.0006, 16e-6)
    found = {}
    for size in throughput.DEEPER.sizes:
        time = float(of.step_time(size)) * (2 if size == 1024 else 1)
        found |= {
            f"build_{size}": 1.0,
            f"memory_{size}": 100.0 + size,
            f"step_{size}": time,
        }
        found |= {f"fastest_{size}": time / 1.1, f"slowest_{size}": 1.1 * time}
    others = {"step_four_of_256": 0.016984, "step_four_of_250": 0.0168}
    for part, each in (("sphere", 2e-6), ("robot_1", 9e-6), ("robot_4", 3e-5)):
        others |= {
            f"step_{part}_{size}": 0.0004 + size * each for size in throughput.ENDS
        }
    return SimpleNamespace(readings={throughput.GROUP: found | others})


@pytest.mark.parametrize(
    ("table", "says"),
    [
        ("throughput_table", "| 4 | 0.664 | 1.08 | 6,020 |"),
        ("throughput_table", "| 1000 | 16.6 | 26.9 | **60,200** |"),
        ("throughput_details", "| 4 | 0.604 to 0.73 | 15.1 | 1.0 | 104 |"),
        ("model_table", "| 64, fitted | 1.62 | 1.6 to 1.6 | 1.00 to 1.00 |"),
        ("model_table", "| 1024 | 34 | 17 to 17 | 2.00 to 2.00 |"),
        ("constants_table", "*b*, the part of each environment [µs] | 16 to 16 |"),
        ("parts_table", "| robot, substeps: 4 | 0.4 | 30 |"),
        ("parts_table", "| sphere, substeps: 2 | 0.4 | 2 |"),
        ("cache_table", "| one scene of 1024 | 34 | 33.2 |"),
        ("cache_table", "| four scenes of 256, in turn | 17 | 16.6 |"),
        ("cache_table", "| four scenes of 250, in turn | 16.8 | 16.8 |"),
    ],
)
def test_tables_give_the_known_values(known, table, says):
    assert says in getattr(text, table)(known)
