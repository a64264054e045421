"""What the named checks of lesson L04 require."""

MEASURES = False

CLAIMS: dict[str, str] = {
    "mapping": "Seven arm joints and two finger joints are found by name, each with its own DOF.",
    "configuration": (
        "Start, target, gains and limits have one finite value per joint; joint types have units."
    ),
    "target_limits": "Every start and target lies within the model's limits.",
    "baseline_approaches": "The baseline ends nearer to its target than it starts.",
    "stamps": (
        "Each run has its configured steps and states at times k · dt from zero. Each of the four "
        "cases commands its own target."
    ),
    "same_start": "The compared cases start in the same state, at rest.",
    "one_factor": "G1 and G2 differ in the stepped joint's KP alone, G2 and G3 in its KV alone.",
    "not_observed": (
        "A time is given exactly where the samples reach it, and `not observed` where they do not."
    ),
    "control_law": (
        "Each control force is clip(KP (q_target − q) − KV q̇) with the gains of its own case."
    ),
    "measurements": (
        "Position, velocity and forces are finite, and no control force exceeds its limit."
    ),
    "saturation": (
        "The limit reads back as it was set, and saturated samples are counted against it."
    ),
    "posture": "Two different camera frames, or a schematic whose links moved, show the end state.",
    "study_factors": (
        "Each study case differs from its compared case in one factor: target, substeps or window."
    ),
    "same_model": (
        "Both engines give the same inertia and gravity effort for the stepped joint at the start."
    ),
    "small_step_unsaturated": (
        "No effort of the small steps and of the hold runs reaches the saturation threshold."
    ),
    "theory_small_step": (
        "The overshoot of each small step agrees with the formula within the declared margin, and "
        "its curve is closer to the formula than that of the large step."
    ),
    "stepped_model": (
        "The overshoots of a one-joint model with the solver step agree with Genesis within the "
        "declared margins."
    ),
    "gravity_support": (
        "Where a case ends nearly at rest, KP × final error agrees with the gravity effort."
    ),
    "convergence": "G2's overshoot in Genesis falls with each refinement of the solver's step.",
    "one_limit": (
        "With a finer solver step, the stable runs of both engines approach the same overshoot of "
        "G2."
    ),
    "second_engine_order": (
        "Every ordering that the lesson claims holds in Genesis and in the stable runs of MuJoCo."
    ),
    "implicit_term": (
        "A commanded position adds h (d + KV) to the joint's entry in the engine's mass matrix."
    ),
    "same_beginning": "The longer run of G2 begins with exactly the samples of G2.",
    "grid_matches_cases": (
        "G1, G2 and G3 give the same results in the batch as alone, within the declared margins."
    ),
    "grid_within_gains": (
        "Every run of the grid stays within the compared cases' gains and step, and varies nothing "
        "else."
    ),
}
"""What each named check of the pages requires, shown where it passed."""
