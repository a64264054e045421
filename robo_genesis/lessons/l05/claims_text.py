"""What the named checks of lesson L05 require."""

CLAIMS: dict[str, str] = {
    "mapping": "The engine has the joints, limits and links that our forward kinematics uses.",
    "stamps": "Each run has its configured steps and states at times k · dt from zero.",
    "acceptance": (
        "The commanded answer is within both tolerances, as reported and by forward kinematics."
    ),
    "forward_kinematics": "In every state, our forward kinematics gives the engine's link poses.",
    "second_engine": "MuJoCo agrees on the poses in every state, and on the Jacobian at the start.",
    "arrived": "Each run ends nearer to its target than it starts, and within 2 cm and 0.05 rad.",
    "sag_explains": (
        "Gravity, KP and J explain the motion from command to end, but for the declared share."
    ),
    "repeatable": (
        "Asked twice from the common start, the solver gives the same answer to the last bit."
    ),
    "unreachable_refused": "Beyond reach, the answer is finite, and refused for its residual.",
    "nearest_is_nearer": (
        "Another posture is nearer than the engine's answer, if 0.5 m count as much as 1 rad."
    ),
    "camera_matrix": "The engine's camera matrix is that of the vertical field of view.",
    "projection": "The centroid of the marker is within 0.15 pixels of the silhouette's centre.",
    "sphere_surface": (
        "Each pixel of the marker, back-projected, is within 0.6 % of the radius of its surface."
    ),
    "plane_surface": "Each ground pixel within 3 m, back-projected, is within 0.1 mm of height 0.",
    "mounted_camera": "The camera on the hand is at the pose of the hand times the offset.",
    "posture": "Two different camera frames, or a schematic whose links moved, show the end state.",
}
