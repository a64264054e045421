"""Theory and gravity beside the measurement of L04: rows and sentences from what was measured."""

from collections.abc import Mapping
from typing import Any

from robo_genesis.core.quantities import format_value
from robo_genesis.core.text import listed
from robo_genesis.lessons.l04 import spec, study_spec
from robo_genesis.lessons.l04.metrics import StepMetrics
from robo_genesis.lessons.l04.study import Studies
from robo_genesis.lessons.l04.text import AT_REST
from robo_genesis.lessons.l04.theory import IdealJoint, Parting, overshoot_share, parting


def share_text(share: float) -> str:
    """Write a share for a reader: `12.3 %`."""
    return f"{100 * share:.1f} %"


def damping_word(zeta: float) -> str:
    """Name the regime of a damping ratio."""
    if abs(zeta - 1) < 5e-3:
        return "critically damped"
    return "underdamped" if zeta < 1 else "overdamped"


def ideal_rows(run: Studies) -> list[dict[str, Any]]:
    """Return for each compared case what the linear joint would do."""
    return [
        {
            "case": case,
            "KP [N·m/rad]": ideal.kp,
            "KV + passive damping [N·m·s/rad]": ideal.damping,
            "ζ": f"{ideal.zeta:.2f}",
            "ideal joint": damping_word(ideal.zeta),
            "ideal overshoot [share of step]": share_text(ideal.overshoot),
        }
        for case in study_spec.COMPARED
        for ideal in [run.ideal(case)]
    ]


def part(run: Studies, case: str) -> Parting:
    """Find where a compared case's position leaves the ideal joint's, gravity left out."""
    trace, configured = run.traces[case], study_spec.COMPARED[case]
    q = trace.q[:, run.entry].astype(float)
    step = float(configured.q_target[run.entry]) - q[0]
    ideal = q[0] + step * run.ideal(case).response(trace.t)
    return parting(trace, q, ideal, run.entry, study_spec.PARTING_THRESHOLD)


def parting_sentence(case: str, ideal: IdealJoint, found: Parting, threshold: float) -> str:
    """Say where measurement and ideal joint part, and whether the effort was clipped until there.

    Args:
        case: its name.
        ideal: the linear joint with its gains.
        found: from `theory.parting`.
        threshold: the distance that counts as parting [rad].
    """
    lead = f"{case} (ζ = {ideal.zeta:.2f}, {damping_word(ideal.zeta)})"
    apart = f"at most {format_value(found.apart, 'rad')} apart"
    if found.time is None:
        return f"{lead} stays within {threshold:g} rad of the ideal joint: {apart} in this window."
    lead = (
        f"{lead} first leaves the ideal joint by more than {threshold:g} rad at "
        f"{format_value(found.time, 's')}, and is {apart} in this window."
    )
    if found.clipped == 0:
        return (
            f"{lead} Clipped efforts up to there: none of {found.efforts}, so saturation is not "
            "the reason. Look at gravity, coupling and the solver's step."
        )
    return (
        f"{lead} Clipped efforts up to there: {found.clipped} of {found.efforts}. The joint got "
        "less than the formula assumes, and a higher gain could not change that."
    )


def parting_sentences(run: Studies) -> list[str]:
    """Return one sentence for each compared case."""
    threshold = study_spec.PARTING_THRESHOLD
    return [
        parting_sentence(case, run.ideal(case), part(run, case), threshold)
        for case in study_spec.COMPARED
    ]


def step_size_rows(run: Studies) -> list[dict[str, Any]]:
    """Return for each case with a small step: overshoot and distance from theory at both sizes."""
    rows = []
    for case in study_spec.SMALL_STEPPED:
        ideal = run.ideal(case)
        response = ideal.response(run.traces[case].t)
        row: dict[str, Any] = {"case": case, "overshoot, ideal": share_text(ideal.overshoot)}
        for height, kind in ((study_spec.SMALL_STEP, "small"), (spec.STEP, "")):
            share = run.share(case, kind)
            row[f"overshoot, +{height:g} rad"] = share_text(overshoot_share(share))
            distance = float(abs(share - response).max())
            row[f"largest distance, +{height:g} rad"] = share_text(distance)
        rows.append(row)
    return rows


