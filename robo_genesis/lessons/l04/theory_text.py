"""Theory compared with the measurement of L04: tables and sentences."""

from typing import Any

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import bullets, format_value
from robo_genesis.lessons.l04 import spec, study, study_spec
from robo_genesis.lessons.l04.theory import IdealJoint, Parting, overshoot_share, parting
from robo_genesis.sim.arm.joint_control import differences

MEASURES = False


def share_text(share: float) -> str:
    """Write a share for a reader: `12.3 %`."""
    return f"{100 * share:.1f} %"


def damping_word(zeta: float) -> str:
    """Name the regime of a damping ratio."""
    if abs(zeta - 1) < 5e-3:
        return "critically damped"
    return "underdamped" if zeta < 1 else "overdamped"


def mass_table(run: Experiment) -> str:
    """Return the inertia of the stepped joint, and the masses with a commanded position."""
    head, unit = f"`get_mass_mat`, {spec.STEPPED_JOINT}", "kg·m²"
    readings = run.readings[study.GROUP]
    rows = [{head: "without effort, less h · d", unit: readings["inertia_Genesis"]}]
    for kv in study.COMPARED_KV:
        term = f"that, less h (d + KV) = {study.implicit_term(run, kv):g}"
        mass = readings[f"mass_KV_{kv:g}"]
        rows.append({head: f"position commanded, KV = {kv:g}", unit: mass})
        rows.append({head: term, unit: study.without_term(run, kv)})
    return tables.markdown(rows)


def ideal_table(run: Experiment) -> str:
    """Return the linear joint's parameters and overshoot for each compared case."""
    return tables.markdown(ideal_rows(run))


def parting_conclusions(run: Experiment) -> str:
    """Say for each compared case where measurement and ideal joint part."""
    return bullets(parting_sentences(run))


def step_cases(run: Experiment) -> str:
    """Return what each case of another step changes, and its largest control force."""
    rows = []
    for name, case in study_spec.STEP_CASES.items():
        compared = name.split("_")[0]
        entries = differences(study_spec.COMPARED[compared], case, run.joints)
        efforts = run.traces[name].control_force[:, spec.ENTRY]
        rows.append(
            {
                "case": f"{compared} → {name}",
                "changes": ", ".join(entries),
                "peak control": f"{float(abs(efforts).max()):.1f} N·m",
            }
        )
    return tables.markdown(rows)


def step_size_table(run: Experiment) -> str:
    """Return overshoot and distance from theory at both heights of the step."""
    return tables.markdown(step_size_rows(run))


def step_size_conclusions(run: Experiment) -> str:
    """Compare the overshoots of theory, small step and large step."""
    return bullets(step_size_sentences(run))


def ideal_rows(run: Experiment) -> list[dict[str, Any]]:
    """Return the linear joint's parameters and overshoot for each compared case."""
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
        for ideal in [study.ideal(run, case)]
    ]


def part(run: Experiment, case: str) -> Parting:
    """Find where a compared case's position leaves the ideal joint's, which has no gravity."""
    trace = run.traces[case]
    q = trace.q[:, spec.ENTRY].astype(float)
    step = float(study_spec.COMPARED[case].q_target[spec.ENTRY]) - q[0]
    ideal = q[0] + step * study.ideal(run, case).response(trace.t)
    return parting(trace, q, ideal, spec.ENTRY, study_spec.PARTING_THRESHOLD)


def parting_sentence(case: str, ideal: IdealJoint, found: Parting) -> str:
    """Say where measurement and ideal joint part, and whether the effort was clipped before.

    Args:
        case: its name.
        ideal: the linear joint with its gains.
        found: from `theory.parting`, with the lesson's threshold.
    """
    within = f"{study_spec.PARTING_THRESHOLD:g} rad"
    lead = f"{case} (ζ = {ideal.zeta:.2f}, {damping_word(ideal.zeta)})"
    largest = f"The largest distance in this window is {format_value(found.distance, 'rad')}."
    if found.time is None:
        return f"{lead} stays within {within} of the ideal joint. {largest}"
    lead = (
        f"{lead} first differs from the ideal joint by more than {within} at "
        f"{format_value(found.time, 's')}. {largest}"
    )
    if found.clipped == 0:
        return (
            f"{lead} None of the {found.efforts} efforts before that was clipped, so saturation is "
            "not the reason. Look at gravity, coupling and the solver's step."
        )
    clipped = (
        "The first effort, at t = 0, was clipped."
        if found.efforts == 1
        else f"Before that, {found.clipped} of {found.efforts} efforts were clipped."
    )
    return (
        f"{lead} {clipped} The joint "
        "got less effort than the formula assumes, and a higher gain could not change that."
    )


