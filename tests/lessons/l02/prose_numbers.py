"""The decimal numbers that prose of L02 may hold: configured inputs."""

from robo_genesis.core.scene import DT
from robo_genesis.lessons.l02.spec import BASELINE

CONFIGURED = {
    "outer step [s]": DT,
    "edge of the box [m]": BASELINE.size,
    "height of the box [m]": BASELINE.height,
    "length of the drop [s]": BASELINE.dt * BASELINE.steps,
}
