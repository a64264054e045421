"""One experiment by several solver steps, integrators and engines: rows and sentences."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from robo_genesis.core.orderings import HELD
from robo_genesis.core.quantities import format_value
from robo_genesis.core.scene import FloatArray
from robo_genesis.core.text import listed
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l04 import spec, study_spec
from robo_genesis.lessons.l04.metrics import SATURATION_THRESHOLD, StepMetrics
from robo_genesis.lessons.l04.study import ENGINES, Studies, relation_outcome

NOUNS = StepMetrics.about("noun")

ENGINE_LABELS = {"Genesis": "Genesis"} | {
    name: f"MuJoCo {name}" for name in study_spec.SECOND_INTEGRATORS
}


def convergence_rows(run: Studies) -> list[dict[str, Any]]:
    """Return for each solver step G2's overshoot in both engines."""
    found = {engine: run.overshoot_by_substeps(engine) for engine in ENGINES}
    return [
        {
            "substeps": n,
            "solver step [s]": f"{spec.G2.dt / n:g}",
        }
        | {
            ENGINE_LABELS[engine]: format_value(values[n], "rad")
            for engine, values in found.items()
        }
        for n in study_spec.SUBSTEPS_STUDIED
    ]


def convergence_sentences(overshoot: Mapping[str, Mapping[int, float]], declared: int) -> list[str]:
    """Say what refining the solver's step does to one metric, in each engine.

    Args:
        overshoot: by engine and number of substeps [rad].
        declared: substeps of the lesson's own runs.
    """
    told = []
    for engine, values in overshoot.items():
        coarse, fine = values[declared], values[max(values)]
        change = (
            "does not change measurably"
            if abs(fine - coarse) <= spec.RESOLUTION["rad"]
            else f"changes from {format_value(coarse, 'rad')} to {format_value(fine, 'rad')}"
        )
        told.append(
            f"{ENGINE_LABELS[engine]}: from {declared} to {max(values)} substeps the overshoot "
            f"{change}."
        )
    spreads = [
        max(v[n] for v in overshoot.values()) - min(v[n] for v in overshoot.values())
        for n in (declared, max(next(iter(overshoot.values()))))
    ]
    before, after = (format_value(spread, "rad") for spread in spreads)
    if spreads[1] <= study_spec.SPREAD_SHARE * spreads[0]:
        told.append(
            f"The spread between them falls from {before} to {after}: the difference at the "
            "lesson's step is mostly one of numerical method, not of robot models."
        )
    else:
        told.append(
            f"The spread between them goes from {before} to {after}: refining the step does not "
            "bring them together, so look for a difference between the models as well."
        )
    return told


def alone(run: Studies, case: str, term: float) -> float:
    """Return the stepped joint's speed [rad/s] after the first step, its neighbours held still.

    Args:
        run: inertia, passive damping and gravity of the start pose.
        case: one of the compared cases; its effort is taken to be clipped throughout the step.
        term: what an integrator adds to the passive damping on the inertia's side [N·m·s/rad].
    """
    configured = study_spec.COMPARED[case]
    h = configured.dt / configured.substeps
    effort = float(run.traces[case].start_control_force[run.entry])
    speed = 0.0
    for _ in range(configured.substeps):
        net = effort - run.passive_damping * speed - run.gravity_at_start["Genesis"]
        speed += h * net / (run.inertia["Genesis"] + h * (run.passive_damping + term))
    return speed


def first_step_rows(run: Studies) -> list[dict[str, Any]]:
    """Return for each compared case the stepped joint's speed after the first step, by engine."""
    kv = {case: float(study_spec.COMPARED[case].kv[run.entry]) for case in study_spec.COMPARED}
    return [
        {
            "case": case,
            "alone, with the term": format_value(alone(run, case, kv[case]), "rad/s"),
            "alone, without it": format_value(alone(run, case, 0.0), "rad/s"),
        }
        | {
            ENGINE_LABELS[engine]: format_value(float(trace.qd[0, run.entry]), "rad/s")
            for engine, trace in run.by_engine(case).items()
        }
        for case in study_spec.COMPARED
    ]


