"""The map from names to DOFs, and names that it refuses."""

from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.sim.arm.joints import JointError, resolve_joints

JOINTS = {
    "base": ("FREE", [0, 1, 2, 3, 4, 5], [0, 1, 2, 3, 4, 5, 6]),
    "shoulder": ("REVOLUTE", [6], [7]),
    "slider": ("PRISMATIC", [10], [12]),
    "weld": ("FIXED", [], []),
    "disc": ("REVOLUTE", [11], [13, 14]),
}


def joint(name):
    kind, dofs, qs = JOINTS[name]
    return SimpleNamespace(
        name=name,
        type=SimpleNamespace(name=kind),
        n_dofs=len(dofs),
        n_qs=len(qs),
        dofs_idx_local=dofs,
        qs_idx_local=qs,
    )


# A robot whose limits are ± (10 + local DOF).
ROBOT = SimpleNamespace(
    joints=[joint(name) for name in JOINTS],
    get_joint=joint,
    get_dofs_limit=lambda dofs: (-np.add(dofs, 10.0), np.add(dofs, 10.0)),
)


def test_the_map_follows_the_names_and_not_the_model():
    joints = resolve_joints(ROBOT, ("slider", "shoulder"))
    assert joints.names == ("slider", "shoulder")
    assert joints.position_units == ("m", "rad")
    assert joints.effort_units == ("N", "N·m")
    for name, values in {
        "dofs_idx_local": [10, 6],
        "qs_idx_local": [12, 7],
        "upper": [20, 16],
        "lower": [-20, -16],
    }.items():
        array = getattr(joints, name)
        assert (array.tolist(), array.flags.writeable) == (values, False)
    assert joints.rows()[0] == {
        "name": "slider",
        "type": "prismatic",
        "local DOF": 10,
        "local qpos": 12,
        "lower": -20.0,
        "upper": 20.0,
        "unit": "m",
    }
    assert joints.entry("shoulder") == 1
    with pytest.raises(JointError, match=r"'wrist'.*slider, shoulder"):
        joints.entry("wrist")


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (
            ("shoulder", "elbw"),
            r"'elbw'.*base, shoulder, slider, weld, disc",
        ),
        (("base",), "'base' has 6 DOFs and 7 qpos"),
        (("disc",), "'disc' has 1 DOFs and 2 qpos"),
    ],
)
def test_names_that_are_not_one_dof_each_are_refused(names, message):
    with pytest.raises(JointError, match=message):
        resolve_joints(ROBOT, names)
