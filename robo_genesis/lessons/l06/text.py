"""Tables and sentences of L06's lecture and lab, each a function of the experiment."""

from collections.abc import Sequence

from robo_genesis.core import tables
from robo_genesis.core.text import bullets, listed
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l06 import spec, study
from robo_genesis.lessons.l06.metrics import WorldMetrics

SHOWN_TORQUES = (1, 3)
"""The joints with a torque in the table of variants: joint2 and joint4."""


def mm(value: float | None, digits: int = 2) -> str:
    """Return a length as millimetres; a dash where none was observed."""
    return "–" if value is None else f"{1000 * value:.{digits}f}"


def shape_table(run: Experiment) -> str:
    """Return the number of axes and rows by the number of environments."""
    found = run.readings["shapes"]
    axes = {
        "`build()`": found["axes_without_environments"],
        "`build(n_envs=1)`": found["axes_with_one_environment"],
        "`build(n_envs=4)`": found["axes_with_four_environments"],
    }
    forms = {1: "(9,)", 2: "(rows, 9)"}
    return tables.markdown(
        [
            {"scene": scene, "axes": f"{n:g}", "shape of `get_dofs_position`": forms[int(n)]}
            for scene, n in axes.items()
        ]
    )


def mixed_table(run: Experiment) -> str:
    """Return residual and verdict of each row of the question with a target beyond reach."""
    limit = spec.IK.position_tolerance
    residuals = list(run.readings["mixed"].values())
    rows = [
        {
            "row": f"{k}",
            "target [m]": ", ".join(f"{value:g}" for value in spec.MIXED[k]).replace("-", "−"),
            "residual [mm]": mm(residual, 3),
            "the row is": "accepted" if residual <= limit else "**refused**",
        }
        for k, residual in enumerate(residuals)
    ]
    return tables.markdown(rows)


def row_table(run: Experiment) -> str:
    """Return residual and distances of each environment."""
    rows = []
    for name in spec.WORLDS:
        m = run.metrics[name]
        rows.append(
            {
                "run": spec.LABELS[name],
                "residual of the last command [mm]": mm(m.residual, 3),
                "first target after 1.8 s [mm]": mm(m.first_distance),
                "last target at the end [mm]": mm(m.final_distance),
                "motion after 1.8 s [mm]": mm(m.moved_later),
            }
        )
    return tables.markdown(rows)


def alone_table(run: Experiment) -> str:
    """Return the largest differences between each row and the same run alone."""
    rows = []
    for k in spec.ENVS:
        row, alone = run.traces[f"env_{k}"], run.traces[f"alone_{k}"]
        apart = study.largest_differences(row, alone)
        differ, compared = study.entries_that_differ(row, alone)
        rows.append(
            {
                "run": spec.LABELS[f"env_{k}"],
                "joint position [µrad]": f"{1e6 * apart['q']:.2f}",
                "joint velocity [µrad/s]": f"{1e6 * apart['qd']:.1f}",
                "control force [mN·m]": f"{1e3 * apart['control_force']:.2f}",
                "entries that differ [%]": f"{100 * differ / compared:.0f}",
            }
        )
    return tables.markdown(rows)


CLAIMED = {
    "permuted": "the rows in the order {order}",
    "beside": "rows {kept}, while rows {reset} are reset and commanded after {after} s",
    "again": "rows {reset} from their reset on, against their first start",
    "plain": "the plain row beside other gains and loads, against environment 0",
}


def equal_table(run: Experiment) -> str:
    """Return how many entries differ where runs must be equal to the last bit."""
    words = {
        "order": ", ".join(map(str, spec.ORDER)),
        "kept": listed([name[-1] for name in spec.BESIDE]),
        "reset": listed([name[-1] for name in spec.AGAIN]),
        "after": f"{spec.RESET_AFTER * spec.FIRST.dt:g}",
    }
    rows = []
    for claim, names in study.pairs().items():
        counted = [
            study.entries_that_differ(run.traces[one], run.traces[other]) for one, other in names
        ]
        differ, compared = (sum(column) for column in zip(*counted, strict=True))
        rows.append(
            {
                "what changed": CLAIMED[claim].format(**words),
                "numbers compared": f"{compared:,}".replace(",", " "),
                "that differ": f"{differ}",
            }
        )
    return tables.markdown(rows)


def variant_table(run: Experiment) -> str:
    """Return gains, mass, torques and distances of four robots with one target."""
    rows = []
    for name, world in spec.VARIANTS.items():
        trace, m = run.traces[name], run.metrics[name]
        expected = study.torque_at_rest(trace.q[-1].astype(float), world.load)
        row = {
            "row": spec.LABELS[name],
            "KP of joint2 [N·m/rad]": f"{world.kp[1]:.0f}",
            "mass of the hand [kg]": f"{run.readings['hand_mass'][name]:.2f}",
        }
        for k in SHOWN_TORQUES:
            torques = f"{trace.control_force[-1, k]:.2f} ({expected[k]:.2f})".replace("-", "−")
            row[f"torque of joint{k + 1} (computed) [N·m]"] = torques
        rows.append(row | {"target to hand [mm]": mm(m.final_distance)})
    return tables.markdown(rows)


def metric_table(run: Experiment) -> str:
    """Return the metrics of the four environments in millimetres and milliradians."""
    labels, units = (WorldMetrics.about(what) for what in ("label", "unit"))
    return tables.markdown(
        [
            {"metric": f"{label} [m{units[metric]}]"}
            | {spec.LABELS[name]: mm(getattr(run.metrics[name], metric), 3) for name in spec.WORLDS}
            for metric, label in labels.items()
        ]
    )


def span(values: Sequence[float]) -> str:
    """Return the smallest and the largest of some lengths in millimetres."""
    return f"{mm(min(values))} to {mm(max(values))} mm"


def conclusions(run: Experiment) -> str:
    """Return the sentences about the lab's runs."""
    m = run.metrics
    kept = [m[f"env_{name[-1]}"].moved_later for name in spec.BESIDE]
    later = [m[f"env_{name[-1]}"].moved_later for name in spec.AGAIN]
    limit = spec.IK.position_tolerance
    accepted = [f"{k}" for k, r in enumerate(run.readings["mixed"].values()) if r <= limit]
    apart = max(
        study.largest_differences(run.traces[f"env_{k}"], run.traces[f"alone_{k}"])["q"]
        for k in spec.ENVS
    )
    differ = {
        claim: sum(
            study.entries_that_differ(run.traces[one], run.traces[other])[0] for one, other in names
        )
        for claim, names in study.pairs().items()
    }
    same = [claim for claim, count in differ.items() if not count]
    lines = [
        f"Of the question with one target beyond reach, rows {listed(accepted)} are accepted. "
        "No mean over the rows says that.",
        f"The hands end {span([m[name].final_distance for name in spec.WORLDS])} from their last "
        "targets.",
        f"After the second command, the named environments moved by {span(later)}, the others by "
        f"{span(kept)}.",
        f"Joint positions of a row and of the same run alone differ by up to {1e6 * apart:.2f} "
        "µrad (or µm of a finger).",
        f"{len(same)} of {len(differ)} comparisons within batches are equal to the last bit.",
    ]
    for name in list(spec.VARIANTS)[1:]:
        found, plain = m[name].final_distance, m["plain"].final_distance
        verb = "nearer to" if found < plain else "farther from"
        label = spec.LABELS[name]
        lines.append(
            f"{label[0].upper()}{label[1:]}: the hand stops {mm(abs(found - plain))} mm {verb} "
            "its target than the plain one."
        )
    return bullets(lines)
