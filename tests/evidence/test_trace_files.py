from dataclasses import replace

import numpy as np
import pytest

from robo_genesis.core.trace import Trace, TraceError
from robo_genesis.evidence import trace_files

LINKS = ["link0", "link4", "hand"]


@pytest.fixture
def described(tmp_path, traces, joints):
    return trace_files.write_traces(tmp_path, {"G1": traces["G1"]}, joints, LINKS)


def test_arrays_come_back_bit_for_bit(tmp_path, described, traces):
    found = trace_files.read_any_trace(tmp_path, described, "G1")
    for field in Trace.arrays():
        before, after = getattr(traces["G1"], field), getattr(found, field)
        assert (after.dtype, after.shape) == (before.dtype, before.shape)
        assert after.tobytes() == before.tobytes()


def test_joints_come_back_as_they_were_and_a_limit_that_is_missing_is_null(
    described, joints
):
    lower, upper = np.array(joints.lower), np.array(joints.upper)
    lower[2], upper[5] = -np.inf, np.inf
    free = replace(joints, lower=lower, upper=upper)
    records = trace_files.joint_records(free)
    assert [r.name for r in records if r.lower is None] == ["joint3"]
    found = trace_files.read_joints(described.model_copy(update={"joints": records}))
    assert (found.names, found.types) == (joints.names, joints.types)
    for name in ("dofs_idx_local", "qs_idx_local", "lower", "upper"):
        assert getattr(found, name).tolist() == getattr(free, name).tolist()


def test_each_dof_has_its_own_unit_and_each_link_a_label(described, traces, joints):
    units = {
        name: variable.unit
        for name, variable in described.cases["G1"].variables.items()
    }
    for name, (arm, finger) in {
        "q_rad_or_m": ("rad", "m"),
        "start_qd_rad_s_or_m_s": ("rad/s", "m/s"),
        "effort_limit_Nm_or_N": ("N·m", "N"),
    }.items():
        assert units[name] == [arm] * 7 + [finger] * 2
    with pytest.raises(TraceError, match=r"link_pos_m has 3 of link, expected link0"):
        trace_files.describe(traces, joints, LINKS[:2], {})
