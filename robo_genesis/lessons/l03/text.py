"""Sentences about landings, slides and bounces, chosen and filled by their own numbers."""

from collections.abc import Mapping, Sequence

import numpy as np

from robo_genesis.core.text import Block, listed, signed
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import friction as sliding
from robo_genesis.lessons.l03 import spec
from robo_genesis.lessons.l03.checks import ContactExperiment
from robo_genesis.lessons.l03.energy import kept_at_bounces
from robo_genesis.lessons.l03.metrics import (
    CLEAR,
    RESTING_BAND,
    BounceMetrics,
    LandingMetrics,
    SlideMetrics,
)
from robo_genesis.sim.contacts import ContactCase

LOOK = (
    "Look first at the cases' settings, the time stamps, and whether the body was touched at all."
)


def interpretation(run: ContactExperiment) -> tuple[Block, ...]:
    """Return what the lab's runs show, whatever it is."""
    landings, slides, bounces = run.landings(), run.slides(), run.bounces()
    landed = (landing_sentence(name, found) for name, found in landings.items())
    slid = (slide_sentence(name, found, run.cases[name]) for name, found in slides.items())
    bounced = (bounce_sentence(found, run.cases[name]) for name, found in bounces.items())
    return (
        Block("The landings", tuple(landed)),
        Block("What the step decides", step_sentences(landings, run.traces)),
        Block("The slides", tuple(slid)),
        Block("Whose friction counts", friction_sentences(slides, run.cases)),
        Block("The energy of the ball", (*bounced, *energy_sentences(bounces, run.cases))),
    )


def landing_sentence(name: str, found: LandingMetrics) -> str:
    """Say how deep a dropped cube sank in, whether it left again, and when it lay still."""
    if found.touchdown is None:
        return f"`{name}` did not reach the surface within the window."
    told = (
        f"`{name}` is below the surface for the first time at the sample of {found.touchdown:.2f} "
        f"s, and by {mm(found.penetration)} at its deepest one"
    )
    if found.rebound > CLEAR:
        told += f"; it rebounds by {mm(found.rebound)}, for {1000 * found.separated:.0f} ms"
    else:
        told += "; it does not rebound"
    if found.resting_time is None:
        return f"{told}. At the end it still is {mm(abs(found.resting_offset))} off its place."
    way = "too low" if found.resting_offset < 0 else "too high"
    return (
        f"{told}. From {found.resting_time:.2f} s on it stays within "
        f"{1000 * RESTING_BAND:g} mm of its place, at the end "
        f"{1e6 * abs(found.resting_offset):.0f} µm {way}."
    )


def step_sentences(
    landings: Mapping[str, LandingMetrics], traces: Mapping[str, ContactTrace]
) -> tuple[str, ...]:
    """Say what more substeps did at one outer step, and what equal solver steps have in common."""
    told = []
    for coarse, fine in spec.FINER:
        a, b = landings[coarse].penetration, landings[fine].penetration
        verb = "less" if b < a else "no less"
        told.append(
            f"`{fine}` sinks in {verb} than `{coarse}`, which has fewer substeps: {mm(b)} against "
            f"{mm(a)}."
        )
    short, long = (traces[name].link_pos for name in spec.EQUAL_STEP)
    every = round(traces[spec.EQUAL_STEP[1]].dt / traces[spec.EQUAL_STEP[0]].dt)
    far = float(np.abs(short[::every] - long).max())
    names = listed([f"`{name}`" for name in spec.EQUAL_STEP])
    shared = "at the times that they share"
    why = "they have equal solver steps, and their outer steps only say how often one looks"
    if far == 0:
        told.append(f"{names} have the same positions {shared}, to the last bit: {why}.")
    elif far <= spec.SAME_STATE:
        told.append(f"{names} are {1e6 * far:.2g} µm apart {shared}, which is float32: {why}.")
    else:
        told.append(f"{names} are up to {mm(far)} apart {shared}. {LOOK}")
    leaving = [name for name, of in landings.items() if of.rebound > CLEAR]
    if not leaving:
        told.append("None of the cubes rebounds.")
    else:
        which = listed([f"`{name}`" for name in leaving])
        told.append(
            f"{which} {'rebounds' if len(leaving) == 1 else 'rebound'}. Whether that is physics or "
            "the method, these runs cannot tell: the lecture takes smaller steps and other heights."
        )
    return tuple(told)


def slide_sentence(name: str, found: SlideMetrics, case: ContactCase) -> str:
    """Say where a pushed cube stopped, beside Coulomb's distance, and what it did on the way."""
    friction = max(case.friction, case.surface_friction)
    expected = sliding.coulomb_distance(case.speed, friction, case.gravity)
    if found.stop_distance is None or found.stop_time is None:
        told = f"`{name}` did not stop in the window; it travelled {found.final_distance:.4f} m"
    else:
        apart = 100 * (found.stop_distance / expected - 1)
        seconds = sliding.coulomb_time(case.speed, friction, case.gravity)
        told = (
            f"`{name}` stops after {found.stop_time:.2f} s and {found.stop_distance:.4f} m. With "
            f"μ = {friction:g}, v / (μ g) is {seconds:.2f} s and v² / (2 μ g) {expected:.4f} m: "
            f"it stops {signed(apart, 1)} % from there"
        )
    if found.hop > CLEAR:
        return (
            f"{told}. On the way it was up to {mm(found.hop)} above the surface, in the air for "
            f"{found.airborne:.2f} s, and turned at up to {found.spin:.1f} rad/s: it did not slide "
            "as the formula assumes."
        )
    return f"{told}. It stayed on the surface."


