"""Sentences about landings, slides and bounces, chosen and filled by their metrics."""

from collections.abc import Iterator, Mapping

import numpy as np

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import Block, listed, signed
from robo_genesis.core.trace import ContactTrace
from robo_genesis.lessons.l03 import checks, friction, spec
from robo_genesis.lessons.l03.energy import kept_at_bounces
from robo_genesis.lessons.l03.metrics import (
    CLEAR,
    RESTING_BAND,
    BounceMetrics,
    LandingMetrics,
    SlideMetrics,
)
from robo_genesis.sim.bodies.contacts import ContactCase

MEASURES = False

INSPECT = (
    "Check the settings of the cases, the times of the samples, and contacts with the body first."
)


def conclusions(run: Experiment) -> str:
    """Return the sentences about the lab's runs."""
    return "\n".join(block.markdown() for block in interpretation(run))


def interpretation(run: Experiment) -> tuple[Block, ...]:
    """Return the results of the lab's runs, for every outcome."""
    landings, slides, bounces = checks.landings(run), checks.slides(run), checks.bounces(run)
    landed = (landing_sentence(name, found) for name, found in landings.items())
    slid = (slide_sentence(name, found, run.cases[name]) for name, found in slides.items())
    bounced = (bounce_sentence(found, run.cases[name]) for name, found in bounces.items())
    return (
        Block("The landings", tuple(landed)),
        Block("The effect of the step", tuple(step_sentences(landings, run.traces))),
        Block("The slides", tuple(slid)),
        Block("Which friction counts", tuple(friction_sentences(slides, run.cases))),
        Block("The energy of the ball", (*bounced, *energy_sentences(bounces, run.cases))),
    )


def landing_sentence(name: str, found: LandingMetrics) -> str:
    """Say how deep a dropped cube sank in, whether it rebounded, and when it settled."""
    if found.touchdown is None:
        return f"{titled(name)} The cube did not reach the surface within the window."
    landing = (
        f"{titled(name)} The cube first touches the surface at {found.touchdown:.2f} s; depth "
        f"{mm(found.penetration)}. It "
    )
    rebounds = f"rebounds by {mm(found.rebound)}, for {1000 * found.separated:.0f} ms"
    landing += rebounds if found.rebound > CLEAR else "does not rebound"
    if found.resting_time is None:
        return f"{landing}. At the end it is still {mm(abs(found.resting_offset))} off its place."
    side = "too low" if found.resting_offset < 0 else "too high"
    return (
        f"{landing}. From {found.resting_time:.2f} s on it stays within "
        f"{1000 * RESTING_BAND:g} mm of its place; at the end it is "
        f"{1e6 * abs(found.resting_offset):.0f} µm {side}."
    )


def step_sentences(
    landings: Mapping[str, LandingMetrics], traces: Mapping[str, ContactTrace]
) -> Iterator[str]:
    """Say what more substeps changed at one outer step, and compare equal solver steps."""
    for coarse, fine in spec.FINER:
        a, b = landings[coarse].penetration, landings[fine].penetration
        verb = "less deeply than" if b < a else "as deeply as or more deeply than"
        yield (
            f"With {label(fine)} the cube sinks in {verb} with {label(coarse)}: {mm(b)} instead "
            f"of {mm(a)}."
        )
    short, long = (traces[name] for name in spec.EQUAL_STEP)
    difference = np.abs(short.link_pos[:: round(long.dt / short.dt)] - long.link_pos).max()
    names = f"the runs with {listed([label(name) for name in spec.EQUAL_STEP])}"
    why = "Their solver steps are equal; the outer step only sets how often the state is read."
    shared = f"At shared times {names}"
    if difference == 0:
        yield f"{shared} have equal positions, to the last bit. {why}"
    elif difference <= spec.SAME_STATE:
        yield f"{shared} are {1e6 * difference:.2g} µm apart, which is float32 rounding. {why}"
    else:
        yield f"{shared} are up to {mm(difference)} apart. {INSPECT}"
    rebounding = [label(name) for name, of in landings.items() if of.rebound > CLEAR]
    if rebounding:
        yield (
            f"With {listed(rebounding)} the cube rebounds. These runs cannot show whether that is "
            "physics or numerical error: the lecture tests smaller steps and other heights."
        )
    else:
        yield "None of the cubes rebounds."


