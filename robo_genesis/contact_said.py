"""Sentences about landings, slides and bounces, chosen and filled by their own numbers."""

from collections.abc import Mapping, Sequence

import numpy as np

from robo_genesis import l03, sliding
from robo_genesis.channels import listed
from robo_genesis.contact_checks import ContactExperiment
from robo_genesis.contact_metrics import CLEAR, BounceMetrics, LandingMetrics, SlideMetrics
from robo_genesis.contacts import ContactCase
from robo_genesis.energy import kept_at_bounces
from robo_genesis.interpretation import Block
from robo_genesis.trace import ContactTrace

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
        told += (
            f"; it leaves the surface again by {mm(found.rebound)}, for "
            f"{1000 * found.separated:.0f} ms"
        )
    else:
        told += "; it does not leave the surface again"
    if found.resting_time is None:
        return f"{told}. At the end it still is {mm(abs(found.resting_offset))} off its place."
    way = "too low" if found.resting_offset < 0 else "too high"
    return (
        f"{told}. From {found.resting_time:.2f} s on it lies still, at the end "
        f"{1e6 * abs(found.resting_offset):.0f} µm {way}."
    )


def step_sentences(
    landings: Mapping[str, LandingMetrics], traces: Mapping[str, ContactTrace]
) -> tuple[str, ...]:
    """Say what more substeps did at one outer step, and what equal solver steps have in common."""
    told = []
    for coarse, fine in l03.FINER:
        a, b = landings[coarse].penetration, landings[fine].penetration
        verb = "less" if b < a else "no less"
        told.append(
            f"`{fine}` sinks in {verb} than `{coarse}`, which has fewer substeps: {mm(b)} against "
            f"{mm(a)}."
        )
    short, long = (traces[name].link_pos for name in l03.EQUAL_STEP)
    every = round(traces[l03.EQUAL_STEP[1]].dt / traces[l03.EQUAL_STEP[0]].dt)
    far = float(np.abs(short[::every] - long).max())
    names = listed([f"`{name}`" for name in l03.EQUAL_STEP])
    if far == 0:
        same = "have the same states at the times that they share, to the last bit"
    elif far <= l03.SAME_STATE:
        same = f"are {1e6 * far:.2g} µm apart at the times that they share, which is float32"
    else:
        same = f"are up to {mm(far)} apart at the times that they share. {LOOK} They"
    told.append(
        f"{names} {same}: they have equal solver steps, and their outer steps only say how often "
        "one looks."
    )
    leaving = [name for name, of in landings.items() if of.rebound > CLEAR]
    if not leaving:
        told.append("None of the cubes leaves the surface again.")
    else:
        told.append(
            f"Only {listed([f'`{name}`' for name in leaving])} "
            f"{'leaves' if len(leaving) == 1 else 'leave'} the surface again. Whether that is "
            "physics or the method, four runs cannot tell: the lecture takes smaller steps."
        )
    return tuple(told)


def slide_sentence(name: str, found: SlideMetrics, case: ContactCase) -> str:
    """Say where a pushed cube stopped, beside Coulomb's distance, and what it did on the way."""
    friction = max(case.friction, case.surface_friction)
    expected = sliding.coulomb_distance(case.speed, friction, case.gravity)
    if found.stop_distance is None or found.stop_time is None:
        told = f"`{name}` did not stop within the window; it came {found.final_distance:.4f} m far"
    else:
        apart = 100 * (found.stop_distance / expected - 1)
        told = (
            f"`{name}` stops after {found.stop_time:.2f} s and {found.stop_distance:.4f} m; with "
            f"μ = {friction:g}, v² / (2 μ g) is {expected:.4f} m, {signed(apart)} % from it"
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
    """Say which rule for two coefficients the distances fit, and what the other surface changed."""
    told = []
    for name, found in slides.items():
        case = cases[name]
        if found.stop_distance is None:
            continue
        apparent = sliding.apparent_friction(case.speed, found.stop_distance, case.gravity)
        rule = sliding.nearest_rule(apparent, case.friction, case.surface_friction)
        told.append(
            f"`{name}`: {case.friction:g} on {case.surface_friction:g} stops as a cube with "
            f"{apparent:.3f} would; {rule} of the two is "
            f"{sliding.RULES[rule](case.friction, case.surface_friction):.3g}, the nearest."
        )
    for lane in ("low", "high"):
        one, other = (slides[f"{lane}_on_{of}"].stop_distance for of in ("050", "030"))
        if one is None or other is None:
            told.append(f"Of the cubes with {lane} friction one did not stop.")
            continue
        if abs(other - one) <= l03.SAME_SLIDE:
            how = f"changes nothing to speak of ({1e6 * abs(other - one):.2g} µm)"
        else:
            how = f"makes {100 * abs(other - one):.1f} cm {'more' if other > one else 'less'}"
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
        told.append(
            f"The finest step leaves {finest.first_kept:.1f} %; a linear spring of this damping "
            f"would leave {expected:.1f} %. What is missing to 100 % is the contact's own "
            "damping."
        )
    drift = max(found.flight_drift / found.start_energy for found in bounces.values())
    coarse, fine = (bounces[order[k]] for k in (-1, 0))
    told.append(
        f"In the air the total energy changes by up to {1000 * coarse.lent:.1f} mJ at the coarsest "
        f"step and by {1000 * fine.lent:.2f} mJ at the finest, and comes back with the velocity: "
        f"less m g h v / 2, it changes by no more than {1e6 * drift:.1f} millionths."
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


def step_study(rows: Mapping[float, LandingMetrics], finest: float) -> tuple[str, ...]:
    """Say what becomes of depth and rebound as the solver's step gets smaller.

    Args:
        rows: metrics by solver step [s].
        finest: the smallest step [s].
    """
    leaving = sorted(h for h, found in rows.items() if found.rebound > CLEAR)
    told = [
        f"At the smallest step, {1000 * finest:g} ms, the cube sinks in by "
        f"{mm(rows[finest].penetration)}; at the largest by "
        f"{mm(rows[max(rows)].penetration)}."
    ]
    if not leaving:
        return (*told, "At no step does it leave the surface again.")
    steps = listed([f"{1000 * h:g} ms" for h in leaving])
    if min(leaving) > finest:
        told.append(
            f"It leaves the surface again at {steps} and at no smaller step: the rebound belongs "
            "to that step, not to the cube."
        )
    else:
        told.append(f"It leaves the surface again at {steps}, the smallest among them.")
    return tuple(told)


def mm(value: float) -> str:
    """Write a length in millimetres [m]."""
    return f"{1000 * value:.2f} mm"


def signed(value: float) -> str:
    """Write a difference with its sign, one digit after the point."""
    return f"{value:+.1f}".replace("-", "\N{MINUS SIGN}")
