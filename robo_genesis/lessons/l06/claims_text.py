"""What the named checks of lesson L06 require."""

MEASURES = False

CLAIMS: dict[str, str] = {
    "mapping": "The engine has the expected links, joints and DOFs.",
    "stamps": "Each run has its configured steps and states at times k · dt from zero.",
    "acceptance_per_row": (
        "By forward kinematics, each command of the runs with metrics is within both tolerances "
        "and 5 µm and 5 µrad of rounding. The rule refuses the target beyond reach, and no other."
    ),
    "arrived": "Each hand is within 2 cm of its first and last target, and ends within 0.05 rad.",
    "row_equals_alone": (
        "Each row of the batch and the same run alone have the same command to the last bit, and "
        "positions, velocities and control forces within the declared bounds."
    ),
    "permuted_rows": (
        "With the worlds in another order, each gives the same arrays to the last bit."
    ),
    "untouched_keep_their_state": (
        "Environments that are not named keep their hand in place while others get a second "
        "command. While others are reset and commanded in mid-motion, they give the same arrays to "
        "the last bit."
    ),
    "partial_reset": (
        "After a reset in mid-motion, an environment repeats its first run to the last bit."
    ),
    "own_gains_and_mass": (
        "The row without changes equals its run beside equal neighbours to the last bit. Each hand "
        "has its own mass. At rest each torque equals the gravity torque of the arm with its load, "
        "and KP times the position error, within 0.05 N·m."
    ),
    "equal_work": (
        "In each timed batch of robots, all arms end near the commanded angles, and all "
        "environments in the same state to the last bit. No time is judged."
    ),
    "posture": "Two different camera frames, or a schematic whose links moved, show the end state.",
}
