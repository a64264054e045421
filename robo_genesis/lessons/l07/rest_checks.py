"""Named checks of boxes at rest; the docstring of each is its claim."""

from robo_genesis.core.checks import Findings, above, at_most, below, nearly, within
from robo_genesis.core.experiment import Experiment, MeasuringPage, Readings, runs_of
from robo_genesis.core.trace import ContactTrace
from robo_genesis.sim.bodies.checks import laws_of_motion, settings
from robo_genesis.sim.bodies.contacts import SETTINGS
from robo_genesis.sim.bodies.soft_contact import depth_and_creep
from robo_genesis.sim.common_checks import stamps

from . import rest

# Of a value against its formula, and of a depth in float32 [m]
SHARE, DEPTH = 0.02, 6e-7
SAME = 0.03  # Share by which creeps may differ that the formula makes equal
# Creep that float32 causes [m/s]: on a level table, with impratio 100
STILL, ROUNDING = 2e-6, 8e-6
# Share by which a creep is larger at least where an edge has lost its load
BEYOND = 0.05
# Largest share of a creep and least of a depth, against the pyramid
HELD, DEEPER = 0.05, 5.0


def creeps_as_computed(run: Experiment) -> Findings:
    """On a tilted table each box with the pyramid creeps as the formula says, within 2
    %, while all its edges press; on a level one none creeps. Where the formula assumes
    forces that pull, the box creeps faster than it says.
    """
    for name in (name for scene in rest.PYRAMIDS.values() for name in scene):
        found, (_, expected) = run.metrics[name].creep, depth_and_creep(run.cases[name])
        if rest.in_scope(run.cases[name]):
            yield nearly(f"{name}.creep_m_s", found, expected, SHARE, STILL)
        else:
            yield above(f"{name}.share_of_the_formula", found / expected, 1 + BEYOND)


def sinks_as_computed(run: Experiment) -> Findings:
    """On a level table each box sinks in as the formula says, within 2 %, with either cone."""
    for name in (*rest.SCENES["tilt_0"], *rest.SCENES["elliptic_0"]):
        depth, _ = depth_and_creep(run.cases[name])
        yield nearly(f"{name}.sunk_m", run.metrics[name].sunk, depth, SHARE, DEPTH)


def share_of(run: Experiment, name: str, other: str = "tilt_10_box") -> float:
    """Return the creep of one run as a share of that of another."""
    return run.metrics[name].creep / run.metrics[other].creep


def what_counts(run: Experiment) -> Findings:
    """Density, edge and solver step change the creep by less than 3 %; the time
    constant changes it in proportion, within 3 %.
    """
    same = dict.fromkeys(
        ("tilt_10_heavy", "tilt_10_small", "h_5ms_box", "h_1ms_box"), 1.0
    )
    for name, factor in (same | {"T_5ms_box": 0.5, "T_20ms_box": 2.0}).items():
        yield nearly(f"{name}.share", share_of(run, name), factor, SAME)


def round_cone_holds(run: Experiment) -> Findings:
    """With the elliptic cone each box creeps by at most a twentieth, as the formula
    says up to what float32 leaves, and the box with 0.5 sinks in at least five times
    deeper.
    """
    for name in rest.SCENES["elliptic_10"]:
        found, (_, expected) = run.metrics[name].creep, depth_and_creep(run.cases[name])
        share = share_of(run, name, name.replace("elliptic", "tilt"))
        yield at_most(f"{name}.share", share, HELD)
        yield within(f"{name}.creep_m_s", found, expected, ROUNDING)
    deeper = run.metrics["elliptic_0_box"].sunk / run.metrics["tilt_0_box"].sunk
    yield above("box.deeper", deeper, DEEPER)


def engines_agree(run: Experiment) -> Findings:
    """In MuJoCo a box sinks in and creeps as in Genesis, within 2 % and what float32 leaves."""
    for twin in rest.TWINS:
        one, other = run.metrics[twin.removeprefix("mujoco_")], run.metrics[twin]
        yield nearly(f"{twin}.sunk_m", other.sunk, one.sunk, SHARE, DEPTH)
        yield nearly(f"{twin}.creep_m_s", other.creep, one.creep, SHARE, ROUNDING)


def speed_misleads(run: Experiment) -> Findings:
    """The box that falls by 5 mm is slow, and fast later."""
    fall = run.metrics["fall_box"]
    yield below("fall_box.slow_at_s", fall.slow_at, fall.fast_until)


def window_has_an_edge(run: Experiment) -> Findings:
    """At 10° the window accepts the box that creeps, and refuses the rough one."""
    yield below("box.moved_m", run.metrics["tilt_10_box"].moved, rest.BOUND)
    yield above("rough.moved_m", run.metrics["tilt_10_rough"].moved, rest.BOUND)


CHECKS = (
    settings,
    stamps,
    laws_of_motion,
    creeps_as_computed,
    sinks_as_computed,
    what_counts,
    round_cone_holds,
    engines_agree,
    speed_misleads,
    window_has_an_edge,
)

REST = MeasuringPage(
    runs=runs_of(rest.CASES)
    | runs_of(rest.TWINS, note="run in MuJoCo, not in Genesis"),
    kind=ContactTrace,
    links=("body",),
    readings={name: Readings(dict.fromkeys(rest.CASES, "1")) for name in SETTINGS},
    measure=rest.rest_metrics,
    checks=CHECKS,
    parameters=rest.parameters,
    camera=False,
)
