"""The tests of the student's functions: our solutions pass, and typical wrong ones fail."""

from types import SimpleNamespace

import numpy as np
import pytest
import torch
from lessons.exercise_cells import require_exercise, solutions

from robo_genesis.lessons.l03 import exercises, spec

SOLVED = solutions("l03")


class FakeBody:
    """A box that falls until it rests on the table, and is pushed."""

    def __init__(self, morph, material):
        self.morph, self.material = morph, material
        self.geoms = [SimpleNamespace(idx=id(self))]
        self.reset()

    def reset(self):
        self.z, self.velocity = float(self.morph.pos[2]), np.zeros(6)

    def get_mass(self):
        return self.material.rho * float(np.prod(self.morph.size))

    def get_pos(self):
        return torch.tensor([*self.morph.pos[:2], self.z], dtype=torch.float64)

    def get_vel(self):
        return torch.tensor(self.velocity[:3])

    def get_ang(self):
        return torch.tensor(self.velocity[3:])

    def set_dofs_velocity(self, velocity, dofs_idx_local=None):
        where = slice(None) if dofs_idx_local is None else dofs_idx_local
        self.velocity[where] = velocity


class FakeScene:
    """A scene in which what is not fixed falls to the height of a cube at rest."""

    def __init__(self, sim_options, **_):
        self.dt, self.substeps = sim_options.dt, sim_options.substeps
        self.is_built, self.bodies = False, []
        self.rigid_solver = SimpleNamespace(get_geoms_friction=self.friction)

    def add_entity(self, morph, material=None, **_):
        self.bodies.append(FakeBody(morph, material or rigid()))
        return self.bodies[-1]

    def build(self):
        self.is_built = True

    def reset(self):
        for body in self.bodies:
            body.reset()

    def step(self):
        for body in self.bodies:
            if not body.morph.fixed:
                body.z = max(spec.BASELINE.rest_height - 1e-4, body.z - 0.01)
                body.velocity[:] = 0  # friction stops it at once

    def friction(self, geoms):
        (body,) = (body for body in self.bodies if body.geoms[0].idx == geoms[0])
        return torch.tensor([body.material.friction])


def rigid(rho=200.0, friction=1.0):
    return SimpleNamespace(rho=rho, friction=friction)


def box(size, pos, fixed=False):
    return SimpleNamespace(size=size, pos=pos, fixed=fixed)


GS = SimpleNamespace(
    Scene=FakeScene,
    options=SimpleNamespace(
        SimOptions=lambda dt=0.01, substeps=1: SimpleNamespace(dt=dt, substeps=substeps),
        ProfilingOptions=lambda **_: None,
    ),
    morphs=SimpleNamespace(Box=box),
    materials=SimpleNamespace(Rigid=rigid),
)


def scene_with(substeps=2, fixed=True, rho=500, friction=0.5, table=0.7, build=True):
    """Return a function that makes the scene with one mistake."""

    def make(gs):
        scene = gs.Scene(gs.options.SimOptions(dt=0.01, substeps=substeps))
        surface = scene.add_entity(
            gs.morphs.Box(size=(2.0, 0.8, 0.05), pos=(0, 0, table), fixed=fixed),
            material=gs.materials.Rigid(friction=0.8),
        )
        cube = scene.add_entity(
            gs.morphs.Box(size=(0.08, 0.08, 0.08), pos=(0, 0, 1.0)),
            material=gs.materials.Rigid(rho=rho, friction=friction),
        )
        if build:
            scene.build()
        return scene, surface, cube

    return make


def pushed(scene, cube, velocity, steps):
    for _ in range(steps):
        scene.step()
    cube.set_dofs_velocity(velocity)


def push_first(scene, cube, speed, settle):
    cube.set_dofs_velocity([speed, 0, 0, 0, 0, 0])
    for _ in range(30):
        scene.step()


def contacts_of(cube, table):
    return cube.get_contacts(with_entity=table)["penetration"]


def first_slow(t, x, speed):
    k = int(np.flatnonzero(np.abs(speed) < 0.01)[0])
    return t[k], x[k] - x[0]


def end_for_none(t, x, speed):
    found = SOLVED["stop"](t, x, speed)
    return (t[-1], x[-1] - x[0]) if found[0] is None else found


