"""Named checks of L07; the docstring of each is its claim."""

from itertools import chain

import numpy as np

from robo_genesis.core.checks import (
    Findings,
    above,
    at_most,
    equal,
    within,
)
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.trace import Trace
from robo_genesis.sim.arm.laws import assigned_run, driven_run
from robo_genesis.sim.bodies import table
from robo_genesis.sim.common_checks import posture, stamps, structure
from robo_genesis.sim.laws import apart, kept

from . import rungs, spec
from .metrics import OBJECT


def one_rung(run: Experiment) -> Findings:
    """Scene A passes all five rungs, and each other scene of the page fails the one
    that it was made for, and no other, except that the hand cannot lift what it cannot
    reach. A run without a camera cannot fail "seen".
    """
    for name in rungs.scenes(run):
        made_for = spec.FAILS[name]
        unseen = made_for == "seen" and not run.rendered
        expected = [made_for] if made_for and not unseen else []
        expected += ["graspable"] * (made_for == "reachable")
        yield equal(f"{name}.fails", rungs.failed(run, name), expected)
        if expected:
            number = run.readings["fails"][name]
            yield equal(f"{name}.number", number, rungs.NUMBERS.index(made_for))


def hovering_is_at_rest(run: Experiment) -> Findings:
    """The object of scene B is 5 mm above the table, keeps its place to 1 µm, and is
    lifted with the hand.
    """
    rest, lift = run.metrics["hovering_at_rest"], run.metrics["hovering"]
    yield within("hovering.support_m", rest.support, 5e-3, 1e-6)
    yield at_most("hovering.drift_m", rest.drift, 1e-6)
    yield above("hovering.share_of_the_rise", lift.rise / lift.hand_rise, 0.99)


def attacks_are_caught(run: Experiment) -> Findings:
    """Each scene that was made to fool the ladder fails the rung of the quantity that
    was made for it, and by this quantity; the good ones pass all rungs.
    """
    for name, (_, quantity) in spec.ATTACKS.items():
        rung = rungs.rung_of(quantity) if quantity else None
        number = rungs.NUMBERS.index(rung)
        yield equal(f"{name}.fails", run.readings["attacks"][name], number)
        if quantity:
            value = run.readings["caught"][name]
            yield equal(f"{name}.passes", rungs.passed({quantity: value}), False)


def lifted_though_too_wide(run: Experiment) -> Findings:
    """With friction 0.1, a box that is 80.5 mm wide is lifted by both fingers, by more
    than 80 % of the hand's rise, with two solver steps in an outer step and with four.
    Both times the open hand touches it on its way down, and it ends tilted by more than
    20 mrad.
    """
    for name in spec.FURTHER:
        found, contacts = run.metrics[name], run.readings["contacts"]
        yield above(f"{name}.share_of_the_rise", found.rise / found.hand_rise, 0.8)
        yield above(f"{name}.tilt_rad", found.tilt, 0.02)
        for of in spec.CONTACTS:
            yield above(f"{name}.{of}", contacts[f"{name}_{of}"], 0)


def laws_of_motion(run: Experiment) -> Findings:
    """At each sample links and control forces are those of the driven robot, and bodies
    begin where their case puts them. Answers of a map are assigned.
    """
    links = run.links[:OBJECT]
    for name, case in run.cases.items():
        trace = run.traces[name]
        if isinstance(case, table.SceneCase):
            driven = driven_run(trace, case.commanding(trace.target), links)
            yield from kept(name, chain(driven, bodies(trace, case)))
        else:
            yield from kept(name, assigned_run(trace, links, case.start.model))


def bodies(trace: Trace, case: table.SceneCase) -> Findings:
    """Yield a body that does not begin at its place."""
    expected = np.array([case.centre, (*case.bowl_at, table.BALL_HEIGHT)])
    start = trace.link_pos[0, OBJECT:]
    yield from apart("start of link_pos of the bodies [m]", start, expected, 1e-6)


CHECKS = (structure, stamps, one_rung, laws_of_motion, posture)
LECTURE = (hovering_is_at_rest, lifted_though_too_wide, attacks_are_caught)
