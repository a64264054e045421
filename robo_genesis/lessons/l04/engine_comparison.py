"""One experiment with several solver steps, integrators and engines: tables and sentences."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from robo_genesis.core import tables
from robo_genesis.core.comparison import HELD
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.text import bullets, format_value, listed
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04 import spec, study, study_spec
from robo_genesis.lessons.l04.metrics import StepMetrics, is_saturated
from robo_genesis.lessons.l04.study import ENGINES, GROUP, relation_outcome
from robo_genesis.sim.arm.franka import JOINT_NAMES

MEASURES = False

NOUNS, UNITS = StepMetrics.about("noun"), StepMetrics.about("unit")

ENGINE_LABELS = {"Genesis": "Genesis"} | {
    name: f"MuJoCo {name}" for name in study_spec.SECOND_INTEGRATORS
}


def first_step(run: Experiment) -> str:
    """Return the speeds after the first step, and what they say."""
    return f"{tables.markdown(first_step_rows(run))}\n\n{first_step_sentence(run)}"


def convergence_table(run: Experiment) -> str:
    """Return for each solver step G2's overshoot in both engines."""
    return tables.markdown(convergence_rows(run))


def convergence_conclusions(run: Experiment) -> str:
    """Describe the effect of a finer solver step in each engine."""
    return bullets(convergence_sentences(stable_overshoots(run), spec.G2.substeps))


def relation_table(run: Experiment) -> str:
    """Return for each claimed ordering its state and values in each engine."""
    return tables.markdown(relation_rows(run))


def metrics_by_engine(run: Experiment) -> str:
    """Return all metrics of G1 to G3, one table for each engine."""
    return "\n".join(
        f"**{ENGINE_LABELS[engine]}**\n\n{tables.metric_table(study.compared(run, engine))}"
        for engine in ENGINES
    )


def explicit_conclusions(run: Experiment) -> str:
    """Name the joints that chattered in MuJoCo with the gains of G2 and of G3."""
    return bullets(
        f"{case}: {explicit_sentence(JOINT_NAMES, study.damping_ratio(case), _second(run, case))}"
        for case in ("G2", "G3")
    )


def explicit_table(run: Experiment, case: str) -> str:
    """Return the explicit damping ratio of each joint and its clipped samples in MuJoCo."""
    ratio = study.damping_ratio(case)
    return tables.markdown(explicit_rows(JOINT_NAMES, ratio, _second(run, case)))


def _second(run: Experiment, case: str) -> dict[str, Trace]:
    """Return a compared case's runs in MuJoCo by integrator, at the lesson's solver step."""
    found = study.by_engine(run, case)
    return {name: found[name] for name in study_spec.SECOND_INTEGRATORS}


def stable_overshoots(run: Experiment) -> dict[str, dict[int, float]]:
    """Return by engine and number of substeps G2's overshoot [rad]; unstable runs are left out."""
    found = {engine: study.overshoot_by_substeps(run, engine) for engine in ENGINES}
    return {
        engine: {n: v for n, v in values.items() if not study.unstable(run, engine, n)}
        for engine, values in found.items()
    }


def convergence_rows(run: Experiment) -> list[dict[str, Any]]:
    """Return for each solver step G2's overshoot in both engines; unstable runs are marked."""
    found = {engine: study.overshoot_by_substeps(run, engine) for engine in ENGINES}
    stable = stable_overshoots(run)
    return [
        {"substeps": n, "h": f"{1000 * spec.G2.dt / n:g} ms"}
        | {
            ENGINE_LABELS[engine]: format_value(v[n], "rad")
            + ("" if n in stable[engine] else " (unstable)")
            for engine, v in found.items()
        }
        for n in study_spec.SUBSTEPS_STUDIED
    ]