def slide_sentence(name: str, found: SlideMetrics, case: ContactCase) -> str:
    """Say where a pushed cube stopped, Coulomb's distance, and whether it stayed down."""
    if found.stop_distance is None or found.stop_time is None:
        travelled = f"it travelled {found.final_distance:.4f} m"
        slide = f"{titled(name)} It did not stop in the window; {travelled}"
    else:
        mu = friction.pair_friction(case)
        expected = friction.coulomb_distance(case.speed, mu, case.gravity)
        seconds = friction.coulomb_time(case.speed, mu, case.gravity)
        difference = signed(100 * (found.stop_distance / expected - 1), 1)
        slide = (
            f"{titled(name)} It stops after {found.stop_time:.2f} s and {found.stop_distance:.4f} "
            f"m. With μ = {mu:g}, v / (μ g) is {seconds:.2f} s and v² / (2 μ g) is {expected:.4f} "
            f"m; the distance differs from it by {difference} %"
        )
    if found.hop > CLEAR:
        return (
            f"{slide}. On the way the cube was up to {mm(found.hop)} above the surface, in the air "
            f"for {found.airborne:.2f} s, and turned at up to {found.spin:.1f} rad/s: it did not "
            "slide as the formula assumes."
        )
    return f"{slide}. It stayed on the surface."


def friction_sentences(
    slides: Mapping[str, SlideMetrics], cases: Mapping[str, ContactCase]
) -> Iterator[str]:
    """Say which coefficient each distance shows, and what the other surface changed."""
    for name, found in slides.items():
        if found.stop_distance is not None:
            case = cases[name]
            larger = friction.pair_friction(case)
            apparent = friction.apparent_friction(case.speed, found.stop_distance, case.gravity)
            yield (
                f"{titled(name)} Its distance corresponds to μ = {apparent:.3f}; the larger "
                f"coefficient is {larger:g}."
            )
    for lane in ("low", "high"):
        one, other = (slides[f"{lane}_on_{of}"].stop_distance for of in ("050", "030"))
        own = f"a friction of {cases[f'{lane}_on_050'].friction:g}"
        if one is None or other is None:
            yield f"One of the cubes with {own} did not stop."
            continue
        difference = abs(other - one)
        if difference <= spec.SAME_SLIDE:
            effect = f"changes its distance by {1e6 * difference:.2g} µm, which is negligible"
        else:
            direction = "farther" if other > one else "less far"
            effect = f"lets it travel {100 * difference:.1f} cm {direction}"
        yield f"For the cube with {own}, the other table {effect}."


def bounce_sentence(found: BounceMetrics, case: ContactCase) -> str:
    """Say how much energy a ball kept at its first bounce."""
    ball = f"With a solver step of {1000 * case.h:g} ms the ball"
    if found.first_kept is None:
        return f"{ball} does not bounce within the window."
    if found.first_kept > 100:
        return (
            f"{ball} has {found.first_kept:.1f} % of its energy after the first bounce, more than "
            "before."
        )
    return f"{ball} keeps {found.first_kept:.1f} % of its energy at the first bounce."


def energy_sentences(
    bounces: Mapping[str, BounceMetrics], cases: Mapping[str, ContactCase]
) -> Iterator[str]:
    """Say which change of energy is the contact's loss, numerical error, or a bounded error."""
    name = min(bounces, key=lambda name: cases[name].h)
    case, kept = cases[name], bounces[name].first_kept
    if kept is not None:
        expected = 100 * kept_at_bounces(case.spring[1] if case.spring else 1.0)
        difference = abs(kept - expected)
        cause = "The contact's own damping causes the whole loss."
        if difference > spec.FINE_SHARE:
            cause = f"The damping does not explain the difference of {difference:.2f} %. {INSPECT}"
        yield (
            f"The finest step leaves {kept:.2f} %; a linear spring with this damping leaves "
            f"{expected:.2f} %. {cause}"
        )
    flown = [
        (1000 * of.flight_change, of.flight_drift / of.start_energy)
        for of in bounces.values()
        if of.flight_change is not None and of.flight_drift is not None
    ]
    if flown:
        bounded, drift = zip(*flown, strict=True)
        yield (
            f"Within a flight the total energy changes by up to {max(bounded):.1f} mJ at one step "
            f"and by {min(bounded):.2f} mJ at another. This error is bounded: without m g h v / 2 "
            f"the energy changes by at most {1e6 * max(drift):.1f} millionths of the start."
        )


def label(run: str) -> str:
    """Return a reader's words for a run."""
    return spec.LABELS.get(run, run)


def titled(run: str) -> str:
    """Return these words as the title of a sentence: `**Two steps in 10 ms.**`."""
    words = label(run)
    return f"**{words[0].upper()}{words[1:]}.**"


def mm(value: float) -> str:
    """Write a length in millimetres [m]."""
    return f"{1000 * value:.2f} mm"
