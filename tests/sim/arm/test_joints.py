from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.sim.arm.joints import JointError, resolve_joints, to_numpy


class FakeRobot:
    """Joints (name, type, DOFs, qpos) whose limits are ± (10 + local DOF)."""

    def __init__(self, *joints):
        self.joints = [
            SimpleNamespace(
                name=name,
                type=SimpleNamespace(name=kind),
                n_dofs=len(dofs),
                n_qs=len(qs),
                dofs_idx_local=dofs,
                qs_idx_local=qs,
            )
            for name, kind, dofs, qs in joints
        ]

    def get_joint(self, name):
        return next(joint for joint in self.joints if joint.name == name)

    def get_dofs_limit(self, dofs):
        upper = np.array(dofs, dtype=float) + 10
        return -upper, upper


@pytest.fixture
def robot():
    return FakeRobot(
        ("base", "FREE", [0, 1, 2, 3, 4, 5], [0, 1, 2, 3, 4, 5, 6]),
        ("shoulder", "REVOLUTE", [6], [7]),
        ("wrist", "SPHERICAL", [7, 8, 9], [8, 9, 10, 11]),
        ("slider", "PRISMATIC", [10], [12]),
        ("weld", "FIXED", [], []),
        ("disc", "REVOLUTE", [11], [13, 14]),
        ("screw", "REVOLUTE", [12, 13], [15]),
        ("twin", "REVOLUTE", [6], [16]),
    )


def test_the_map_follows_the_names_and_not_the_model(robot):
    joints = resolve_joints(robot, ("slider", "shoulder"))
    assert joints.names == ("slider", "shoulder")
    assert joints.position_units == ("m", "rad")
    assert joints.effort_units == ("N", "N·m")
    assert joints.dofs_idx_local.tolist() == [10, 6]
    assert joints.qs_idx_local.tolist() == [12, 7]
    assert joints.upper.tolist() == [20, 16]
    assert joints.lower.tolist() == [-20, -16]


def test_rows_are_the_table(robot):
    assert resolve_joints(robot, ("slider",)).rows() == [
        {
            "name": "slider",
            "type": "prismatic",
            "local DOF": 10,
            "local qpos": 12,
            "lower": -20.0,
            "upper": 20.0,
            "unit": "m",
        }
    ]


@pytest.mark.parametrize("name", ["dofs_idx_local", "qs_idx_local", "lower", "upper"])
def test_arrays_are_read_only(robot, name):
    with pytest.raises(ValueError, match="read-only"):
        getattr(resolve_joints(robot, ("slider",)), name)[0] = 0


REFUSED = [
    (("shoulder", "elbw"), r"'elbw'.*base, shoulder, wrist, slider, weld, disc, screw, twin"),
    *(
        ((name,), f"'{name}' has {dofs} DOFs and {qpos} qpos")
        for name, dofs, qpos in (
            ("wrist", 3, 4), ("base", 6, 7), ("weld", 0, 0), ("disc", 1, 2), ("screw", 2, 1),
        )
    ),
    (("shoulder", "shoulder"), r"shoulder, shoulder share DOFs: \[6, 6\]"),
    (("shoulder", "twin"), r"shoulder, twin share DOFs: \[6, 6\]"),
]  # fmt: skip


@pytest.mark.parametrize(("names", "message"), REFUSED)
def test_names_that_are_not_one_dof_each_are_refused(robot, names, message):
    with pytest.raises(JointError, match=message):
        resolve_joints(robot, names)


def test_entry_is_the_place_in_the_map(robot):
    joints = resolve_joints(robot, ("slider", "shoulder"))
    assert joints.entry("shoulder") == 1
    with pytest.raises(JointError, match=r"'wrist'.*slider, shoulder"):
        joints.entry("wrist")


def test_to_numpy_copies():
    values = np.zeros(2)
    copy = to_numpy(values)
    values[0] = 1
    assert copy.tolist() == [0, 0]


def test_to_numpy_takes_a_tensor_to_the_host():
    tensor = SimpleNamespace(
        detach=lambda: SimpleNamespace(
            cpu=lambda: SimpleNamespace(numpy=lambda: np.array([1.5, 2.5]))
        )
    )
    assert to_numpy(tensor).tolist() == [1.5, 2.5]
