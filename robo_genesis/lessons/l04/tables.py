"""Tables of L04: the robot, the metrics, and what the studies of the stepped joint measured."""

from collections.abc import Mapping

from robo_genesis.core.comparison import BROKEN, HELD, WITHIN_MARGIN, Relation
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.tables import Rows, as_table, markdown
from robo_genesis.core.tables import metric_table as by_case
from robo_genesis.core.text import format_value

from . import spec, study, study_spec
from .metrics import StepMetrics

MEASURES = False

ENGINE_LABELS = {
    engine: engine if engine == "Genesis" else f"MuJoCo {engine}"
    for engine in study.ENGINES
}


CLOSE = "too close to call"  # Two values differ by no more than the margin

NOUNS, UNITS = StepMetrics.about("noun"), StepMetrics.about("unit")


def share_text(share: float) -> str:
    """Write a share for a reader: `12.3 %`."""
    return f"{100 * share:.1f} %"


def margin_text(metric: str) -> str:
    """Write the margin of a metric with its unit."""
    unit = UNITS[metric].replace("1", "samples")
    return f"{spec.MARGINS[metric]:g} {unit}"


def model_table(run: Experiment) -> str:
    """Return the engine's counts of the robot."""
    return markdown([run.readings["model"]])


def joint_table(run: Experiment) -> str:
    """Return the joints by name with their DOFs and limits."""
    return markdown(run.joints.rows())


def metric_table(run: Experiment) -> str:
    """Return the metrics of all cases of the lab."""
    return by_case({name: run.metrics[name] for name in spec.CASES})


def compared_metrics(run: Experiment) -> str:
    """Return the metrics of G1 to G3."""
    return by_case({name: run.metrics[name] for name in study_spec.COMPARED})


@as_table
def force_ranges(run: Experiment) -> Rows:
    """Return the gains and the force range of each joint in the baseline."""
    limits, joints = run.traces["baseline"].effort_limit, run.joints
    for k, name in enumerate(joints.names):
        yield {
            "joint": name,
            "KP [effort per rad or m]": spec.BASELINE.kp[k],
            "KV [effort·s per rad or m]": spec.BASELINE.kv[k],
            "range, read back": f"{-limits[k]:g} … {limits[k]:g} {joints.effort_units[k]}",
        }


@as_table
def first_demand(run: Experiment) -> Rows:
    """Compare for each case the demand of the PD law at t = 0 with the clipped effort."""
    k = spec.ENTRY
    for name, case in study_spec.COMPARED.items():
        trace = run.traces[name]
        yield {
            "case": name,
            "demand at t = 0": f"{case.kp[k] * (case.q_target[k] - trace.q[0, k]):.0f} N·m",
            "clipped effort": f"{trace.start_control_force[k]:.0f} N·m",
            "at the same limit until": format_value(study.at_limit_until(trace), "s"),
        }


@as_table
def outcomes_of_predictions(run: Experiment) -> Rows:
    """Return the values and the outcome of each prediction of the lesson."""
    for relation in spec.RELATIONS:
        yield {
            "prediction": _claim(relation),
            "measured": _change(run.metrics, relation),
            "margin": margin_text(relation[1]),
            "outcome": _said(run, relation),
        }


def _claim(relation: Relation) -> str:
    """Write the claim of an ordering."""
    (first, second), metric, claim, _ = relation
    return f"{NOUNS[metric]}: {second} {claim} than {first}"


def _said(run: Experiment, relation: Relation) -> str:
    """Return the outcome of a prediction; a close one is too close to call."""
    (first, second), metric, _, margin = relation
    one, other = (getattr(run.metrics[case], metric) for case in (first, second))
    if one is None or other is None:
        return "cannot be judged"
    state, _ = study.relation_outcome(run, "Genesis", relation)
    held = f"{HELD} ({CLOSE})" if 0 < abs(one - other) <= margin else HELD
    return {WITHIN_MARGIN: CLOSE, BROKEN: "**did not hold**"}.get(state, held)


