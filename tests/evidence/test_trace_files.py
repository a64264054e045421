import io
from dataclasses import fields, replace

import numpy as np
import pytest

from robo_genesis.core.trace import Trace
from robo_genesis.evidence import npz_archive
from robo_genesis.evidence.bundle import BundleRefused, read_arrays
from robo_genesis.evidence.npz_archive import read_archive, write_archive
from robo_genesis.evidence.trace_files import (
    FIELDS,
    dof_units,
    joint_records,
    read_joints,
    read_trace,
    write_traces,
)
from robo_genesis.sim.arm.franka import JOINT_NAMES

LINKS = ["link0", "link4", "hand"]


@pytest.fixture
def written(tmp_path, traces, joints):
    return tmp_path, write_traces(tmp_path, {"G1": traces["G1"]}, joints, LINKS)


@pytest.fixture
def spoil(written):
    """Write the file anew with some arrays changed; None takes one away."""
    folder, arrays = written

    def change(**values):
        with np.load(folder / "arrays" / "G1.npz") as archive:
            kept = {**archive, **values}
        kept = {name: array for name, array in kept.items() if array is not None}
        np.savez_compressed(folder / "arrays" / "G1.npz", **kept)
        return folder, arrays

    return change


def test_every_field_of_a_trace_is_written():
    assert list(FIELDS) == [field.name for field in fields(Trace)]


def test_arrays_come_back_bit_for_bit(written, traces):
    found = read_trace(*written, "G1")
    for field in FIELDS:
        before, after = getattr(traces["G1"], field), getattr(found, field)
        assert (after.dtype, after.shape) == (before.dtype, before.shape)
        assert after.tobytes() == before.tobytes()


def test_the_description_comes_back(pristine, traces, joints, tmp_path):
    arrays = write_traces(tmp_path, traces, joints, LINKS)
    assert read_arrays(pristine) == arrays
    assert arrays.coords == {"dof": list(JOINT_NAMES), "link": LINKS}


def test_joints_come_back_as_they_were_and_a_limit_that_is_missing_is_null(written, joints):
    lower, upper = np.array(joints.lower), np.array(joints.upper)
    lower[2], upper[5] = -np.inf, np.inf
    free = replace(joints, lower=lower, upper=upper)
    records = joint_records(free)
    assert [r.name for r in records if r.lower is None] == ["joint3"]
    found = read_joints(written[1].model_copy(update={"joints": records}))
    assert (found.names, found.types) == (joints.names, joints.types)
    for name in ("dofs_idx_local", "qs_idx_local", "lower", "upper"):
        assert getattr(found, name).tolist() == getattr(free, name).tolist()


def test_a_limit_that_is_no_number_is_not_written(joints):
    lower = np.array(joints.lower)
    lower[0] = np.nan
    with pytest.raises(ValueError, match="lower"):
        joint_records(replace(joints, lower=lower))


POSITION, SPEED, EFFORT = ("rad", "m"), ("rad/s", "m/s"), ("N·m", "N")
UNITS = {"q": POSITION, "target": POSITION, "qd": SPEED, "start_qd": SPEED}
UNITS |= dict.fromkeys(("control_force", "internal_force"), EFFORT)
UNITS |= dict.fromkeys(("start_control_force", "effort_limit"), EFFORT)


@pytest.mark.parametrize("field", UNITS)
def test_each_dof_has_its_own_unit(joints, written, field):
    name, (arm, finger) = FIELDS[field][0], UNITS[field]
    assert dof_units(name, joints.types) == [arm] * 7 + [finger] * 2
    assert written[1].cases["G1"].variables[name].unit == [arm] * 7 + [finger] * 2


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"q_rad_or_m": None}, "the header of the array q_rad_or_m differs"),
        ({"q_rad_or_m": np.zeros((120, 9))}, r"q_rad_or_m is .*120, 9.*float64"),
        ({"q_rad_or_m": np.zeros((121, 9), np.float16)}, r"q_rad_or_m is <f2"),
    ],
)
def test_other_arrays_than_the_described_ones_are_refused(spoil, changed, message):
    with pytest.raises(BundleRefused, match=rf"^bad-array: .*{message}"):
        read_trace(*spoil(**changed), "G1")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b"'shape': (3,), }", b"'shape': ( 3,),}"),
        (b"'fortran_order': False", b"'fortran_order':False "),
        (b" \n", b"\n\n"),
    ],
    ids=["shape", "order", "padding"],
)
def test_an_array_with_another_header_is_refused_each_time(tmp_path, monkeypatch, old, new):
    file, path = npz_archive._npy(np.zeros(3)), tmp_path / "G1.npz"
    assert file.count(old) == 1
    monkeypatch.setattr(npz_archive, "_npy", lambda array: file.replace(old, new))
    write_archive(path, {"t_s": np.zeros(3)})
    for _ in range(2):
        with pytest.raises(BundleRefused, match=r"^bad-array: .*t_s has another header"):
            read_archive(path, "G1.npz", ["t_s"])


SINGLE = io.BytesIO()
np.save(SINGLE, np.zeros(3))


@pytest.mark.parametrize(
    "broken",
    [
        lambda data: b"",
        lambda data: b"no archive",
        lambda data: data[:200] + bytes(200) + data[400:],
        lambda data: data.replace(b"\x1f", b"\x2f"),
        lambda data: SINGLE.getvalue(),
    ],
    ids=["empty", "text", "zeros", "swapped bytes", "a single array"],
)
def test_a_file_that_cannot_be_read_is_refused(written, broken):
    path = written[0] / "arrays" / "G1.npz"
    path.write_bytes(broken(path.read_bytes()))
    with pytest.raises(BundleRefused, match=r"^bad-array: "):
        read_trace(*written, "G1")


def test_a_missing_file_is_refused(written):
    (written[0] / "arrays" / "G1.npz").unlink()
    with pytest.raises(BundleRefused, match=r"^bad-array: "):
        read_trace(*written, "G1")
