"""Tables of L06, and the sentences that the lab generates, each a function of the experiment.

Those about throughput are correct for every outcome, because elapsed times differ in each run.
"""

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import DT, FloatArray
from robo_genesis.core.text import bullets, decimal, listed
from robo_genesis.core.trace import Trace
from robo_genesis.lessons.l06 import spec, study
from robo_genesis.lessons.l06.throughput import FITTED, GROUP
from robo_genesis.sim.arm.kinematics import ARM
from robo_genesis.sim.mujoco import kinematics as mujoco_kinematics
from robo_genesis.sim.throughput import Model, fit

MEASURES = False

SHOWN_TORQUES = (1, 3)
"""The joints with a torque in the table of variants: joint2 and joint4."""


def mm(value: float, digits: int = 2) -> str:
    """Return a length in millimetres."""
    return decimal(1000 * value, digits)


@tables.as_table
def mixed_table(run: Experiment) -> Iterator[dict[str, str]]:
    """Return residual and verdict of each row of the question with a target beyond reach."""
    found = run.readings["mixed"].values(), run.readings["mixed_accepted"].values()
    for k, (residual, accepted) in enumerate(zip(*found, strict=True)):
        yield {
            "row": f"{k}",
            "target [m]": ", ".join(f"{value:g}" for value in spec.MIXED[k]).replace("-", "−"),
            "position residual [mm]": mm(residual, 3),
            "the row is": "accepted" if accepted else "**refused**",
        }


def row_table(run: Experiment) -> str:
    """Return residual and distances of each environment."""
    heads = {
        "residual of the last command [mm]": 3,
        "first target after 1.8 s [mm]": 2,
        "last target at the end [mm]": 2,
        "motion after 1.8 s [mm]": 2,
    }
    found = {spec.LABELS[name]: run.metrics[name] for name in spec.WORLDS}
    rows = {
        label: [1e3 * v for v in (m.residual, m.first_distance, m.final_distance, m.moved_later)]
        for label, m in found.items()
    }
    return tables.number_table("run", heads, rows)


def alone_table(run: Experiment) -> str:
    """Return the largest differences between each row and the same run alone.

    A line of an environment is about the joints of the arm; the last line is about all fingers.
    """
    heads = {
        "position [µrad]": 2,
        "velocity [µrad/s]": 1,
        "control force [mN·m]": 2,
        "entries that differ [%]": 0,
    }
    pairs = {f"env_{k}": (run.traces[f"env_{k}"], run.traces[f"alone_{k}"]) for k in spec.ENVS}

    def largest(pair: tuple[Trace, Trace], joints: slice) -> FloatArray:
        found = study.largest_differences(*pair, joints).values()
        return np.array([1e6, 1e6, 1e3]) * list(found)

    rows: dict[str, list[Any]] = {}
    for name, pair in pairs.items():
        differ, compared = study.entries_that_differ(*pair)
        rows[spec.LABELS[name]] = [*largest(pair, slice(ARM)), 100 * differ / compared]
    fingers = np.max([largest(pair, slice(ARM, None)) for pair in pairs.values()], axis=0)
    units = zip(fingers, ("µm", "µm/s", "mN"), strict=True)
    rows["fingers of all four"] = [*(f"{decimal(value, 2)} {unit}" for value, unit in units), ""]
    return tables.number_table("run", heads, rows)


def numbers(names: Iterable[str]) -> str:
    """Return the numbers of environments at the end of the names of runs as a list in prose."""
    return listed([name[-1] for name in names])


CLAIMED = {
    "permuted": f"the worlds in the order {', '.join(map(str, spec.ORDER))}",
    "beside": f"environments {numbers(spec.BESIDE)}, while {numbers(spec.AGAIN)} are reset and "
    f"commanded after {spec.RESET_AFTER * spec.FIRST.dt:g} s",
    "again": f"environments {numbers(spec.AGAIN)} from their reset on, against their first start",
    "plain": "the plain robot beside other gains and loads, against environment 0",
}


def equal_table(run: Experiment) -> str:
    """Return how many entries differ where runs must be equal to the last bit."""
    rows = {}
    for claim, names in study.pairs().items():
        pairs = [(run.traces[one], run.traces[other]) for one, other in names]
        counted = [study.entries_that_differ(*pair) for pair in pairs]
        differ, compared = (sum(column) for column in zip(*counted, strict=True))
        rows[CLAIMED[claim]] = f"{compared:,}".replace(",", " "), f"{differ}"
    heads = {"numbers compared": 0, "that differ": 0}
    return tables.number_table("what changed", heads, rows)


def variant_table(run: Experiment) -> str:
    """Return gains, mass, torques and distances of four robots with one target."""
    torques = [f"torque of joint{k + 1} (computed) [N·m]" for k in SHOWN_TORQUES]
    heads = {"KP of joint2 [N·m/rad]": 0, "mass of the hand [kg]": 2}
    heads |= dict.fromkeys(torques, 2) | {"target to hand [mm]": 2}
    rows = {}
    for name, world in spec.VARIANTS.items():
        trace, m = run.traces[name], run.metrics[name]
        expected = mujoco_kinematics.gravity_effort(trace.q[-1].astype(float), world.load)
        pairs = [(trace.control_force[-1, k], expected[k]) for k in SHOWN_TORQUES]
        both = [f"{decimal(found, 2)} ({decimal(right, 2)})" for found, right in pairs]
        mass = run.readings["hand_mass"][name]
        rows[spec.LABELS[name]] = (world.kp[1], mass, *both, 1e3 * m.final_distance)
    return tables.number_table("robot", heads, rows)


