"""Tables of L05, and the sentences that the lab generates, each a function of the experiment."""

from typing import Any

import numpy as np

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.text import bullets, decimal
from robo_genesis.sim.arm import kinematics
from robo_genesis.sim.arm.franka import JOINT_NAMES
from robo_genesis.sim.camera import geometry as cameras
from robo_genesis.sim.camera.checks import PLANE_FAR, computed, from_plane, from_sphere
from robo_genesis.sim.camera.record import SEGMENTS, view_of
from robo_genesis.sim.mujoco import kinematics as mujoco_kinematics

from . import spec, study
from .checks import marker
from .metrics import ReachMetrics

MEASURES = False

NO_PICTURE = "SKIP: no camera"

SHOWN = 3  # Joints with a row of their own in the table of gravity

# Share of the force limit from which a sample is counted as at the limit
AT_LIMIT = 0.99

# What chooses one of several answers: a key of `study.answers`, and which value is
# best.
CRITERIA = {
    "nearest to the present posture": ("from_start", min),
    "farthest from the limits": ("margin", max),
    "largest manipulability": ("manipulability", max),
}

TIP = "fingertips above the floor [mm]"

# Columns of `records`: key of `study.answers`, factor and significant digits.
QUANTITIES = {
    "manipulability": ("manipulability", 1, 3),
    "distance from limits [rad]": ("margin", 1, 3),
    "largest angle from the present posture [rad]": ("from_start", 1, 3),
    "distance left [mm]": ("position", 1000, 4),
    "angle left [mrad]": ("rotation", 1000, 4),
    TIP: ("tip", 1000, 3),
}


def error_table(run: Experiment) -> str:
    """Return four distances and angles of the baseline, each between two named poses."""
    m, ik = run.metrics["baseline"], run.readings[study.GROUP]
    rows = {
        "residual that the solver reported": (ik["residual_m"], ik["residual_rad"]),
        "target to pose of the command, by FK": (m.command_distance, m.command_angle),
        "pose of the command to measured hand": (m.tracking_distance, m.tracking_angle),
        "target to measured hand": (m.final_distance, m.final_angle),
    }
    heads = {"distance [mm]": 3, "angle [mrad]": 3}
    return tables.number_table(
        "between", heads, {w: 1000 * np.array(of) for w, of in rows.items()}
    )


def sag_table(run: Experiment) -> str:
    """Return the measured sag and rotation, from command to end, beside those by gravity.

    The page that shows it explains the heads.
    """
    heads = {
        "sag [mm]": 2,
        "computed [mm]": 2,
        "rotation [mrad]": 2,
        "computed [mrad]": 2,
        "not explained [%]": 1,
    }
    rows = {}
    for name in spec.CASES:
        found, expected, rest, turned = study.sag_lengths(run, name)
        lengths = found, expected, run.metrics[name].tracking_angle, turned
        rows[spec.LABELS[name]] = *(1000 * np.array(lengths)), 100 * rest
    return tables.number_table("run", heads, rows)


def price_table(run: Experiment) -> str:
    """Return how far each run passes the target, and in how many samples it is at a force limit."""
    heads = {"past the target [mm]": 1, "at limit": 0, "at the end [mm]": 2}
    rows = {}
    for name, m in run.metrics.items():
        trace = run.traces[name]
        at_limit = np.abs(trace.control_force) >= AT_LIMIT * trace.effort_limit
        samples = at_limit[:, : kinematics.ARM].any(axis=1).sum()
        rows[spec.LABELS[name]] = 1000 * m.overshoot, samples, 1000 * m.final_distance
    return tables.number_table("run", heads, rows)


def tolerance_table(run: Experiment) -> str:
    """Return the iterations and the residual of the solver for each tolerance."""
    needed, left = run.readings[study.ITERATIONS], run.readings[study.PRECISE]
    rows = {}
    for name, case in spec.PRECISE.items():
        words = f"{1e6 * case.settings.position_tolerance:g} µm"
        rows[words] = needed[name], 1e6 * left[name]
    return tables.number_table("tolerance", {"iterations": 0, "residual [µm]": 2}, rows)


def jacobian_table(run: Experiment) -> str:
    """Return the largest difference of other Jacobians from ours in each posture, in millionths."""
    rows = {}
    for name, q in study.jacobian_postures(run).items():
        apart = run.readings[study.JACOBIANS][name], *study.other_jacobians(q)
        rows[name.replace("_", " ")] = 1e6 * np.array(apart)
    others = ("engine [10⁻⁶]", "MuJoCo [10⁻⁶]", "difference quotients [10⁻⁶]")
    return tables.number_table("posture", dict.fromkeys(others, 3), rows)


