"""The decimal numbers that prose of L02 may hold: configured inputs."""

from robo_genesis.core.scene import DT
from robo_genesis.lessons.l02.spec import BALL, BASELINE, RIM

CONFIGURED = {
    "outer step [s]": DT,
    "edge of the box [m]": BASELINE.size,
    "height of the box [m]": BASELINE.height,
    "length of the drop [s]": BASELINE.dt * BASELINE.steps,
    "rim of the tray [m]": RIM,
    "radius of the ball [m]": BALL,
    "height of the table in the third calculation [m]": 0.7,
    "centre of the box on it [m]": 0.75,
    "volume of the box [m³]": 0.001,
    "mass of the box [kg]": BASELINE.mass,
    "distance of the drop by the school formula [m]": 0.196,
    "gravity on the Moon [m/s²]": 1.62,
    "solver step with four substeps, and the gap [ms, mm]": 2.5,
    "radius of the sphere of the task [m]": 0.05,
}
