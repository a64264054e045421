"""A run of L02's lecture without the engine: drops that follow the stepped formula."""

import pytest
from lessons.body_runs import make_drop

from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l02 import life_cycle, spec, trials
from robo_genesis.lessons.l02.pages import LECTURE

COUNTED = dict.fromkeys(spec.COUNTS, 12) | {"duck_seen": 3534, "duck_felt": 500}
COUNTED |= {"tray_seen": 260, "tray_felt": 344, "box_pieces": 1, "hammer_pieces": 2}


@pytest.fixture(scope="session")
def run(frames) -> Experiment:
    """A run of the lecture that passes all checks."""
    counts = life_cycle.expected(rendered=True)
    readings = {
        "model": spec.EXPECTED_MODEL,
        "body": {"mass": spec.BASELINE.mass},
        life_cycle.GROUP: {name: int(accepted) for name, accepted in counts.items()},
        trials.SHAPES: COUNTED,
        trials.TRAYS: {trials.PIECES: 0.0308, trials.HULL: 0.1749},
        trials.FURTHER: trials.expected_falls(),
    }
    traces = {
        name: make_drop(case)
        for name, case in (spec.CASES | spec.SUBSTEP_CASES).items()
    }
    pictures = frames | {spec.TRAYS: frames["final"]}
    return Experiment(LECTURE, traces, [spec.LINK], readings, pictures, True)


@pytest.fixture(scope="session")
def experiments(run) -> dict[str, Experiment]:
    """The run, by its page."""
    return {"lecture": run}