def parting_sentences(run: Experiment) -> list[str]:
    """Return one sentence for each compared case."""
    return [parting_sentence(c, study.ideal(run, c), part(run, c)) for c in study_spec.COMPARED]


def step_size_rows(run: Experiment) -> list[dict[str, Any]]:
    """Return for each case with a small step: overshoot and distance from theory at both sizes."""
    rows = []
    for case in study_spec.SMALL_STEPPED:
        ideal = study.ideal(run, case)
        response = ideal.response(run.traces[case].t)
        row: dict[str, Any] = {"case": case, "overshoot, ideal": share_text(ideal.overshoot)}
        for height, kind in ((study_spec.SMALL_STEP, "small"), (spec.STEP, "")):
            share = study.share(run, case, kind)
            row[f"overshoot, +{height:g} rad"] = share_text(overshoot_share(share))
            distance = float(abs(share - response).max())
            row[f"largest distance, +{height:g} rad"] = share_text(distance)
        rows.append(row)
    return rows


def step_size_sentence(case: str, ideal: float, small: float, large: float) -> str:
    """Compare the overshoots [share of the step] of theory, a small step and the lesson's step."""
    tolerance = study_spec.SMALL_STEP_TOLERANCE
    declared = f"{100 * tolerance:g} percentage points"
    lead = (
        f"{case}: the ideal joint overshoots by {share_text(ideal)} of its step, the small step by "
        f"{share_text(small)}, the large step by {share_text(large)}."
    )
    if abs(small - ideal) > tolerance:
        return f"{lead} Even the small step differs from the ideal one by more than {declared}."
    times = f"{small / ideal:.1f} times the ideal overshoot" if ideal else "not zero"
    lead += f" The small step agrees within {declared}, but it is {times}."
    if abs(large - ideal) <= tolerance:
        return (
            f"{lead} The overshoot of the large step agrees as well, but one number can agree by "
            "accident: see how far its curve is from the ideal one."
        )
    return f"{lead} The large step does not agree."


def step_size_sentences(run: Experiment) -> list[str]:
    """Return one sentence for each case with a small step."""
    return [
        step_size_sentence(
            case,
            study.ideal(run, case).overshoot,
            overshoot_share(study.share(run, case, "small")),
            overshoot_share(study.share(run, case)),
        )
        for case in study_spec.SMALL_STEPPED
    ]


def stepped_table(run: Experiment) -> str:
    """Return the overshoots of the ideal joint, of the stepped model and of the engine."""
    rows = []
    for height in (study_spec.SMALL_STEP, spec.STEP):
        small = height == study_spec.SMALL_STEP
        for case in study_spec.SMALL_STEPPED if small else study_spec.COMPARED:
            model = study.stepped_overshoot(run, case, height)
            ideal = study.ideal(run, case).overshoot
            measured = overshoot_share(study.share(run, case, "small")) if small else None
            rad = run.metrics[case].overshoot
            rows.append(
                {
                    "run": f"{case}, +{height:g} rad",
                    "ideal joint": share_text(ideal)
                    if small
                    else format_value(ideal * height, "rad"),
                    "stepped model": share_text(model / height)
                    if small
                    else format_value(model, "rad"),
                    "Genesis": share_text(measured)
                    if measured is not None
                    else format_value(rad, "rad"),
                }
            )
    return tables.markdown(rows)


def stepped_sentences(run: Experiment) -> str:
    """Say for each small step which model is nearer, and which large steps overshoot."""
    small = (_stepped_sentence(run, case) for case in study_spec.SMALL_STEPPED)
    return bullets((*small, *(_large_sentence(run, case) for case in study_spec.COMPARED)))


def _large_sentence(run: Experiment, case: str) -> str:
    model, found = study.stepped_overshoot(run, case, spec.STEP), run.metrics[case].overshoot
    values = [format_value(value, "rad") for value in (model, found)]
    words = f"{case}, large step: the model overshoots by {values[0]}, Genesis by {values[1]}."
    if (model > spec.MARGINS["overshoot"]) == (found > spec.MARGINS["overshoot"]):
        return f"{words} The model predicts correctly whether this case overshoots."
    return f"{words} The model does not predict correctly whether this case overshoots."


def _stepped_sentence(run: Experiment, case: str) -> str:
    model = study.stepped_overshoot(run, case, study_spec.SMALL_STEP) / study_spec.SMALL_STEP
    ideal, small = (
        study.ideal(run, case).overshoot,
        overshoot_share(study.share(run, case, "small")),
    )
    words = (
        f"{case}, small step: the stepped model is {100 * abs(model - small):.1f} percentage "
        f"points from the engine, the ideal joint {100 * abs(ideal - small):.1f}."
    )
    if abs(model - small) < abs(ideal - small):
        return f"{words} The stepped model is nearer."
    return f"{words} The stepped model is not nearer. It leaves out the other joints."
