"""Tables and sentences of L05's lecture and lab, each a function of the experiment."""

import numpy as np

from robo_genesis.core import tables
from robo_genesis.core.text import bullets, with_unit
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l05 import spec, study
from robo_genesis.lessons.l05.checks import marker
from robo_genesis.lessons.l05.metrics import ReachMetrics
from robo_genesis.lessons.view_record import view_of
from robo_genesis.sim import arm_kinematics as kinematics
from robo_genesis.sim import camera_geometry as cameras
from robo_genesis.sim import mujoco_kinematics
from robo_genesis.sim.arm_kinematics import ARM
from robo_genesis.sim.camera_checks import PLANE_FAR
from robo_genesis.sim.franka import JOINT_NAMES

NO_PICTURE = "SKIP: no camera"

SHOWN = 3
"""Joints with a row of their own in the table of gravity."""


def shown(value: float, digits: int) -> str:
    """Write a number with digits after the point and a true minus sign; zero has none."""
    return with_unit(value, "", digits).strip()


def error_table(run: Experiment) -> str:
    """Return four distances and angles of the baseline, each between two named poses."""
    m, ik = run.metrics["baseline"], run.readings[study.GROUP]
    rows = {
        "residual that the solver reported": (ik["residual_m"], ik["residual_rad"]),
        "target to pose of the command, by FK": (m.command_distance, m.command_angle),
        "pose of the command to measured hand": (m.tracking_distance, m.tracking_angle),
        "target to measured hand": (m.final_distance, m.final_angle),
    }
    return tables.markdown(
        [
            {"between": what, "distance [mm]": f"{1000 * d:.3f}", "angle [mrad]": f"{1000 * a:.3f}"}
            for what, (d, a) in rows.items()
        ]
    )


def sag_table(run: Experiment) -> str:
    """Return the measured way from command to end beside the one that gravity explains."""
    rows = []
    for name, case in spec.CASES.items():
        command = run.traces[name].target[-1].astype(float)
        found, expected = study.measured_sag(run.traces[name]), study.sag(command, case.kp)
        rest = np.linalg.norm((found - expected)[:3]) / np.linalg.norm(expected[:3])
        rows.append(
            {
                "run": spec.LABELS[name],
                "command to hand, measured [mm]": f"{1000 * np.linalg.norm(found[:3]):.2f}",
                "by gravity, KP and J [mm]": f"{1000 * np.linalg.norm(expected[:3]):.2f}",
                "unexplained [%]": f"{100 * rest:.1f}",
                "target to hand [mm]": f"{1000 * run.metrics[name].final_distance:.2f}",
            }
        )
    return tables.markdown(rows)


def joint_table(run: Experiment) -> str:
    """Return the joints that lower the hand most: gravity in the command, angle, and way."""
    q, kp = run.traces["baseline"].target[-1].astype(float), spec.BASELINE.kp
    effort, of = mujoco_kinematics.gravity_effort(q)[:ARM], kinematics.jacobian(q)
    angles = -effort / kp[:ARM]
    ways = of[2] * angles
    most = sorted(np.abs(ways).argsort()[-SHOWN:])
    rows = [
        {
            "joint": f"`{JOINT_NAMES[k]}`",
            "torque to hold [N·m]": shown(effort[k], 2),
            "KP [N·m/rad]": f"{kp[k]:.0f}",
            "position − command, computed [mrad]": shown(1000 * angles[k], 2),
            "moves the hand along z by [mm]": shown(1000 * ways[k], 2),
        }
        for k in most
    ]
    rest = dict.fromkeys(rows[0], "") | {"joint": "all others"}
    others = 1000 * (ways.sum() - ways[most].sum())
    return tables.markdown([*rows, rest | {"moves the hand along z by [mm]": shown(others, 2)}])