def convergence_sentences(
    overshoot: Mapping[str, Mapping[int, float]], declared: int
) -> Iterator[str]:
    """Describe the effect of a finer solver step on the overshoot, in each engine.

    Args:
        overshoot: by engine and number of substeps [rad], stable runs alone.
        declared: substeps of the lesson's own runs.
    """
    finest = max(next(iter(overshoot.values())))
    for engine, values in overshoot.items():
        if declared not in values:
            yield (
                f"{ENGINE_LABELS[engine]} is unstable at {declared} substeps. Its runs there are "
                "left out of the spread."
            )
            continue
        coarse, fine = values[declared], values[finest]
        change = (
            "does not change measurably"
            if abs(fine - coarse) <= spec.RESOLUTION["rad"]
            else f"changes from {format_value(coarse, 'rad')} to {format_value(fine, 'rad')}"
        )
        yield (
            f"{ENGINE_LABELS[engine]}: from {declared} to {finest} substeps the overshoot {change}."
            + last_change(values, declared)
        )
    columns = ([v[n] for v in overshoot.values() if n in v] for n in (declared, finest))
    before, after = (max(column) - min(column) for column in columns)
    spread = f"from {format_value(before, 'rad')} to {format_value(after, 'rad')}"
    yield (
        f"The spread of the stable runs falls {spread}: the difference at the lesson's step comes "
        "mostly from the numerical method, not from the robot models."
        if after <= study_spec.SPREAD_SHARE * before
        else f"The spread of the stable runs changes {spread}. A finer step does not bring them "
        "together, so look for a difference between the models as well."
    )


def last_change(values: Mapping[int, float], declared: int) -> str:
    """Say if the last refinement still changes the overshoot; the sentence has a space in front.

    `values` are overshoots by number of substeps [rad], `declared` are the lesson's own substeps.
    """
    finer, finest = sorted(values)[-2:]
    change = abs(values[finest] - values[finer])
    if finer <= declared or change <= spec.MARGINS["overshoot"]:
        return ""
    return (
        f" From {finer} to {finest} substeps it still changes by {format_value(change, 'rad')}, "
        "more than the margin, so it has not converged."
    )


def alone(run: Experiment, case: str, term: float) -> float:
    """Return the stepped joint's speed [rad/s] after the first step, its neighbours held still.

    Args:
        run: inertia, passive damping and gravity of the start pose.
        case: one of the compared cases; its effort is assumed to be clipped throughout the step.
        term: the integrator's addition to the passive damping on the inertia's side [N·m·s/rad].
    """
    configured, readings = study_spec.COMPARED[case], run.readings[GROUP]
    damping, inertia = readings["passive_damping"], readings["inertia_Genesis"]
    h = configured.dt / configured.substeps
    effort = float(run.traces[case].start_control_force[spec.ENTRY])
    speed = 0.0
    for _ in range(configured.substeps):
        net = effort - damping * speed - readings["gravity_at_start_Genesis"]
        speed += h * net / (inertia + h * (damping + term))
    return speed


def first_step_rows(run: Experiment) -> list[dict[str, Any]]:
    """Return for each compared case the stepped joint's speed after the first step, by engine."""
    return [
        {
            "case": case,
            "alone, with the term": format_value(alone(run, case, float(kv)), "rad/s"),
            "alone, without it": format_value(alone(run, case, 0.0), "rad/s"),
        }
        | {
            ENGINE_LABELS[engine]: format_value(float(trace.qd[0, spec.ENTRY]), "rad/s")
            for engine, trace in study.by_engine(run, case).items()
        }
        for case, configured in study_spec.COMPARED.items()
        for kv in [configured.kv[spec.ENTRY]]
    ]


def first_step_sentence(run: Experiment) -> str:
    """Name the engines in which G2 and G3 moved alike while both were clipped."""
    fast, slow = (study.by_engine(run, case) for case in ("G2", "G3"))
    if not all(clipped_at_start(t, spec.ENTRY) for t in (*fast.values(), *slow.values())):
        return (
            "G2 and G3 were not both clipped before and after the first step in every engine, so "
            "their speeds after it do not isolate the integrator."
        )
    alike: list[str] = []
    apart: list[str] = []
    for engine in ENGINES:
        difference = abs(fast[engine].qd[0, spec.ENTRY] - slow[engine].qd[0, spec.ENTRY])
        same = difference <= spec.RESOLUTION["rad/s"]
        (alike if same else apart).append(ENGINE_LABELS[engine])
    text = "G2 and G3 differ in KV alone and were clipped to one effort before and after this step."
    if alike:
        text += f" They move alike in {listed(alike)}: there KV has no effect while clipped."
    if apart:
        text += f" They differ in {listed(apart)}: there KV acts although the effort is clipped."
    return text


