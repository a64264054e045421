"""The checks of L07 accept its runs and name what is wrong with others."""

import pytest
from lessons.changed_runs import failed, reading, shift, trace
from robot_runs import driven

from robo_genesis.core.experiment import Experiment
from robo_genesis.lessons.l07 import spec
from robo_genesis.lessons.l07.pages import TURN
from robo_genesis.sim.arm.franka import MODEL_COUNTS

LINKS = ("link0", "hand")


@pytest.fixture(scope="module")
def run(joints):
    traces = {name: driven(case, LINKS) for name, case in spec.CASES.items()}
    return Experiment(TURN, traces, LINKS, {"model": MODEL_COUNTS}, {}, False, joints)


def test_each_check_fails_on_its_own_fault(run):
    assert failed(run) == set()
    assert failed(reading("model", "links", 2)(run)) == {"structure"}
    assert failed(trace("baseline", t=lambda t: 2 * t)(run)) == {"stamps"}
    assert failed(trace("baseline", q=shift(..., -0.1))(run)) == {"arrives"}
