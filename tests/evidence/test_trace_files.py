from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.core.trace import Trace
from robo_genesis.evidence import trace_files

LINKS = ["link0", "link4", "hand"]


@pytest.fixture
def written(tmp_path, traces, joints):
    return tmp_path, trace_files.write_traces(
        tmp_path, {"G1": traces["G1"]}, joints, LINKS
    )


def test_arrays_come_back_bit_for_bit(written, traces):
    found = trace_files.read_any_trace(*written, "G1")
    for field in Trace.arrays():
        before, after = getattr(traces["G1"], field), getattr(found, field)
        assert (after.dtype, after.shape) == (before.dtype, before.shape)
        assert after.tobytes() == before.tobytes()


def test_joints_come_back_as_they_were_and_a_limit_that_is_missing_is_null(
    written, joints
):
    lower, upper = np.array(joints.lower), np.array(joints.upper)
    lower[2], upper[5] = -np.inf, np.inf
    free = replace(joints, lower=lower, upper=upper)
    records = trace_files.joint_records(free)
    assert [r.name for r in records if r.lower is None] == ["joint3"]
    found = trace_files.read_joints(written[1].model_copy(update={"joints": records}))
    assert (found.names, found.types) == (joints.names, joints.types)
    for name in ("dofs_idx_local", "qs_idx_local", "lower", "upper"):
        assert getattr(found, name).tolist() == getattr(free, name).tolist()


POSITION, SPEED, EFFORT = ("rad", "m"), ("rad/s", "m/s"), ("N·m", "N")
UNITS = {"q": POSITION, "target": POSITION, "qd": SPEED, "start_qd": SPEED}
UNITS |= dict.fromkeys(("control_force", "internal_force"), EFFORT)
UNITS |= dict.fromkeys(("start_control_force", "effort_limit"), EFFORT)


@pytest.mark.parametrize("field", UNITS)
def test_each_dof_has_its_own_unit(written, field):
    name, (arm, finger) = Trace.arrays()[field].name, UNITS[field]
    assert written[1].cases["G1"].variables[name].unit == [arm] * 7 + [finger] * 2
