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
SLIDES = 5e-3  # Speed from which a box slides [m/s]


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


def friction_lets_creep(run: Experiment) -> Findings:
    """At 10° a box with more friction creeps faster from 0.5 to 1 and to 2; one with
    0.3 does so as well, because an edge of it has lost its load.
    """
    for faster, slower in (("firm", "box"), ("rough", "firm"), ("slick", "box")):
        share = share_of(run, f"tilt_10_{faster}", f"tilt_10_{slower}")
        yield above(f"{faster}.share_of_{slower}", share, 1 + SAME)


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
    deeper. With the cone alone it creeps at 0.8 of its speed, within 3 %; with impratio
    alone by at most a twentieth.
    """
    for name in (*rest.SCENES["elliptic_10"], *rest.SCENES["elliptic_20"]):
        found, (_, expected) = run.metrics[name].creep, depth_and_creep(run.cases[name])
        share = share_of(run, name, name.replace("elliptic", "tilt"))
        yield at_most(f"{name}.share", share, HELD)
        yield within(f"{name}.creep_m_s", found, expected, ROUNDING)
    deeper = run.metrics["elliptic_0_box"].sunk / run.metrics["tilt_0_box"].sunk
    yield above("box.deeper", deeper, DEEPER)
    yield nearly("elliptic_alone.share", share_of(run, "elliptic_alone_box"), 0.8, SAME)
    yield at_most("impratio_100.share", share_of(run, "impratio_100_box"), HELD)


def noslip_is_no_cure(run: Experiment) -> Findings:
    """In both engines noslip stops the box with 0.5 at 5°. In MuJoCo it creeps faster
    with noslip at 15°, and equally fast at 20°.
    """
    for engine in ("", "mujoco_"):
        share = share_of(run, f"{engine}noslip_5_box", f"{engine}tilt_5_box")
        yield at_most(f"{engine}noslip_5.share", share, HELD)
    faster, equal = (
        share_of(run, f"mujoco_noslip_{tilt}_box", f"mujoco_tilt_{tilt}_box")
        for tilt in (15, 20)
    )
    yield above("mujoco_noslip_15.share", faster, 1 + BEYOND)
    yield nearly("mujoco_noslip_20.share", equal, 1.0, SAME)


def engines_agree(run: Experiment) -> Findings:
    """In MuJoCo a box sinks in and creeps as in Genesis, within 2 % and what float32 leaves."""
    for twin, case in rest.TWINS.items():
        if twin not in rest.SLIDING and not case.noslip:
            one, other = run.metrics[twin.removeprefix("mujoco_")], run.metrics[twin]
            yield nearly(f"{twin}.sunk_m", other.sunk, one.sunk, SHARE, DEPTH)
            yield nearly(f"{twin}.creep_m_s", other.creep, one.creep, SHARE, ROUNDING)


def diagonal_slides_first(run: Experiment) -> Findings:
    """In MuJoCo a box with 0.5 slides at 20° towards the diagonal of its pyramid; along
    an axis it creeps at 24°, and along the diagonal at 18°.
    """
    yield above(
        "diagonal_20.speed_m_s", run.metrics["mujoco_diagonal_20"].creep, SLIDES
    )
    for name in ("axis_24", "diagonal_18"):
        yield below(f"{name}.speed_m_s", run.metrics[f"mujoco_{name}"].creep, SLIDES)


def speed_misleads(run: Experiment) -> Findings:
    """The box that falls by 5 mm is slow, and fast later. In MuJoCo the box with noslip
    at 15° is slow in 20 to 80 % of the last samples, and moves by less than a tenth of
    what its highest speed would give.
    """
    fall = run.metrics["fall_box"]
    yield below("fall_box.slow_at_s", fall.slow_at, fall.fast_until)
    name = "mujoco_noslip_15_box"
    of = run.metrics[name]
    yield within(f"{name}.slow_percent", of.slow, 50.0, 30.0)
    yield below(f"{name}.moved_m", of.moved, of.fastest * rest.WINDOW / 10)


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
    friction_lets_creep,
    what_counts,
    round_cone_holds,
    noslip_is_no_cure,
    engines_agree,
    diagonal_slides_first,
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
