"""The decimal numbers that prose of L02 may hold: configured inputs."""

from robo_genesis.core.scene import DT
from robo_genesis.lessons.l02.spec import BALL, BASELINE, RIM

MOON = 1.62
CONFIGURED = {
    "outer step [s]": DT,
    "edge of the box [m]": BASELINE.size,
    "height of the box [m]": BASELINE.height,
    "length of the drop [s]": BASELINE.dt * BASELINE.steps,
    "rim of the tray [m]": RIM,
    "radius of the ball [m]": BALL,
    "mass of the box [kg]": BASELINE.mass,
    "distance of the drop by the school formula [m]": 0.196,
    "gravity on the Moon [m/s²]": MOON,
    "step that leaves 1 mm after 0.5 s, by hand [ms]": round(2 / (9.81 * 0.5), 1),
    "step that leaves 1 mm after 1 s on the Moon, by hand [ms]": round(2 / MOON, 2),
    "substeps of it, by hand": round(10 * MOON / 2, 1),
    "radius of the sphere of the task [m]": 0.05,
}
