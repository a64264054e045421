"""What the named checks of lesson L03 require."""

from robo_genesis.lessons.l03 import spec

MEASURES = False

CLAIMS: dict[str, str] = {
    "structure": (
        "The scene has two entities; the cube is one link, one geom, one joint, 6 DOFs and 7 qpos."
    ),
    "mass": "The engine's masses are density times volume.",
    "settings": "Frictions and substeps read back from the scenes are those of the cases.",
    "stamps": "The record of each case has one state at t = 0 and one after each outer step.",
    "start": (
        "Each run begins at the position of its case, a pushed cube with the speed of its case."
    ),
    "one_factor": "Compared cases differ in the declared factors and in nothing else.",
    "lands": "Each dropped cube touches the surface, and its centre stays above the upper face.",
    "reported_late": (
        "With one substep, a reported depth belongs to the state before: it is one step old."
    ),
    "equal_step_equal_states": (
        "Runs with equal solver steps and different outer steps share states at shared times."
    ),
    "settles": "Each dropped cube settles at its resting height within the window.",
    "stops": "Each pushed cube stops within the window by the declared rule.",
    "friction_orders": (
        "With less friction a cube travels farther; the smaller coefficient changes nothing."
    ),
    "near_coulomb": (
        f"Each stopping distance is within {100 * spec.COULOMB_SHARE:g} % of v² / (2 μ g) with the "
        "larger coefficient."
    ),
    "level_in_flight": (
        "In the air, the energy that semi-implicit Euler conserves is constant to within float32."
    ),
    "energy_converges": (
        "The finest step keeps at the bounce the energy of a linear spring; a coarse one does not."
    ),
    "posture": (
        "The evidence of the first and the last state is complete and shows the cube in two places."
    ),
    "time_constants": (
        "The engine gives a contact a time constant of 10 ms, and never less than two solver steps."
    ),
    "records_each_step": (
        "With every solver step recorded, the baseline falls as with every second one."
    ),
    "rebound_goes": (
        "With the default time constant, cubes rebound at the baseline's solver step; at all "
        "smaller steps studied, none does from any of the nine heights."
    ),
    "scatter_shrinks": (
        "The depths as shares of v T / e scatter widely at h = T / 2, and less at every smaller "
        "step."
    ),
    "depth_by_hand": (
        "With fine steps, each cube sinks in by v T / e: within 10 % for a time constant of 10 ms, "
        "and within 20 % for 2 ms."
    ),
    "default_cone_hops": (
        "With the engine's default friction model, both cubes that are pushed to 2 m/s hop."
    ),
    "hop_follows_step": (
        "From 10 ms to 2 ms the hop is that of the formula for one step, within 25 %; at smaller "
        "steps at most 15 % of the hop at 5 ms is left."
    ),
    "hop_follows_speed": (
        "At a step of 5 ms the hop grows with the speed, and is below 1 mm up to 0.2 m/s."
    ),
    "stops_nearly_right": (
        "The cube with the friction of the surface still stops near v² / (2 μ g)."
    ),
    "hop_is_paid_by_friction": (
        "The first step reduces v_x by μ times the gain of v_z, far more than under the weight."
    ),
    "clean_slides_stay_down": (
        "With the engine's elliptic cone, cubes slide on four corners at every sample."
    ),
    "clean_slides_are_coulomb_s": (
        "With the elliptic cone, a cube stops at v² / (2 μ g) − v h / 2: Coulomb's law in steps."
    ),
    "larger_friction_rules": (
        "Clean slides show the larger of two coefficients, and fit no other rule."
    ),
    "the_cone_alone_hops": (
        "With the round cone and the pyramid's resolution cubes hop: the shape does not prevent it."
    ),
    "half_the_step_contradicts": (
        "The stopping distance of the cube with the higher coefficient changes by more than 5 % of "
        "Coulomb's when the solver step of 5 ms is halved."
    ),
    "engines_land_alike": (
        "With equal settings, cubes land in MuJoCo as in the engine, at every shared sample."
    ),
    "engines_hop_alike": (
        "With equal settings, pushed cubes make the same hop in MuJoCo, with either cone."
    ),
    "release_speed": (
        "With fine steps and time constants of 10, 5 and 2 ms, a contact releases a cube at e⁻² of "
        "its impact speed, within 10 %."
    ),
    "stiff_contacts_rebound": (
        "With 10 ms no cube rebounds; with 5 ms and 2 ms each rebounds as from a linear contact, "
        "within 25 %."
    ),
}
"""What each named check of the pages requires, shown where it passed."""
