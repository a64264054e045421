"""What the named checks of lesson L05 require."""

MEASURES = False

CLAIMS: dict[str, str] = {
    "mapping": "The engine has the joints, limits and links that our forward kinematics uses.",
    "stamps": "Each run has its configured steps and states at times k · dt from zero.",
    "acceptance": (
        "The residual of the commanded answer is within both tolerances, as the engine reports it "
        "and by forward kinematics of the command."
    ),
    "forward_kinematics": (
        "In every state of the three reaches, our forward kinematics gives the engine's link poses "
        "within 5 µm and 5 µrad."
    ),
    "second_engine": (
        "MuJoCo gives the same link poses in every state of the three reaches, within 5 µm and "
        "5 µrad, and the same Jacobian at the start, within 5 · 10⁻⁶."
    ),
    "arrived": "Each run ends nearer to its target than it starts, and within 2 cm and 0.05 rad.",
    "sag_explains": (
        "Gravity, KP and the Jacobian explain the displacement from the command's pose to the last "
        "pose, except for at most 2 % of it."
    ),
    "repeatable": "From the common start, without restarts, equal questions get equal answers.",
    "restarts_repeat": "Answers repeat after a new `gs.init`; from this start, they need restarts.",
    "unreachable_refused": "Beyond reach, the answer is finite, and refused for its residual.",
    "nearest_is_nearer": "Another posture is nearer than the answer, where 0.5 m counts as 1 rad.",
    "camera_matrix": "The engine's camera matrix is that of the vertical field of view.",
    "projection": "The centroid of the marker is within 0.15 pixels of the silhouette's centre.",
    "sphere_surface": (
        "Each pixel of the marker, back-projected, is within 0.6 % of the radius of its surface."
    ),
    "plane_surface": "Each ground pixel within 3 m, back-projected, is within 0.1 mm of height 0.",
    "mounted_camera": "The camera on the hand is at the pose of the hand times the offset.",
    "posture": "Two different camera frames, or a schematic whose links moved, show the end state.",
}
