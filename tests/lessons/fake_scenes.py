"""Scenes and bodies without the engine, as students' functions call them."""

from types import SimpleNamespace

import numpy as np
import torch


class FakeBody:
    """A body that falls by semi-implicit Euler until it lies on a floor, where friction stops it.

    Args:
        mass: [kg].
        height: of its centre at the start [m].
        floor: height of its centre at rest [m].
        fixed: whether it stays in its place.
        friction: its coefficient.
    """

    def __init__(self, mass, height, floor=-np.inf, fixed=False, friction=0.5):
        self.mass, self.height, self.floor, self.fixed = mass, height, floor, fixed
        self.friction, self.geoms = friction, [SimpleNamespace(idx=self)]
        self.reset()

    def reset(self):
        self.z, self.velocity = self.height, np.zeros(6)

    def fall(self, h):
        self.velocity[2] -= 9.81 * h
        self.z += self.velocity[2] * h
        if self.z < self.floor:
            self.z, self.velocity = self.floor, np.zeros(6)

    def get_mass(self):
        return self.mass

    def get_pos(self):
        return torch.tensor([0.0, 0.0, self.z], dtype=torch.float64)

    def get_vel(self):
        return torch.tensor(self.velocity[:3])

    def get_ang(self):
        return torch.tensor(self.velocity[3:])

    def set_dofs_velocity(self, velocity):
        self.velocity[:] = velocity


class FakeScene:
    """A scene with bodies."""

    def __init__(self, *bodies, dt=0.01, substeps=2):
        self.bodies, self.dt, self.substeps = bodies, dt, substeps
        of_bodies = lambda bodies: torch.tensor([bodies[0].friction])  # noqa: E731
        self.rigid_solver = SimpleNamespace(get_geoms_friction=of_bodies)

    def reset(self):
        for body in self.bodies:
            body.reset()

    def step(self):
        for body in self.bodies:
            for _ in range(0 if body.fixed else self.substeps):
                body.fall(self.dt / self.substeps)