def step_size_sentence(
    case: str, ideal: float, small: float, large: float, tolerance: float
) -> str:
    """Say how far theory's overshoot is from that of a small and of a large step.

    Args:
        case: its name.
        ideal: overshoot of the linear joint, as a share of the step.
        small: overshoot of the small step, likewise.
        large: overshoot of the lesson's step, likewise.
        tolerance: what theory and the small step may differ by, declared beforehand.
    """
    off, far = abs(small - ideal), abs(large - ideal)
    told = (
        f"{case}: the ideal joint overshoots by {share_text(ideal)} of its step, the small step by "
        f"{share_text(small)}, the large one by {share_text(large)}."
    )
    if off > tolerance:
        return (
            f"{told} Even the small step is off by more than the declared {share_text(tolerance)} "
            "of the step."
        )
    told += f" For the small step that is within the declared {share_text(tolerance)} of the step."
    if far <= tolerance:
        return (
            f"{told} So is the large step's, but one number can agree by accident: see how far its "
            "curve lies from the ideal one."
        )
    return f"{told} The large step's is not."


def step_size_sentences(run: Studies) -> list[str]:
    """Return one sentence for each case with a small step."""
    return [
        step_size_sentence(
            case,
            run.ideal(case).overshoot,
            overshoot_share(run.share(case, "small")),
            overshoot_share(run.share(case)),
            study_spec.SMALL_STEP_TOLERANCE,
        )
        for case in study_spec.SMALL_STEPPED
    ]


def gravity_rows(
    kp: Mapping[str, float], metrics: Mapping[str, StepMetrics], gravity: Mapping[str, float]
) -> list[dict[str, Any]]:
    """Return for each case its support at the last sample beside gravity, and how it ended.

    Args:
        kp: by case [N·m/rad].
        metrics: by case.
        gravity: by case, the effort that holds its final posture [N·m].
    """
    return [
        {
            "case": name,
            "KP × final error": format_value(kp[name] * m.final_error, "N·m"),
            "gravity, engine": format_value(effort, "N·m"),
            "apart": share_text(abs(kp[name] * m.final_error - effort) / abs(effort)),
            "final velocity": format_value(m.final_velocity, "rad/s"),
            "settled from": format_value(m.settling_time, "s"),
        }
        for name, effort in gravity.items()
        for m in [metrics[name]]
    ]


def gravity_sentences(
    kp: Mapping[str, float], metrics: Mapping[str, StepMetrics], gravity: Mapping[str, float]
) -> list[str]:
    """Say what the table of `gravity_rows` supports, and what it does not prove."""
    agree: list[str] = []
    differ: list[str] = []
    moving: list[str] = []
    for name, effort in gravity.items():
        m = metrics[name]
        if abs(m.final_velocity) > AT_REST:
            moving.append(name)
            continue
        share = abs(kp[name] * m.final_error - effort) / abs(effort)
        (agree if share <= study_spec.GRAVITY_AGREEMENT else differ).append(name)
    within = share_text(study_spec.GRAVITY_AGREEMENT)
    told = []
    if agree:
        told.append(
            f"Nearly at rest, with a support within {within} of gravity: {listed(agree)}. That is "
            "what a balance of the two would look like, without an integral term in the controller."
        )
    if differ:
        told.append(
            f"Nearly at rest, with a support more than {within} off gravity: {listed(differ)}. So "
            "gravity alone does not explain the error. Look at tail, saturation, "
            "contacts."
        )
    if moving:
        told.append(
            f"Still moving at the last sample: {listed(moving)}. The error there is a moment of "
            "the transient and supports nothing about gravity."
        )
    if agree or differ:
        told.append(
            "Not proved: that the error would stay beyond this window, that nothing else "
            "contributes to it within the tolerance, or that another pose would leave the same one."
        )
    return told