def singular_table(run: Experiment) -> str:
    """Return the singular values of the Jacobian and their product in each posture."""
    rows = {}
    for name, q in study.jacobian_postures(run).items():
        values = np.linalg.svd(kinematics.jacobian(q), compute_uv=False)
        rows[name.replace("_", " ")] = *values, values.prod()
    heads = {f"s{k}": 3 for k in range(1, 7)} | {"product": 4}
    return tables.number_table("posture", heads, rows)


def joint_table(run: Experiment) -> str:
    """Return the joints that lower the hand most: gravity in the command, angle, and way."""
    heads = {
        "torque to hold [N·m]": 2,
        "KP [N·m/rad]": 0,
        "position − command, computed [mrad]": 2,
        "moves the hand along z by [mm]": 2,
    }
    q, arm = run.traces["baseline"].target[-1].astype(float), slice(kinematics.ARM)
    effort, kp = mujoco_kinematics.gravity_effort(q)[arm], spec.BASELINE.kp[arm]
    angles = -1000 * effort / kp
    ways = kinematics.jacobian(q)[2] * angles
    most = sorted(np.abs(ways).argsort()[-SHOWN:])
    rows = {f"`{JOINT_NAMES[k]}`": (effort[k], kp[k], angles[k], ways[k]) for k in most}
    rows["all others"] = "", "", "", ways.sum() - ways[most].sum()
    return tables.number_table("joint", heads, rows)


def marker_table(run: Experiment) -> str:
    """Return where the marker is in the picture: computed twice, and counted."""
    view, sphere = view_of(run, spec.VIEWED), marker(run)
    words = ("projection of its centre", "centre of its silhouette")
    rows: dict[str, Any] = dict(zip(words, computed(view, sphere), strict=True))
    seen = view.segmentation
    at = (NO_PICTURE,) * 2 if seen is None else cameras.centroid(seen == sphere.number)
    rows["centroid of its pixels"] = at
    return tables.number_table("what", {"u [pixel]": 3, "v [pixel]": 3}, rows)


def surfaces(run: Experiment) -> dict[str, cameras.Residuals]:
    """Return the distances of back-projected pixels from the surfaces that they show [m]."""
    view, plane = view_of(run, spec.VIEWED), int(run.readings[SEGMENTS]["plane"])
    found = {
        "marker": from_sphere(view, marker(run)),
        f"ground nearer than {PLANE_FAR:g} m": from_plane(view, plane),
    }
    return {name: left for name, left in found.items() if left is not None}


def depth_table(run: Experiment) -> str:
    """Return how far back-projected pixels are from the surfaces in closed form."""
    heads = {"pixels": 0, "mean [mm]": 3, "largest [mm]": 3}
    rows = {
        n: (of.count, 1000 * of.mean, 1000 * of.largest)
        for n, of in surfaces(run).items()
    }
    return tables.number_table("surface", heads, rows or {NO_PICTURE: ("", "", "")})


def metric_table(run: Experiment) -> str:
    """Return the metrics of all runs in millimetres and milliradians."""
    metrics = [run.metrics[case] for case in spec.CASES]
    units, rows = ReachMetrics.about("unit"), {}
    for name, label in ReachMetrics.about("label").items():
        values = [1000 * getattr(m, name) for m in metrics]
        rows[f"{label} [m{units[name]}]"] = values
    heads = {spec.LABELS[case]: 3 for case in spec.CASES}
    return tables.number_table("metric", heads, rows)


def conclusions(run: Experiment) -> str:
    """Return the sentences about the lab's runs and its picture."""
    ((_, base), *others), ik = run.metrics.items(), run.readings[study.GROUP]
    residuals = np.array([ik["residual_m"], ik["residual_rad"]])
    answer = "accepted" if (residuals <= spec.IK.tolerances).all() else "refused"
    return bullets(
        [
            f"The answer of the solver is {answer}: its residual is "
            f"{1000 * residuals[0]:.3f} mm and {1000 * residuals[1]:.4f} mrad.",
            "The hand's distance from its target went from "
            f"{1000 * base.start_distance:.1f} mm to {1000 * base.final_distance:.2f} mm. "
            f"The arm stopped {1000 * base.tracking_distance:.2f} mm from the pose of its command.",
            *(
                f"With {spec.LABELS[name]}, {1000 * m.final_distance:.2f} mm are left."
                for name, m in others
            ),
            *(
                f"The pixels of the {name} are "
                f"{1000 * found.largest:.3f} mm or less from its surface."
                for name, found in surfaces(run).items()
            ),
        ]
    )