WRONG = {
    "scene": {
        "one substep": scene_with(substeps=1),
        "a table that falls": scene_with(fixed=False),
        "the default density": scene_with(rho=200),
        "the friction of the table": scene_with(friction=0.8),
        "a table at half height": scene_with(table=0.725),
        "not built": scene_with(build=False),
        "not written": lambda gs: (_ for _ in ()).throw(NotImplementedError("write it")),
    },
    "push": {
        "before it settles": push_first,
        "not settled": lambda scene, cube, v, s: pushed(scene, cube, [v, 0, 0, 0, 0, 0], 0),
        "settled in milliseconds": lambda scene, cube, v, s: pushed(
            scene, cube, [v, 0, 0, 0, 0, 0], round(1000 * s)
        ),
        "along y": lambda scene, cube, v, s: pushed(scene, cube, [0, v, 0, 0, 0, 0], 30),
        "all DOFs": lambda scene, cube, v, s: pushed(scene, cube, [v] * 6, 30),
    },
    "contact_reading": {
        "all bodies": lambda cube, table: (
            len(cube.get_contacts()["penetration"]),
            float(max(cube.get_contacts()["penetration"].tolist(), default=0.0)),
        ),
        "largest of nothing": lambda cube, table: (
            len(contacts_of(cube, table)), contacts_of(cube, table).max().item()
        ),
        "the first contact": lambda cube, table: (
            len(contacts_of(cube, table)),
            float(next(iter(contacts_of(cube, table).tolist()), 0.0)),
        ),
        "the sum": lambda cube, table: (
            len(contacts_of(cube, table)), contacts_of(cube, table).sum().item()
        ),
        "one value": lambda cube, table: (len(contacts_of(cube, table)),),
    },
    "landing": {
        "the sign of the depth": lambda clear: (clear.min(), SOLVED["landing"](clear)[1]),
        "the start as rebound": lambda clear: (SOLVED["landing"](clear)[0], clear.max()),
        "after the deepest sample": lambda clear: (
            SOLVED["landing"](clear)[0], max(0.0, clear[clear.argmin() + 1:].max(initial=0.0))
        ),
        "depth of what never lands": lambda clear: (-clear.min(), SOLVED["landing"](clear)[1]),
    },
    "stopping": {
        "the first slow sample": first_slow,
        "speed with its sign": lambda t, x, speed: SOLVED["stop"](t, x, np.maximum(speed, 0)),
        "position for distance": lambda t, x, speed: (
            SOLVED["stop"](t, x, speed)[0],
            None if SOLVED["stop"](t, x, speed)[0] is None
            else SOLVED["stop"](t, x, speed)[1] + x[0],
        ),
        "end of the window for not observed": end_for_none,
    },
}  # fmt: skip
OURS = {"scene": "make_scene", "push": "push", "contact_reading": "read_contacts",
        "landing": "landing", "stopping": "stop"}  # fmt: skip


@pytest.fixture
def tested(experiments):
    """Return the checks of one exercise for a function."""
    run = experiments["lab"]

    def test(name, function):
        scene, _, cube = SOLVED["make_scene"](GS)
        landings = [(run.traces[n], c, run.metrics[n]) for n, c in spec.LANDINGS.items()]
        more = {
            "scene": (GS, spec.BASELINE),
            "push": (scene, cube, spec.PUSHED),
            "contact_reading": (),
            "landing": (landings,),
            "stopping": ([(run.traces[n], run.metrics[n]) for n in spec.SLIDES],),
        }[name]
        return getattr(exercises, name)(function, *more)

    return test


@pytest.mark.parametrize("name", OURS)
def test_our_solution_passes(tested, name):
    (check,) = tested(name, SOLVED[OURS[name]])
    assert check.passed, check.detail


@pytest.mark.parametrize(("name", "how"), [(n, how) for n, of in WRONG.items() for how in of])
def test_a_wrong_solution_fails_and_its_check_says_what_was_found(tested, name, how):
    (check,) = tested(name, WRONG[name][how])
    assert not check.passed
    assert "expected" in check.detail or "raised" in check.detail


def test_each_function_has_at_least_three_wrong_solutions():
    assert all(len(found) >= 3 for found in WRONG.values())
    assert WRONG.keys() == OURS.keys()


@pytest.mark.parametrize("name", OURS.values())
def test_the_student_writes_at_most_fifteen_lines_below_a_docstring(name):
    require_exercise("l03", name)
