"""What the named checks of lesson L03 require."""

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
        "Each stopping distance is near v² / (2 μ g) with the larger coefficient, despite the hops."
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
        "At the baseline's solver step cubes rebound; at all smaller steps studied, none does."
    ),
    "scatter_shrinks": (
        "The scatter of the depth over the heights of fall is smaller with every smaller step."
    ),
    "default_cone_hops": (
        "With the engine's default friction model, both pushed cubes leave the surface."
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
    "engines_land_alike": (
        "With equal settings, cubes land in MuJoCo as in the engine, at every shared sample."
    ),
    "engines_hop_alike": (
        "With equal settings, pushed cubes make the same hop in MuJoCo, with either cone."
    ),
}
"""What each named check of the pages requires, shown where it passed."""