def first_step_sentence(run: Studies) -> str:
    """Say in which engines cases that differ in KV alone moved alike while both were clipped."""
    slow, fast = (run.by_engine(case) for case in ("G3", "G2"))
    alike: list[str] = []
    apart: list[str] = []
    for engine in ENGINES:
        pair = fast[engine], slow[engine]
        if not all(clipped_until_first(trace, run.entry) for trace in pair):
            return (
                "Not both of G2 and G3 were clipped through the first step in every engine, so "
                "their speeds after it do not isolate the integrator."
            )
        speeds = [float(trace.qd[0, run.entry]) for trace in pair]
        same = abs(speeds[0] - speeds[1]) <= spec.RESOLUTION["rad/s"]
        (alike if same else apart).append(ENGINE_LABELS[engine])
    told = (
        "G2 and G3 were clipped to one effort before and after this step, and differ in KV alone."
    )
    if alike:
        told += f" They move alike in {listed(alike)}: there KV is without effect while clipped."
    if apart:
        told += f" They differ in {listed(apart)}: there KV acts although the effort is clipped."
    return told


def clipped_until_first(trace: Trace, entry: int) -> bool:
    """Return whether a joint's effort is clipped at the start and at the first sample."""
    efforts = np.array([trace.start_control_force[entry], trace.control_force[0, entry]])
    return bool((np.abs(efforts) >= SATURATION_THRESHOLD * trace.effort_limit[entry]).all())


def relation_rows(run: Studies) -> list[dict[str, Any]]:
    """Return for each ordering that the lesson claims what each engine's runs say about it."""
    rows = []
    for pair, metric, order, margin in spec.RELATIONS:
        row: dict[str, Any] = {"claim": f"{NOUNS[metric]}: {pair[1]} {order} than {pair[0]}"}
        for engine in ENGINES:
            state, _ = relation_outcome(run, engine, (pair, metric, order, margin))
            found = run.compared(engine)
            unit = next(u for name, _, u in found[pair[0]].items() if name == metric)
            values = [format_value(getattr(found[case], metric), unit) for case in pair]
            row[ENGINE_LABELS[engine]] = f"{state}: {values[0]} → {values[1]}"
        rows.append(row)
    return rows


def survival_sentence(run: Studies) -> str:
    """Say which of the claimed orderings every engine shows."""
    failed = []
    for relation in spec.RELATIONS:
        pair, metric, order, _ = relation
        states = {engine: relation_outcome(run, engine, relation)[0] for engine in ENGINES}
        not_held = [f"{ENGINE_LABELS[e]}: {s}" for e, s in states.items() if s != HELD]
        if not_held:
            claim = f"{NOUNS[metric]} {order} in {pair[1]} than in {pair[0]}"
            failed.append(f"{claim} ({'; '.join(not_held)})")
    count = len(spec.RELATIONS)
    if not failed:
        return (
            f"All {count} orderings that this lesson claims hold in every column. The numbers "
            "behind them do not: quote an order, and quote a number only together with engine, "
            "integrator and solver step."
        )
    return (
        f"Of the {count} orderings that this lesson claims, {count - len(failed)} hold in every "
        f"column. These do not survive the change of engine or integrator: {', '.join(failed)}."
    )


def explicit_rows(
    names: Sequence[str], ratio: FloatArray, traces: Mapping[str, Trace]
) -> list[dict[str, Any]]:
    """Return for each joint what explicit damping would do, and how often its effort was clipped.

    Args:
        names: of the joints.
        ratio: solver step · (KV + damping) / inertia of each joint (d,).
        traces: by integrator, runs of one case.
    """
    rows: list[dict[str, Any]] = []
    for k, name in enumerate(names):
        row: dict[str, Any] = {"joint": name, "h (KV + d) / I": f"{ratio[k]:.2f}"}
        for integrator, trace in traces.items():
            count = int(clipped(trace)[:, k].sum())
            row[f"clipped, {integrator}"] = format_value(count, "1")
        rows.append(row)
    return rows


def clipped(trace: Trace) -> np.ndarray:
    """Return whether each sample's effort (n, d) reaches the saturation threshold."""
    return np.abs(trace.control_force) >= SATURATION_THRESHOLD * trace.effort_limit


def explicit_sentence(names: Sequence[str], ratio: FloatArray, traces: Mapping[str, Trace]) -> str:
    """Say for which joints explicit damping overshoots, and which of them really chatter.

    Arguments as in `explicit_rows`.
    """
    over = [name for name, value in zip(names, ratio, strict=True) if value > 2]
    lead = (
        f"h (KV + d) / I is above two for {listed(over)}"
        if over
        else ("h (KV + d) / I is above two for no joint")
    )
    told = []
    for integrator, trace in traces.items():
        often = clipped(trace).mean(axis=0) > 0.5
        busy = [name for name, flag in zip(names, often, strict=True) if flag]
        told.append(f"with {integrator} {listed(busy) if busy else 'no joint'}")
    return f"{lead}. Clipped in more than half of all samples: {', '.join(told)}."
