"""Tables of L06, and the sentences that the lab generates, each a function of the experiment.

Those about throughput are correct for every outcome, because elapsed times differ in
each run.
"""

from collections.abc import Iterable, Sequence
from itertools import combinations

import numpy as np

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import DT, SUBSTEPS
from robo_genesis.core.text import bullets, decimal, listed
from robo_genesis.sim.mujoco import kinematics as mujoco_kinematics
from robo_genesis.sim.throughput import Model, fit

from . import spec, study
from .checks import swept
from .throughput import ENDS, FITTED, GROUP, PARTS

MEASURES = False

# The joints with a torque in the table of variants: joint2 and joint4.
SHOWN_TORQUES = (1, 3)


def mm(value: float, digits: int = 2) -> str:
    """Return a length in millimetres."""
    return decimal(1000 * value, digits)


@tables.as_table
def mixed_table(run: Experiment) -> tables.Rows:
    """Return residual and verdict of each row of the question with a target beyond reach."""
    found = run.readings["mixed"].values(), run.readings["mixed_accepted"].values()
    for k, (residual, accepted) in enumerate(zip(*found, strict=True)):
        yield {
            "row": f"{k}",
            "target [m]": "{:g}, {:g}, {:g}".format(*spec.MIXED[k]).replace("-", "−"),
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
    rows = {}
    for name in spec.WORLDS:
        m = run.metrics[name]
        metres = m.residual, m.first_distance, m.final_distance, m.moved_later
        rows[spec.LABELS[name]] = 1e3 * np.array(metres)
    return tables.number_table("run", heads, rows)


@tables.as_table
def sweep_table(run: Experiment) -> tables.Rows:
    """Return overshoot and distance at the end of the robots of the sweep without a load."""
    for kp in reversed(spec.FACTORS):
        row = {"KP ×": f"{kp:g}"}
        for kv in spec.FACTORS:
            name = spec.SWEEP[kp, kv, 0.0]
            end, passed = (1e3 * sweep[name] for sweep in swept(run))
            row[f"KV × {kv:g}"] = f"{passed:.0f} / {end:.0f}"
        yield row


def ends(names: Iterable[str]) -> str:
    """Return the numbers of environments at the end of the names of runs as a list in prose."""
    return listed([name[-1] for name in names])


# What is compared, by claim; `equality_table` has a row for each one that a page
# measured.
CLAIMED = {
    "permuted": f"the worlds in the order {', '.join(map(str, spec.ORDER))}",
    "beside": f"environments {ends(spec.BESIDE)}, while {ends(spec.AGAIN)} are reset and "
    f"commanded after {spec.RESET_AFTER * spec.FIRST.dt:g} s",
    "again": f"environments {ends(spec.AGAIN)} from their reset on, compared with their first "
    "episode",
    "plain": "the plain robot beside other gains and loads, against environment 0",
    "alone": "each world alone, in free motion",
    "pressed_permuted": "the other order, hands pressed on the floor",
    "pressed_again": f"{ends(spec.AGAIN)} from their reset on, hands pressed on the floor",
    "pressed_alone": "alone, hands pressed on the floor",
    "one_start": "four equal questions to the solver in one call, with one start",
    "restarts": "the same with up to 50 starts",
}


def equality_table(run: Experiment) -> str:
    """Return how many numbers differ, and by how much, where two runs could be equal."""
    found = {claim: study.compared_runs(run, claim) for claim in study.pairs()}
    measured = run.readings.get(study.EQUALITY, {})
    for claim in study.READ if measured else ():
        found[claim] = [measured[f"{claim}_{what}"] for what in study.COMPARED]
    rows = {}
    for claim, (numbers, differ, apart) in found.items():
        large = f"{apart:.2f} rad" if apart > 0.1 else f"{three(1e6 * apart)} µrad"
        rows[CLAIMED[claim]] = f"{numbers:,.0f}", f"{differ:,.0f}", large
    heads = ("numbers", "that differ", "largest difference of a joint")
    return tables.number_table("what changed", dict.fromkeys(heads, 0), rows)


def variant_table(run: Experiment) -> str:
    """Return gains, mass, torques and distances of four robots with one target."""
    torques = [f"torque of joint{k + 1} (computed) [N·m]" for k in SHOWN_TORQUES]
    heads = {
        "KP of joint2 [N·m/rad]": 0,
        "mass of the hand [kg]": 2,
        **dict.fromkeys(torques, 2),
        "ends from target [mm]": 2,
        "passes it by [mm]": 1,
    }
    rows = {}
    for name, world in spec.VARIANTS.items():
        trace, m = run.traces[name], run.metrics[name]
        q, force = trace.q[-1].astype(float), trace.control_force[-1]
        expected = mujoco_kinematics.gravity_effort(q, world.load)
        both = [
            f"{decimal(force[k], 2)} ({decimal(expected[k], 2)})" for k in SHOWN_TORQUES
        ]
        first = world.kp[1], run.readings["hand_mass"][name], *both
        rows[spec.LABELS[name]] = *first, 1e3 * m.final_distance, 1e3 * m.overshoot
    return tables.number_table("robot", heads, rows)


def conclusions(run: Experiment) -> str:
    """Return the sentences about the lab's runs."""
    m, verdicts = run.metrics, run.readings["mixed_accepted"]
    accepted = ends(name for name, verdict in verdicts.items() if verdict)
    named, others = (
        [m[f"env_{k}"].moved_later for k in rows]
        for rows in (spec.LATER, {*spec.ENVS} - {*spec.LATER})
    )
    *_, apart = study.compared_runs(run, "alone")
    return bullets(
        [
            f"One of the four targets is beyond reach. Rows {accepted} are accepted.",
            "After the second command, the named environments moved by "
            f"{mm(min(named))} mm or more, the others by at most {1e6 * max(others):.2g} µm.",
            "Positions of arm joints in a row and in the same run alone differ by up to "
            f"{1e6 * apart:.2f} µrad.",
            *(
                f"{spec.LABELS[name]}: the hand passes the target by "
                f"{mm(m[name].overshoot)} mm, ends {mm(m[name].final_distance)} mm from it."
                for name in spec.VARIANTS
            ),
        ]
    )


def three(value: float) -> str:
    """Return a number with three significant digits, with commas from 1000 on."""
    rounded = float(f"{value:.3g}")
    text = f"{rounded:,.0f}" if abs(rounded) >= 100 else f"{rounded:g}"
    return text.replace("-", "−")


def ms(seconds: float) -> str:
    """Return a time in milliseconds."""
    return three(1000 * seconds)


def steps(run: Experiment) -> dict[int, float]:
    """Return the time of a step by the number of environments that were timed [s]."""
    found = run.readings[GROUP]
    sizes = (int(name[6:]) for name in found if name.startswith("build_"))
    return {size: found[f"step_{size}"] for size in sizes}


def throughput_table(run: Experiment) -> str:
    """Return time and throughput of each number of environments; the largest one is bold."""
    found = steps(run)
    best = max(found, key=lambda size: size / found[size])
    rows = {}
    for size, step in found.items():
        rate = three(size / step)
        bold = f"**{rate}**" if size == best else rate
        rows[f"{size}"] = ms(step), three(step / found[1]), bold
    heads = ("one step [ms]", "times the first", "steps per second, all")
    return tables.timed_table("environments", dict.fromkeys(heads, 0), rows)


def throughput_details(run: Experiment) -> str:
    """Return what else was measured with each number of environments."""
    found, rows = run.readings[GROUP], {}
    for size, step in steps(run).items():
        repeats = f"{ms(found[f'fastest_{size}'])} to {ms(found[f'slowest_{size}'])}"
        of_build = found[f"build_{size}"], found[f"memory_{size}"]
        rows[f"{size}"] = repeats, three(DT / step), *of_build
    heads = {
        "fastest to slowest [ms]": 0,
        "simulated s per s, each": 0,
        "build [s]": 1,
        "memory [MiB]": 0,
    }
    return tables.timed_table("environments", heads, rows)


def fits(run: Experiment) -> list[Model]:
    """Return the models of the time of a step, each fitted on three sizes of `FITTED`."""
    found = steps(run)
    return [fit(of, [found[size] for size in of]) for of in combinations(FITTED, 3)]


def span(values: Sequence[float]) -> str:
    """Return the least and the largest value with two digits each."""
    least, most = (three(float(f"{of(values):.2g}")) for of in (min, max))
    return f"{least} to {most}"


def model_table(run: Experiment) -> str:
    """Return measured time and models of each number of environments."""
    models, rows = fits(run), {}
    for size, step in steps(run).items():
        expected = [model.step_time(size) for model in models]
        name = f"{size}{', fitted' * (size in FITTED)}"
        shares = f"{step / max(expected):.2f} to {step / min(expected):.2f}"
        rows[name] = ms(step), span([1e3 * of for of in expected]), shares
    heads = {"measured [ms]": 0, "models [ms]": 0, "measured / model": 0}
    return tables.timed_table("B", heads, rows)


def constants_table(run: Experiment) -> str:
    """Return the range of both constants of the models, and what follows from them."""
    models = fits(run)
    constants = {
        "*a*, the fixed part of a step [ms]": [1e3 * m.fixed for m in models],
        "*b*, the part of each environment [µs]": [1e6 * m.each for m in models],
        "1/*b*, the limit of the throughput [steps per second]": [
            1 / m.each for m in models
        ],
        "*a*/*b*, environments for half of it": [m.fixed / m.each for m in models],
    }
    rows = {name: (span(values),) for name, values in constants.items()}
    return tables.timed_table("constant", {"models": 0}, rows)


def parts_table(run: Experiment) -> str:
    """Return both parts of a step from the sizes of `ENDS`, for other contents and substeps."""
    found, rows = run.readings[GROUP], {}
    for part, substeps in {"": SUBSTEPS, **PARTS}.items():
        label = f"{part.partition('_')[0] or 'robot'}, substeps: {substeps}"
        of = part and f"{part}_"
        model = fit(ENDS, [found[f"step_{of}{size}"] for size in ENDS])
        rows[label] = ms(model.fixed), three(1e6 * model.each)
    return tables.timed_table("scene", dict.fromkeys(("*a* [ms]", "*b* [µs]"), 0), rows)


def cache_table(run: Experiment) -> str:
    """Compare one scene of 1024 or 1000 environments with four scenes of a quarter of them."""
    rows = {}
    for size in (1024, 1000):
        four = size // 4
        for words, name in (
            (f"one scene of {size}", f"{size}"),
            (f"four scenes of {four}, in turn", f"four_of_{four}"),
        ):
            step = run.readings[GROUP][f"step_{name}"]
            rows[words] = ms(step), three(1e6 * step / size)
    heads = {"time [ms]": 0, "for each environment [µs]": 0}
    return tables.timed_table("a step of", heads, rows)
