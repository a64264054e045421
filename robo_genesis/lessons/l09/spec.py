"""Specification of lesson L09: clones of experts, their starts, and tolerances.

Pages, checks, verification and tests read the experiment here. The module is data and
computes nothing. `parameters()` has the values that decide what runs; all other values
only judge.
"""

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import numpy as np

from robo_genesis.core import check_spec
from robo_genesis.core.experiment import inputs
from robo_genesis.core.scene import CAMERA
from robo_genesis.sim.arm import franka, lifting, reaching
from robo_genesis.sim.arm.picking import PickCase

from .settings import Training, spread

MEASURES = False

MINIMUM_HARDWARE = "cpu"

EXPECTED_MODEL = franka.MODEL_COUNTS

# Least and largest (x, y) of the starts [m], as in L08.
LEAST, MOST = np.array([0.40, -0.25]), np.array([0.60, 0.06])

# Starts of the demonstrations. The last `HELD_OUT` measure the error, and none learns them.
SHOWN, HELD_OUT = spread(128, 1, LEAST, MOST), 16

# Starts of the tests, 16 for each of 8 networks.
NETWORKS, EACH = 8, 16
TESTED = np.concatenate([spread(EACH, 100 + k, LEAST, MOST) for k in range(NETWORKS)])

# Starts of episodes in which an expert answers; the first `ANSWERED` of each network count.
ASKED = np.concatenate([spread(EACH, 200 + k, LEAST, MOST) for k in range(NETWORKS)])
ANSWERED = 2

# One command each 50 ms, and ten solver steps between two commands.
DEMONSTRATED = PickCase(
    shape="cylinder",
    size=(0.05, 0.05, 0.07),
    place=(0.5, -0.05, 0.0),
    kp=lifting.KP,
    kv=lifting.KV,
    starts=SHOWN,
    beliefs=SHOWN,
    settings=reaching.ONE_START,
    dt=0.05,
    substeps=10,
    steps=110,
    commands=1,
    stride=0.06,
)
TRIED = replace(DEMONSTRATED, starts=TESTED, beliefs=TESTED)
QUESTIONED = replace(DEMONSTRATED, starts=ASKED, beliefs=ASKED)

PROMPT = Training()
FIVE = replace(PROMPT, chunk=5)
LOOKING = replace(PROMPT, expert="looking", inputs=("q", "place"), demonstrations=16)
WITH_PHASE = ("q", "place", "turn", "phase")

# By page and name, the kinds of clones.
CASES = {
    "waiting": replace(PROMPT, expert="waiting"),
    "waiting_phase": replace(PROMPT, expert="waiting", inputs=WITH_PHASE),
    "waiting_no_turn": replace(PROMPT, expert="waiting", inputs=("q", "place")),
    "waiting_both": replace(PROMPT, expert="waiting", inputs=("q", "place", "phase")),
    "prompt": PROMPT,
    "no_turn": replace(PROMPT, inputs=("q", "place")),
    "delayed": replace(PROMPT, expert="delayed"),
    "five": FIVE,
    "waiting_five": replace(FIVE, expert="waiting"),
}
ANSWERS = {
    "few": LOOKING,
    "always": replace(LOOKING, answers="always"),
    "elsewhere": replace(LOOKING, answers="elsewhere"),
    "more": replace(LOOKING, demonstrations=32),
    "most": replace(LOOKING, demonstrations=64),
}
CHANGED = {
    "prompt": PROMPT,
    "difference": replace(PROMPT, difference=True),
    "no_turn": CASES["no_turn"],
    "floor": replace(PROMPT, least=0.02),
    "last": replace(PROMPT, inputs=("q", "place", "turn", "last")),
    "noisy": replace(PROMPT, noise=0.005),
    "longer": replace(PROMPT, steps=4000),
}
LAB = {"own": LOOKING, "asked": replace(LOOKING, answers="elsewhere")}

# The episode that the replay shows, among those of `TRIED`.
ROW = 5

# What is shown at one start: the expert, its clone, and the clone with five commands.
EPISODES = {
    "expert": TRIED.episode(ROW),
    "clone": TRIED.episode(ROW),
    "chunk": TRIED.episode(ROW),
}
LAB_EPISODE = {"one": DEMONSTRATED.episode(ROW)}
ASKED_EPISODES = {"before": TRIED.episode(ROW), "after": TRIED.episode(ROW)}

VIEW = CAMERA | {"pos": (1.05, -0.4, 1.0), "lookat": (0.45, 0.0, 0.0)}

LABELS = {
    "expert": "expert",
    "clone": "clone",
    "chunk": "clone, five commands",
    "before": "clone",
    "after": "clone after asking",
    "waiting": "waits",
    "waiting_phase": "waits; phase given",
    "waiting_no_turn": "waits; no orientation",
    "waiting_both": "waits; phase given, no orientation",
    "prompt": "does not wait",
    "delayed": "stays 0.25 s at each goal",
    "five": "does not wait; five commands",
    "waiting_five": "waits; five commands",
    "floor": "least spread of 0.02",
    "few": "16 demonstrations",
    "always": "16, and answers about 16 episodes, always solved again",
    "elsewhere": "16, and answers about 16 episodes",
    "more": "32 demonstrations",
    "most": "64 demonstrations",
    "difference": "command − position",
    "no_turn": "does not wait; no orientation",
    "last": "with the last command",
    "noisy": "noise in the demonstrations",
    "longer": "twice the training",
    "own": "your clones",
    "asked": "your clones after asking",
    "one": "one demonstration",
    "shown": "demonstrations",
}

CASE_MARKS = {"expert": "baseline", "clone": "first", "chunk": "second"}

RESOLUTION = {"1": 0.5, "m": 1e-4, "rad": 1e-5, "%": 0.01}

# A count of another engine version may differ, and weights differ in each bit.
TOLERANCES = check_spec.TOLERANCES | {"%": (5.0, 0.5), "weights": (2.0**48, 0.0)}
TOLERANCES |= dict.fromkeys(("experts",), (8.0, 0.0))
TOLERANCES |= dict.fromkeys([*CASES, *ANSWERS, *CHANGED, *LAB], (64.0, 0.0))

RELATIONS: tuple[Any, ...] = ()


def parameters(
    kinds: Mapping[str, Any], episodes: Mapping[str, Any] = MappingProxyType({})
) -> dict[str, Any]:
    """Return every configured input of a page as JSON values, for the evidence key."""
    scenes = {
        "demonstrated_batch": DEMONSTRATED,
        "tried_batch": TRIED,
        "questioned_batch": QUESTIONED,
    }
    return inputs(
        {**kinds, **scenes, **episodes}, VIEW, held_out=HELD_OUT, answered=ANSWERED
    )
