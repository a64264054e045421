"""Sentences of the lecture and the deeper pages, chosen and filled by the metrics."""

from collections.abc import Iterator

import numpy as np

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import bullets, listed
from robo_genesis.lessons.l03 import friction, study, study_contact, study_spec, theory
from robo_genesis.lessons.l03.metrics import CLEAR
from robo_genesis.lessons.l03.study import slide
from robo_genesis.lessons.l03.study_tables import metres, millimetres, milliseconds, span

MEASURES = False


def step_conclusions(run: Experiment) -> str:
    """Say how depth and rebound depend on the solver step, as a share of the time constant."""
    return bullets(step_sentences(run))


def step_sentences(run: Experiment) -> Iterator[str]:
    """Yield one sentence about the coarse steps, the fine steps and the rebounds."""
    names = sorted(study_spec.STEP_CASES, key=study.share_of_step)
    coarse = [name for name in names if study.share_of_step(name) >= 0.5]
    shares = [share for name in coarse for share in study.depth_shares(run.metrics, name)]
    yield f"At h / T = 0.5 the depth is {span(shares)} times v T / e."
    for name in (of for of in reversed(names) if of not in coarse):
        ratio = study.share_of_step(name)
        if name == names[0] or any(abs(ratio - of) < 1e-9 for of in study_spec.ADVISED):
            found = span(study.depth_shares(run.metrics, name))
            yield f"At h / T = {ratio:.3g} it is {found} times v T / e."
    rebounding = [
        name
        for name in names
        if any(of.rebound > CLEAR for of in study.landings_of(run.metrics, name))
    ]
    if not rebounding:
        yield "No cube rebounds at any of these steps."
        return
    steps = listed([milliseconds(study.case_of(name).h) for name in rebounding])
    if rebounding[0] == names[0]:
        yield f"Cubes rebound at {steps}, the smallest step included."
    else:
        yield f"Cubes rebound at {steps} and at no smaller step."


def depth_conclusion(run: Experiment) -> str:
    """Compare depth by hand and measured at the finest step."""
    finest = min(study_spec.STEP_CASES, key=study.share_of_step)
    shares = study.depth_shares(run.metrics, finest)
    largest = 100 * max(abs(share - 1) for share in shares)
    return (
        f"At T = 10 ms and the finest step, all {len(shares)} depths are within {largest:.0f} % of "
        "v T / e."
    )


def friction_conclusion(run: Experiment) -> str:
    """Say which cube the other table changed."""
    sentences = []
    for lane in ("low", "high"):
        names = [f"{lane}_on_{of}_elliptic" for of in ("050", "030")]
        case = run.cases[names[0]]
        one, other = (slide(run.metrics, name).stop_distance for name in names)
        if one is None or other is None:
            sentences.append(f"A cube with {case.friction:g} did not stop in the window.")
            continue
        effect = (
            f"travels {100 * (other - one):.0f} cm farther"
            if other - one > 1e-3
            else f"stops at the same place, to {1e6 * abs(other - one):.2g} µm"
        )
        sentences.append(f"On the other table the cube with {case.friction:g} {effect}.")
    return bullets(sentences)


def hop_conclusions(run: Experiment) -> str:
    """Say how the hop depends on step and speed."""
    found = {
        lane: [slide(run.metrics, f"{step}_{lane}").hop for step in study_spec.HOP_STEP_CASES]
        for lane in ("low", "high")
    }
    slow = [
        slide(run.metrics, name).hop
        for name, case in study_spec.HOP_SPEED_CASES.items()
        if case.speed <= study_spec.SLOW
    ]
    fine = [step for step in study_spec.HOP_STEPS if step not in study_spec.HOP_APPLIES]
    cases = [(f"{step}_{lane}", study_spec.HOP_STEP_CASES[step]) for step in fine for lane in found]
    left = [slide(run.metrics, name).hop for name, _ in cases]
    ratios = [hop / theory.hop(of[name]) for hop, (name, of) in zip(left, cases, strict=True)]
    sentences = [
        f"At 2 m/s and solver steps of 10 ms and 5 ms the cubes hop by {millimetres(min(of))} to "
        f"{millimetres(max(of))}: the step is T / 2 in both."
        for of in [[*found["low"][:2], *found["high"][:2]]]
    ]
    sentences.append(
        f"At 1 ms and below, hops of {millimetres(min(left))} to {millimetres(max(left))} are "
        f"left, {min(ratios):.2g} to {max(ratios):.2g} times the formula."
    )
    sentences.append(
        f"At {study_spec.SLOW:g} m/s or less, with a step of 5 ms, the highest hop is "
        f"{millimetres(max(slow))}."
    )
    return bullets(sentences)


def stop_conclusions(run: Experiment) -> str:
    """Say whether the stopping distances of both cubes converge with the step."""
    sentences, unsettled = [], False
    for lane in ("low", "high"):
        found = study_contact.stops_of_lane(run, lane)
        case = run.cases[study_contact.LANES[lane]]
        mu = friction.pair_friction(case)
        formula = friction.coulomb_distance(case.speed, mu, case.gravity)
        fine = [of for of in list(found.values())[-study_spec.FINEST :] if of is not None]
        if len(fine) < 2:
            sentences.append(f"With μ = {mu:g} too few runs stop in the window.")
            continue
        spread = 100 * float(np.ptp(fine)) / formula
        near = sum(abs(of - formula) <= study_spec.CLOSE * formula for of in fine)
        varies = spread > 100 * study_spec.UNSETTLED
        unsettled |= varies
        verdict = "does not converge" if varies else "varies little"
        sentences.append(
            f"With μ = {mu:g} the {len(fine)} steps of at most T / 10 give {metres(min(fine))} to "
            f"{metres(max(fine))}, a spread of {spread:.2g} % of v² / (2 μ g) = {metres(formula)}: "
            f"the distance {verdict} over these steps. {near} of them are within "
            f"{100 * study_spec.CLOSE:g} % of the formula."
        )
    if unsettled:
        sentences.append(
            "Some neighbouring steps agree, and the next one gives another distance. Two steps "
            "alone could look like convergence."
        )
    return bullets(sentences)


def release_conclusions(run: Experiment) -> str:
    """Compare release and rebound with the linear contact."""
    sentences = []
    for scene, cases in study_spec.RELEASE_CASES.items():
        found = study.landings_of(run.metrics, scene)
        rebounds = [of.rebound for of in found]
        t = milliseconds(theory.contact_seconds(study.case_of(scene)))
        if max(rebounds) <= CLEAR:
            sentences.append(f"With T = {t} none of the {len(cases)} cubes rebounds.")
        else:
            heights = f"{millimetres(min(rebounds))} to {millimetres(max(rebounds))}"
            sentences.append(f"With T = {t} the cubes rebound by {heights}.")
    return bullets(sentences)