def friction_sentences(
    slides: Mapping[str, SlideMetrics], cases: Mapping[str, ContactCase]
) -> tuple[str, ...]:
    """Say which coefficient each distance shows, and what the other surface changed."""
    told = []
    for name, found in slides.items():
        case = cases[name]
        if found.stop_distance is None:
            continue
        apparent = sliding.apparent_friction(case.speed, found.stop_distance, case.gravity)
        larger = max(case.friction, case.surface_friction)
        told.append(
            f"`{name}`: {case.friction:g} on {case.surface_friction:g}. By its distance it stopped "
            f"as with {apparent:.3f}; the larger of the two is {larger:g}."
        )
    for lane in ("low", "high"):
        one, other = (slides[f"{lane}_on_{of}"].stop_distance for of in ("050", "030"))
        if one is None or other is None:
            told.append(f"Of the cubes with {lane} friction one did not stop.")
            continue
        if abs(other - one) <= spec.SAME_SLIDE:
            how = f"changes nothing to speak of ({1e6 * abs(other - one):.2g} µm)"
        else:
            way = "farther" if other > one else "less far"
            how = f"means that it travels {100 * abs(other - one):.1f} cm {way}"
        told.append(f"For the cube with {lane} friction, the other surface {how}.")
    return tuple(told)


def bounce_sentence(found: BounceMetrics, case: ContactCase) -> str:
    """Say what a ball kept at its first bounce."""
    h = f"With a solver step of {1000 * case.h:g} ms the ball"
    if found.first_kept is None:
        return f"{h} does not bounce within the window."
    kept = f"keeps {found.first_kept:.1f} % of its energy at the first bounce"
    if found.first_kept > 100:
        kept = (
            f"has {found.first_kept:.1f} % of its energy after the first bounce, more than before"
        )
    return f"{h} {kept}."


def energy_sentences(
    bounces: Mapping[str, BounceMetrics], cases: Mapping[str, ContactCase]
) -> tuple[str, ...]:
    """Say what is the contact's own loss, what the method's error, and what steps only lend."""
    order = sorted(bounces, key=lambda name: cases[name].h)
    finest = bounces[order[0]]
    case = cases[order[0]]
    expected = 100 * kept_at_bounces(case.spring[1] if case.spring else 1.0)
    told = []
    if finest.first_kept is not None:
        off = abs(finest.first_kept - expected)
        told.append(
            f"The finest step leaves {finest.first_kept:.2f} %; a linear spring of this damping "
            f"leaves {expected:.2f} %. "
            + (
                "So what is missing to 100 % is the contact's own damping."
                if off <= spec.FINE_SHARE
                else f"The {off:.2f} % between them are not explained by the damping. {LOOK}"
            )
        )
    flown = [of for of in bounces.values() if of.lent is not None and of.flight_drift is not None]
    if flown:
        lent = [1000 * float(of.lent or 0) for of in flown]
        drift = max(float(of.flight_drift or 0) / of.start_energy for of in flown)
        told.append(
            f"Within a flight the total energy changes by up to {max(lent):.1f} mJ at one step and "
            f"by {min(lent):.2f} mJ at another, and comes back with the velocity: less m g h v / 2 "
            f"it changes by no more than {1e6 * drift:.1f} millionths of the start."
        )
    return tuple(told)


def landing_rows(cases: Mapping[str, ContactCase]) -> Sequence[Mapping[str, str]]:
    """Return one row a case: what was chosen, and how many states and solver steps follow."""
    return [
        {
            "case": f"`{name}`",
            "dt [ms]": f"{1000 * case.dt:g}",
            "substeps": str(case.substeps),
            "h [ms]": f"{1000 * case.h:g}",
            "states": str(case.steps + 1),
            "solver steps": str(case.steps * case.substeps),
        }
        for name, case in cases.items()
    ]


def step_study(found: Mapping[float, Sequence[LandingMetrics]]) -> tuple[str, ...]:
    """Say what becomes of depth and rebound as the solver's step gets smaller.

    Args:
        found: by solver step [s], the metrics of landings from several heights.
    """
    told = []
    for h in (max(found), min(found)):
        depths = [of.penetration for of in found[h]]
        told.append(
            f"With a solver step of {1000 * h:g} ms the cubes sink in by {mm(min(depths))} to "
            f"{mm(max(depths))}."
        )
    leaving = sorted(h for h, of in found.items() if any(one.rebound > CLEAR for one in of))
    if not leaving:
        return (*told, "At no step does any of them rebound.")
    steps = listed([f"{1000 * h:g} ms" for h in leaving])
    if min(leaving) > min(found):
        told.append(
            f"Cubes rebound at {steps}, and none at a smaller step: the rebound belongs to coarse "
            "steps, not to the cube."
        )
    else:
        told.append(f"Cubes rebound at {steps}, the smallest step among them.")
    return tuple(told)


def mm(value: float) -> str:
    """Write a length in millimetres [m]."""
    return f"{1000 * value:.2f} mm"