def records(run: Experiment, name: str) -> list[dict[str, str]]:
    """Return what is known of each answer of a run as rows of a table."""
    case, q = spec.QUESTIONS[name], run.traces[name].q[1:, : kinematics.ARM]
    found, (lower, upper) = study.answers_of(run, name), spec.ARM_LIMITS
    nearest = np.minimum(q - lower, upper - q).argmin(axis=1)
    return [
        {
            "answer": str(k + 1),
            "target x, y, z [m]": "{:g}, {:g}, {:g}".format(*case.positions[k]),
            "accepted": "yes" if found["accepted"][k] else "no",
            "joint1 [rad]": decimal(q[k, 0], 3),
            "nearest to a limit": JOINT_NAMES[nearest[k]],
        }
        | {
            label: f"{round(by * found[key][k], 6) + 0.0:.{n}g}".replace("-", "−")
            for label, (key, by, n) in QUANTITIES.items()
        }
        for k in range(case.steps)
    ]


def chosen(run: Experiment) -> dict[str, int]:
    """Return by criterion the number of the accepted answer, from 0, that it chooses."""
    found = study.answers_of(run, "many_starts")
    numbers = np.flatnonzero(found["accepted"]).tolist()
    return {
        n: best(numbers, key=found[key].__getitem__)
        for n, (key, best) in CRITERIA.items()
    }


@tables.as_table
def family_table(run: Experiment) -> tables.Rows:
    """Return the curves on which the accepted answers are."""
    for number, (curve, inside) in enumerate(study.solution_families(run), start=1):
        length = np.linalg.norm(np.diff(curve, axis=0), axis=1).sum()
        row = {"curve": number, "answers": len(inside), "length [rad]": f"{length:.1f}"}
        yield row | {f"{JOINT_NAMES[k]} [rad]": span(curve[:, k], 2) for k in (0, 1, 3)}


def span(values: FloatArray, digits: int) -> str:
    """Return the smallest and the largest of values (n,)."""
    return f"{decimal(values.min(), digits)} … {decimal(values.max(), digits)}"


def choice_table(run: Experiment) -> str:
    """Return the answers that the criteria choose."""
    rows = records(run, "many_starts")
    columns = ("answer", "joint1 [rad]", *[*QUANTITIES][:3])
    return tables.markdown(
        [
            {"criterion": name} | {column: rows[k][column] for column in columns}
            for name, k in chosen(run).items()
        ]
    )


def unreachable_table(run: Experiment) -> str:
    """Compare the engine's answers for the target beyond reach with the nearest posture found."""
    found = study.answers_of(run, "unreachable")
    order = study.weighted(found["position"], found["rotation"]).argsort()
    pairs = {
        f"engine, {words}": (found["position"][k], found["rotation"][k])
        for words, k in {
            "from the lesson's start": 0,
            f"nearest of {spec.DRAWS}": order[0],
            f"median of {spec.DRAWS}": order[spec.DRAWS // 2],
            f"farthest of {spec.DRAWS}": order[-1],
        }.items()
    }
    pairs["nearest that we found"] = kinematics.distances(study.nearest()[1])
    heads = dict.fromkeys(("distance [m]", "angle [rad]", "weighted distance [m]"), 3)
    rows = {name: (*pair, study.weighted(*pair)) for name, pair in pairs.items()}
    return tables.number_table("posture", heads, rows)


@tables.as_table
def reach_table(run: Experiment) -> tables.Rows:
    """Return how many targets of each plane are accepted, and what their answers span."""
    for name in (*spec.PLANES, "vertical_restarted"):
        found = study.answers_of(run, name)
        yes = found["accepted"]
        yield {
            "plane": name.replace("_", ", "),
            "targets": len(yes),
            "accepted": int(yes.sum()),
            "of them in the floor": int((yes & (found["tip"] < 0)).sum()),
            "manipulability": span(found["manipulability"][yes], 3),
            "distance from limits [rad]": span(found["margin"][yes], 3),
            "distance left where refused [mm]": span(1000 * found["position"][~yes], 1),
        }
