"""Constants of the Franka Panda of the course, with units."""

from robo_genesis.core.scene import FloatArray, read_only

from .model import RobotModel

# The Franka Panda that Genesis bundles, relative to the engine's asset folder.
FRANKA_MJCF = "xml/franka_emika_panda/panda.xml"

# The nine one-DOF joints, in the order of every array of the course.
JOINT_NAMES = (
    *(f"joint{number}" for number in range(1, 8)),
    "finger_joint1",
    "finger_joint2",
)

FRANKA = RobotModel(FRANKA_MJCF, JOINT_NAMES, hand="hand", fingers=2, tip=0.1123)

# The authors of the robot's shape, below pictures that are drawn from it.
CREDIT = (
    "Franka Emika Panda model of MuJoCo Menagerie, Apache-2.0, from franka_description, "
    "© Franka Robotics GmbH; decimated and converted"
)

# Counts of the robot's model, as the engine reports them.
MODEL_COUNTS = {"links": 11, "joints": 9, "dofs": 9, "qpos": 9}

# For each link the index of its parent, -1 for the base; both fingers belong to the
# hand.
LINK_PARENTS = (-1, 0, 1, 2, 3, 4, 5, 6, 7, 8, 8)

JOINT_TYPES = ("REVOLUTE",) * 7 + (
    "PRISMATIC",
) * 2  # Type of each joint of `JOINT_NAMES`


def per_joint(*values: float) -> FloatArray:
    """Return a read-only array of shape (9,), one value for each of `JOINT_NAMES`."""
    return read_only(values)


# Start position: arm [rad], fingers [m].
Q_START = per_joint(0, -0.3, 0, -2.0, 0, 1.7, 0.79, 0.04, 0.04)

# Position gains: arm [N·m/rad], fingers [N/m].
KP_BASELINE = per_joint(4500, 4500, 3500, 3500, 2000, 2000, 2000, 100, 100)

# Velocity gains: arm [N·m·s/rad], fingers [N·s/m].
KV_BASELINE = per_joint(450, 450, 350, 350, 200, 200, 200, 10, 10)

# Symmetric bound of the commanded effort: arm [N·m], fingers [N].
EFFORT_LIMIT = per_joint(87, 87, 87, 87, 12, 12, 12, 100, 100)
