"""What lessons about reaches of the hand declare alike: settings, tolerances, invented answers."""

import math
from dataclasses import replace

from robo_genesis.core.check_spec import TOLERANCES as TOLERANCES
from robo_genesis.core.scene import read_only

from .engine_kinematics import IkSettings
from .kinematics import DOWN as DOWN

MEASURES = False

IK = IkSettings()  # Tolerances 0.5 mm and 5 mrad; up to 50 starts of 20 iterations each

# The same without starts of the engine's choice, so that an answer depends on its start
# alone.
ONE_START = replace(IK, samples=1, iterations=100)

# A target that no posture of the arm comes near to [m].
BEYOND_REACH = read_only((2.0, 0.0, 2.0))

# Radius of a sphere that marks a target [m]; nothing collides with it
MARKER_RADIUS = 0.03

# By unit: values that differ by no more than this are called equal, the noise floor.
RESOLUTION = {"m": 1e-5, "rad": 1e-5, "rad/s": 1e-3, "1": 0.5}

# The hand counts as arrived within these distances of its target [m] and [rad].
REACHED = (0.02, 0.05)

# Largest difference of a pose between two computations, one of them in float32 [m,
# rad].
SAME_POSE = (5e-6, 5e-6)

# Largest difference of a residual between the engine's solver and our computation [m,
# rad].
SAME_RESIDUAL = 1e-6

# For exercises: residuals, and whether `IK` lets such an answer be commanded.
RESIDUALS = {
    "exact": ((0.0,) * 6, True),
    "at_both_limits": ((5e-4, 0, 0, 0, 0, 5e-3), True),
    "too_far": ((6e-4, 0, 0, 0, 0, 0), False),
    "too_far_backwards": ((0, 0, -2.0, 0, 0, 0), False),
    "too_far_along_the_diagonal": ((4e-4, 4e-4, 0, 0, 0, 0), False),
    "turned_too_far": ((0, 0, 0, 0, -6e-3, 0), False),
    "turned_too_far_about_two_axes": ((0, 0, 0, 4e-3, 4e-3, 0), False),
    "too_far_along_y": ((0, 6e-4, 0, 0, 0, 0), False),
    "turned_too_far_about_x": ((0, 0, 0, 6e-3, 0, 0), False),
    "turned_too_far_about_z": ((0, 0, 0, 0, 0, 6e-3), False),
    "opposite_errors": ((0.2, -0.2, 0, 0.2, -0.2, 0), False),
    "rotation_not_a_number": ((0, 0, 0, 0, math.nan, 0), False),
    "residual_not_a_number": ((math.nan, 0, 0, 0, 0, 0), False),
    "height_is_no_angle": ((0, 0, 4e-4, 0, 0, 4.99e-3), True),
}

# A joint and its position, with which no answer may be commanded.
NOT_FINITE = {
    "first_joint_not_a_number": (0, math.nan),
    "middle_joint_infinite": (5, math.inf),
    "last_joint_infinite": (8, -math.inf),
}

# Both together: a joint and its position, the residual, and the verdict.
ANSWERS = {name: ((8, 0.1), *row) for name, row in RESIDUALS.items()}
ANSWERS |= {name: (joint, (0.0,) * 6, False) for name, joint in NOT_FINITE.items()}
