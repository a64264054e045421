"""Specification of lesson L08: the episodes of a scripted expert, limits and tolerances.

Pages, checks, verification and tests read the experiment here. The module is data and
computes nothing. `parameters()` has the values that decide what runs; all other values
only judge.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from robo_genesis.core import check_spec
from robo_genesis.core.experiment import inputs
from robo_genesis.core.scene import CAMERA, FloatArray, read_only
from robo_genesis.sim.arm import franka, lifting, reaching
from robo_genesis.sim.arm.picking import PickCase
from robo_genesis.sim.camera import film

from . import creep

MEASURES = False

MINIMUM_HARDWARE = "cpu"

EXPECTED_MODEL = franka.MODEL_COUNTS

# Rows and columns of the map of starts.
CELLS = 16

# Least and largest x and y of the starts [m].
REGION = (0.40, 0.60), (-0.25, 0.06)

# Where the camera that is turned sees right [m].
MIDDLE = read_only((0.5, -0.095))


def starts(
    cells: int = CELLS, seed: int = 1, region: tuple[tuple[float, float], ...] = REGION
) -> FloatArray:
    """Return places (cells², 2), one at random in each cell of a region [m].

    A region is the least and the largest x, and those of y.

    Neighbours along x follow each other.
    """
    y, x = np.divmod(np.arange(cells**2), cells)
    share = (
        np.column_stack([x, y]) + np.random.default_rng(seed).random((cells**2, 2))
    ) / cells
    least, most = np.transpose(region)
    return read_only(least + share * (most - least))


def turned(places: FloatArray, degrees: float) -> FloatArray:
    """Return where a camera sees places (e, 2) if it is turned about the middle [m]."""
    angle = np.radians(degrees)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return read_only(MIDDLE + (places - MIDDLE) @ turn.T)


STARTS = starts()

# 256 episodes with a camera that is turned by 4°.
ASKEW = PickCase(
    shape="cylinder",
    size=(0.05, 0.05, 0.07),
    place=(0.5, -0.05, 0.0),
    kp=lifting.KP,
    kv=lifting.KV,
    starts=STARTS,
    beliefs=turned(STARTS, 4.0),
    settings=reaching.ONE_START,
    dt=0.05,
    substeps=10,
    steps=130,
)

FEW = starts(8, seed=2)

# 64 episodes in which the expert knows the place.
EXACT = replace(ASKEW, starts=FEW, beliefs=FEW)

# Environment k of the permuted run has the episode of this number.
ORDER = np.random.default_rng(3).permutation(len(FEW))

# The batch of the lecture that repeats `exact` in another order.
COPIES = {"permuted": replace(EXACT, starts=FEW[ORDER], beliefs=FEW[ORDER])}

# The same episodes with the elliptic cone, with which the scene has `impratio` 100 as well.
ROUND = replace(ASKEW, cone="elliptic")

CASES = {"exact": EXACT, "askew": ASKEW, "round": ROUND}

# Episodes of `ASKEW` that the replay shows, and their environments. Engine versions agree
# about how each ends.
SHOWN = {"placed": 105, "slipped": 199, "tipped": 224, "pushed": 238}

# Places of their robots in one view [m].
PLACES = ((0.0, -0.5), (0.0, 0.5), (-1.4, -0.5), (-1.4, 0.5))

# How many rungs each of them reaches; not fitted to a run.
REACH = {"placed": 7, "slipped": 3, "tipped": 2, "pushed": 1}

EPISODES = {name: ASKEW.episode(row) for name, row in SHOWN.items()}

# The episode of `EXACT` that the lab has at all its outer steps.
LAB_EPISODE = {"one": EXACT.episode(0)}

# Films of the lab; they show the first environments of `EXACT` in their order.
FILMS = ("film_0", "film_1", "film_2")

# By episode, its batch and its environment there.
ROWS = {name: ("askew", row) for name, row in SHOWN.items()} | {"one": ("exact", 0)}

# The camera; it shows one environment.
VIEW = CAMERA | {"pos": (1.05, -0.4, 1.0), "lookat": (0.45, 0.0, 0.0)}
FILM: dict[str, Any] = VIEW | {"res": film.RES}

# Words of a reader for runs.
LABELS = (
    {"exact": "place known", "one": "one episode", "askew": "camera turned by 4°"}
    | {"round": "camera turned by 4°, elliptic cone"}
    | {
        "placed": "in the bowl",
        "slipped": "grip lost on the way",
        "tipped": "lost in the lift",
        "pushed": "never held",
        "grid": "grid of errors",
        "plain": "plain",
        "corrected": "sag corrected",
        "compensated": "no gravity on the robot",
        "elliptic": "elliptic cone",
        "timed": "descent by a clock",
        "boxes": "yaw ignored",
        "paced": "three speeds",
        "own": "own object and camera",
        "without_cause": "without the cause",
        "without_rival": "without the other possible cause",
        "attack": "new starts",
    }
    | creep.LABELS
)

# The mark of each case in the palette.
CASE_MARKS = dict(zip(SHOWN, ("baseline", "first", "second", "third"), strict=True))

# By unit, the difference below which two values are equal.
RESOLUTION = {"1": 0.5, "m": 1e-4, "N": 0.05, "1/s": 0.05} | creep.RESOLUTION

# Contacts make rounding grow: another version of the engine had three more successes of
# 256.
TOLERANCES = check_spec.TOLERANCES | creep.TOLERANCES | {"1/s": (0.05, 0.01)}
TOLERANCES |= dict.fromkeys(
    ("askew", "round", "grid", "plain", "corrected", "timed", "boxes"), (20.0, 0.0)
)
TOLERANCES |= dict.fromkeys(("own", "without_rival", "attack", "rule"), (8.0, 0.0))

# No metric of two cases is compared.
RELATIONS: tuple[Any, ...] = ()


def parameters() -> dict[str, Any]:
    """Return every configured input of the lecture as JSON values, for the evidence key."""
    return inputs(CASES | COPIES | EPISODES, VIEW, counted=list(EXPECTED_MODEL))


def lab_parameters() -> dict[str, Any]:
    """Return every configured input of the lab, as `parameters`."""
    small = {name: value for name, value in FILM.items() if name != "GUI"}
    cases = {"exact": EXACT} | LAB_EPISODE
    return inputs(cases, VIEW, film=small, counted=list(EXPECTED_MODEL))