MOVED = (
    "After the second command, the named environments moved by {named} mm or more, the others did "
    "not move.",
    "After the second command, the named environments moved by {named} mm or more, the others by "
    "{others:.2g} µm or less.",
)
"""What the lab says if the other environments kept their place, and if they did not."""


def conclusions(run: Experiment) -> str:
    """Return the sentences about the lab's runs."""
    m = run.metrics
    accepted = numbers(name for name, is_ in run.readings["mixed_accepted"].items() if is_)
    named, others = (
        [m[f"env_{k}"].moved_later for k in spec.ENVS if (k in spec.LATER) == is_]
        for is_ in (True, False)
    )
    apart = max(
        study.largest_differences(run.traces[f"env_{k}"], run.traces[f"alone_{k}"], slice(ARM))["q"]
        for k in spec.ENVS
    )
    return bullets([
        f"One of the four targets is beyond reach. Rows {accepted} are accepted.",
        MOVED[max(others) > 0].format(named=mm(min(named)), others=1e6 * max(others)),
        "Positions of arm joints in a row and in the same run alone differ by up to "
        f"{1e6 * apart:.2f} µrad.",
        *(
            f"The hand stops {mm(m[name].final_distance)} mm from its target ({spec.LABELS[name]})."
            for name in spec.VARIANTS
        ),
    ])  # fmt: skip


def three(value: float) -> str:
    """Return a number with three significant digits, with commas from 1000 on."""
    rounded = float(f"{value:.3g}")
    text = f"{rounded:,.0f}" if abs(rounded) >= 100 else f"{rounded:g}"
    return text.replace("-", "−")


def ms(seconds: float) -> str:
    """Return a time in milliseconds."""
    return three(1000 * seconds)


def sizes(run: Experiment) -> list[int]:
    """Return the numbers of environments that were timed."""
    return [int(name[6:]) for name in run.readings[GROUP] if name.startswith("build_")]


def steps(run: Experiment) -> dict[int, float]:
    """Return the time of a step by the number of environments [s]."""
    return {size: run.readings[GROUP][f"step_{size}"] for size in sizes(run)}


def throughput_table(run: Experiment) -> str:
    """Return time and throughput of each number of environments; the largest one is bold."""
    found, rows = steps(run), {}
    first, best = next(iter(found.values())), max(found, key=lambda size: size / found[size])
    for size, step in found.items():
        rate = three(size / step)
        rows[f"{size}"] = ms(step), three(step / first), f"**{rate}**" if size == best else rate
    heads = ("one step [ms]", "times the first", "steps per second, all")
    return tables.timed_table("environments", dict.fromkeys(heads, 0), rows)


def throughput_details(run: Experiment) -> str:
    """Return what else was measured with each number of environments."""
    found, rows = run.readings[GROUP], {}
    for size, step in steps(run).items():
        of = [found[f"{name}_{size}"] for name in ("fastest", "slowest", "build", "memory")]
        rows[f"{size}"] = f"{ms(of[0])} to {ms(of[1])}", three(DT / step), *of[2:]
    heads = ("fastest to slowest [ms]", "simulated s per s, each", "build [s]", "memory [MiB]")
    return tables.timed_table("environments", dict(zip(heads, (0, 0, 1, 0), strict=True)), rows)


def fitted(run: Experiment) -> Model:
    """Return the model of the time of a step, fitted on the sizes of `FITTED`."""
    return fit(FITTED, [steps(run)[size] for size in FITTED])


def model_table(run: Experiment) -> str:
    """Return measured time and model of each number of environments."""
    model, rows = fitted(run), {}
    for size, step in steps(run).items():
        expected, name = float(model.step_time(size)), f"{size}{', fitted' * (size in FITTED)}"
        rows[name] = ms(step), ms(expected), step / expected
    heads = {"measured [ms]": 0, "model [ms]": 0, "ratio": 2}
    return tables.timed_table("B", heads, rows)


def constants_table(run: Experiment) -> str:
    """Return both constants of the model, and what follows from them."""
    model = fitted(run)
    rows = {
        "*a*, the fixed part of a step": f"{ms(model.fixed)} ms",
        "*b*, the part of each environment": f"{three(1e6 * model.each)} µs",
        "1/*b*, the limit of the throughput": f"{three(1 / model.each)} steps per second",
        "*a*/*b*, with which the throughput is half of it": (
            f"{three(model.fixed / model.each)} environments"
        ),
    }
    return tables.timed_table("constant", {"fit": 0}, {name: (of,) for name, of in rows.items()})


def content_table(run: Experiment) -> str:
    """Return the time of a step with a sphere and with the robot."""
    rows = {}
    for size in (1, 256):
        sphere, robot = (run.readings[GROUP][f"step_{of}{size}"] for of in ("sphere_", ""))
        rows[f"{size}"] = ms(sphere), ms(robot), three(robot / sphere)
    return tables.timed_table("B", dict.fromkeys(("sphere [ms]", "robot [ms]", "ratio"), 0), rows)


def cache_table(run: Experiment) -> str:
    """Compare one scene of 1024 environments with four of 256."""
    found = run.readings[GROUP]
    one, four = found["step_1024"], found["step_four_scenes"]
    grown = (found["memory_1024"] - found["memory_256"]) / (1024 - 256)
    rows = {
        "a step of one scene of 1024": f"{ms(one)} ms",
        "a step of four scenes of 256, in turn": f"{ms(four)} ms",
        "the first divided by the second": three(one / four),
        "memory of each environment": f"{three(grown)} MiB",
    }
    return tables.timed_table("what", {"measured": 0}, {name: (of,) for name, of in rows.items()})
