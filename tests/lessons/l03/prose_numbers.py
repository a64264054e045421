"""The decimal numbers that prose of L03 may hold: configured inputs."""

from robo_genesis.lessons.l03 import spec
from robo_genesis.lessons.l03.metrics import STOP_SPEED
from robo_genesis.sim import contacts

CONFIGURED = {
    "edge of the cube [m]": spec.BASELINE.size,
    "height of the surface [m]": contacts.TOP,
    "window of a landing [s]": spec.BASELINE.duration,
    "friction of the first cubes": spec.PUSHED.friction,
    "friction of the other cubes": spec.BESIDE.friction,
    "friction of the surface": spec.PUSHED.surface_friction,
    "friction of the other surface, and the time to settle [s]": spec.PUSHED.settle,
    "speed of a stopped body [m/s], and a damping ratio": STOP_SPEED,
}