def _change(found: Mapping[str, StepMetrics], relation: Relation) -> str:
    """Write the metric of an ordering for its two cases: `0.12 s → 0.11 s`."""
    cases, metric, *_ = relation
    return " → ".join(
        format_value(getattr(found[of], metric), UNITS[metric]) for of in cases
    )


@as_table
def gravity_table(run: Experiment) -> Rows:
    """Return for each case KP × final error beside the gravity effort, and how the case ended."""
    for name in spec.CASES:
        m, (support, effort) = run.metrics[name], study.supports(run, name)
        yield {
            "case": name,
            "KP × final error": format_value(support, "N·m"),
            "gravity, engine": format_value(effort, "N·m"),
            "difference": share_text(abs(support - effort) / abs(effort)),
            "final velocity": format_value(m.final_velocity, "rad/s"),
            "settled from": format_value(m.settling_time, "s"),
        }


@as_table
def mass_table(run: Experiment) -> Rows:
    """Return the inertia of the stepped joint, and the masses with a commanded position."""
    readings = run.readings[study.GROUP]
    masses = {"without effort, less h · d": readings["inertia_Genesis"]}
    for kv in study.COMPARED_KV:
        masses[f"position commanded, KV = {kv:g}"] = readings[f"mass_KV_{kv:g}"]
        term = study.implicit_term(run, kv)
        masses[f"that, less h (d + KV) = {term:g}"] = study.without_term(run, kv)
    for what, mass in masses.items():
        yield {f"`get_mass_mat`, {spec.STEPPED_JOINT}": what, "kg·m²": mass}


@as_table
def ideal_table(run: Experiment) -> Rows:
    """Return the linear joint's parameters and overshoot for each compared case."""
    for case in study_spec.COMPARED:
        ideal = study.ideal(run, case)
        yield {
            "case": case,
            "KP [N·m/rad]": ideal.kp,
            "KV + passive damping [N·m·s/rad]": ideal.damping,
            "ζ": f"{ideal.zeta:.2f}",
            "ideal overshoot [share of step]": share_text(ideal.overshoot),
        }


@as_table
def stepped_table(run: Experiment) -> Rows:
    """Return the overshoots of the ideal joint, of the stepped model and of the engine."""
    heads, small = ("ideal joint", "stepped model", "Genesis"), study_spec.SMALL_STEP
    for height, cases in (
        (small, study_spec.SMALL_STEPPED),
        (spec.STEP, study_spec.COMPARED),
    ):
        for case in cases:
            found = study.overshoots(run, case, height)
            yield {"run": f"{case}, +{height:g} rad"} | {
                head: share_text(of / height)
                if height == small
                else format_value(of, "rad")
                for head, of in zip(heads, found, strict=True)
            }


@as_table
def convergence_table(run: Experiment) -> Rows:
    """Return for each solver step G2's overshoot in both engines; unstable runs are marked."""
    for n in study_spec.SUBSTEPS_STUDIED:
        row = {"substeps": n, "h": f"{1000 * spec.G2.dt / n:g} ms"}
        for engine, label in ENGINE_LABELS.items():
            overshoot = study.overshoot_by_substeps(run, engine)[n]
            mark = " (unstable)" * study.unstable(run, engine, n)
            row[label] = format_value(overshoot, "rad") + mark
        yield row


@as_table
def relation_table(run: Experiment) -> Rows:
    """Return for each ordering that the lesson claims its state and values in each engine."""
    for relation in spec.RELATIONS:
        row = {"claim": _claim(relation)}
        for engine, label in ENGINE_LABELS.items():
            state, _ = study.relation_outcome(run, engine, relation)
            if study.unstable(run, engine):
                state = "unstable"
            row[label] = f"{state}: {_change(study.compared(run, engine), relation)}"
        yield row


def metrics_by_engine(run: Experiment) -> str:
    """Return all metrics of G1 to G3, one table for each engine."""
    return "\n".join(
        f"**{label}**\n\n{by_case(study.compared(run, engine))}"
        for engine, label in ENGINE_LABELS.items()
    )