def clipped_at_start(trace: Trace, entry: int) -> bool:
    """Return whether a joint's effort is clipped before the first step and after it."""
    efforts = np.array([trace.start_control_force[entry], trace.control_force[0, entry]])
    return bool(is_saturated(efforts, trace.effort_limit[entry]).all())


def relation_rows(run: Experiment) -> list[dict[str, Any]]:
    """Return for each ordering that the lesson claims its state and values in each engine."""
    rows = []
    for relation in spec.RELATIONS:
        pair, metric, order, _ = relation
        row: dict[str, Any] = {"claim": f"{NOUNS[metric]}: {pair[1]} {order} than {pair[0]}"}
        for engine in ENGINES:
            state, _ = relation_outcome(run, engine, relation)
            found = study.compared(run, engine)
            values = [format_value(getattr(found[case], metric), UNITS[metric]) for case in pair]
            shown = "unstable" if study.unstable(run, engine) else state
            row[ENGINE_LABELS[engine]] = f"{shown}: {values[0]} → {values[1]}"
        rows.append(row)
    return rows


def survival_sentence(run: Experiment) -> str:
    """Count the claimed orderings that every stable engine shows, and name the others."""
    failed = []
    stable = [engine for engine in ENGINES if not study.unstable(run, engine)]
    left = [ENGINE_LABELS[engine] for engine in ENGINES if engine not in stable]
    out = f" {listed(left)} is left out, because its runs are unstable." if left else ""
    for relation in spec.RELATIONS:
        pair, metric, order, _ = relation
        states = {engine: relation_outcome(run, engine, relation)[0] for engine in stable}
        not_held = [f"{ENGINE_LABELS[e]}: {s}" for e, s in states.items() if s != HELD]
        if not_held:
            claim = f"{NOUNS[metric]} {order} in {pair[1]} than in {pair[0]}"
            failed.append(f"{claim} ({'; '.join(not_held)})")
    count = len(spec.RELATIONS)
    if not failed:
        return (
            f"All {count} orderings that this lesson claims hold in {listed(_labels(stable))}. The "
            "numbers themselves differ: quote a number only together with engine, integrator and "
            f"solver step.{out}"
        )
    return (
        f"Of the {count} orderings that this lesson claims, {count - len(failed)} hold in "
        f"{listed(_labels(stable))}. These do not hold in each of them: "
        f"{', '.join(failed)}.{out}"
    )


def _labels(engines: Sequence[str]) -> list[str]:
    return [ENGINE_LABELS[engine] for engine in engines]


def explicit_rows(
    names: Sequence[str], ratio: FloatArray, traces: Mapping[str, Trace]
) -> list[dict[str, Any]]:
    """Return for each joint its explicit damping ratio and its number of clipped samples.

    Args:
        names: of the joints.
        ratio: solver step · (KV + damping) / inertia of each joint (d,).
        traces: by integrator, runs of one case.
    """
    counts = {
        integrator: is_saturated(trace.control_force, trace.effort_limit).sum(axis=0)
        for integrator, trace in traces.items()
    }
    return [
        {"joint": name, "h (KV + d) / I": f"{ratio[k]:.2f}"}
        | {f"clipped, {one}": format_value(int(count[k]), "1") for one, count in counts.items()}
        for k, name in enumerate(names)
    ]


def explicit_sentence(names: Sequence[str], ratio: FloatArray, traces: Mapping[str, Trace]) -> str:
    """Name the joints for which explicit damping overshoots, and those that chattered.

    Arguments as in `explicit_rows`.
    """
    over = [name for name, value in zip(names, ratio, strict=True) if value > 2]
    sentences = [f"h (KV + d) / I is above two for {listed(over or ['no joint'])}."]
    for integrator, trace in traces.items():
        clipped = study.unstable_joints(trace)
        sentences.append(
            f"With {integrator}, {listed(clipped or ['no joint'])} had a clipped effort in more "
            "than half of all samples."
        )
    return " ".join(sentences)