def marker_table(run: Experiment) -> str:
    """Return where the marker is in the picture: computed twice, and counted."""
    view, sphere = view_of(run, spec.VIEWED), marker(run)
    camera, centre = (view.intrinsics, view.transform), np.array(sphere.centre)
    rows = {
        "projection of its centre": cameras.project(centre, *camera),
        "centre of its silhouette": cameras.silhouette_centre(centre, sphere.radius, *camera),
    }
    texts = {what: [f"{value:.3f}" for value in found] for what, found in rows.items()}
    if view.segmentation is None:
        texts["centroid of its pixels"] = [NO_PICTURE] * 2
    else:
        found = cameras.centroid(view.segmentation == sphere.number)
        texts["centroid of its pixels"] = [f"{value:.3f}" for value in found]
    return tables.markdown(
        [{"what": w, "u [pixel]": u, "v [pixel]": v} for w, (u, v) in texts.items()]
    )


def surfaces(run: Experiment) -> dict[str, cameras.Residuals]:
    """Return the distances of back-projected pixels from the surfaces that they show [m]."""
    view, sphere = view_of(run, spec.VIEWED), marker(run)
    if view.depth is None or view.segmentation is None:
        return {}
    points = cameras.back_project(view.depth, view.intrinsics, view.transform)
    radii = np.linalg.norm(points - np.array(sphere.centre), axis=-1) - sphere.radius
    ground = view.segmentation == run.readings["segments"]["plane"]
    zero = np.zeros(view.depth.shape)
    return {
        "marker": cameras.residuals(radii, zero, view.segmentation == sphere.number),
        f"ground nearer than {PLANE_FAR:g} m": cameras.residuals(
            points[..., 2], zero, ground & (view.depth < PLANE_FAR)
        ),
    }


def depth_table(run: Experiment) -> str:
    """Return how far back-projected pixels are from the surfaces in closed form."""
    rows = [
        {
            "surface": name,
            "pixels": f"{found.count}",
            "mean [mm]": shown(1000 * found.mean, 3),
            "largest [mm]": shown(1000 * found.largest, 3),
        }
        for name, found in surfaces(run).items()
    ]
    skip = [{"surface": NO_PICTURE, "pixels": "", "mean [mm]": "", "largest [mm]": ""}]
    return tables.markdown(rows or skip)


def metric_table(run: Experiment) -> str:
    """Return the metrics of all runs in millimetres and milliradians."""
    labels, units = (ReachMetrics.about(what) for what in ("label", "unit"))
    return tables.markdown(
        [
            {"metric": f"{label} [m{units[metric]}]"}
            | {
                spec.LABELS[name]: f"{1000 * getattr(run.metrics[name], metric):.3f}"
                for name in spec.CASES
            }
            for metric, label in labels.items()
        ]
    )


def conclusions(run: Experiment) -> str:
    """Return the sentences about the lab's runs and its picture."""
    m, ik = run.metrics, run.readings[study.GROUP]
    base = m["baseline"]
    accepted = (
        ik["residual_m"] <= spec.IK.position_tolerance
        and ik["residual_rad"] <= spec.IK.rotation_tolerance
    )
    lines = [
        f"The answer of the solver is {'accepted' if accepted else 'refused'}: its residual is "
        f"{1000 * ik['residual_m']:.3f} mm and {1000 * ik['residual_rad']:.4f} mrad.",
        f"The hand's distance from its target went from {1000 * base.start_distance:.1f} mm to "
        f"{1000 * base.final_distance:.2f} mm. The arm stopped {1000 * base.tracking_distance:.2f} "
        "mm from the pose of its command.",
    ]
    for name in tuple(spec.CASES)[1:]:
        verb = "less" if m[name].final_distance < base.final_distance else "not less"
        label = spec.LABELS[name]
        lines.append(
            f"{label[0].upper()}{label[1:]}: {1000 * m[name].final_distance:.2f} mm are left, "
            f"{verb} than in the baseline."
        )
    lines += [
        f"The pixels of the {name} are {1000 * found.largest:.3f} mm or less from its surface."
        for name, found in surfaces(run).items()
    ]
    return bullets(lines)
