"""Tables and sentences of L06 about throughput, each a function of the experiment.

They are correct for every outcome, because elapsed times are different in each run.
"""

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import DT
from robo_genesis.core.text import bullets
from robo_genesis.lessons.l06.throughput import FITTED, GROUP
from robo_genesis.sim.throughput import Model, fit

MEASURES = False


def three(value: float, digits: int = 3) -> str:
    """Return a number with three significant digits or another number of them, with commas."""
    rounded = float(f"{value:.{digits}g}")
    text = f"{rounded:,.0f}" if abs(rounded) >= 100 else f"{rounded:g}"
    return text.replace("-", "−")


def two(value: float) -> str:
    """Return a number with two significant digits: what several runs of a page share at most."""
    return three(value, 2)


def ms(seconds: float) -> str:
    """Return a time in milliseconds."""
    return three(1000 * seconds)


def sizes(run: Experiment) -> list[int]:
    """Return the numbers of environments that were timed."""
    return [int(name[6:]) for name in run.readings[GROUP] if name.startswith("build_")]


def steps(run: Experiment) -> dict[int, float]:
    """Return the time of a step by the number of environments [s]."""
    return {size: run.readings[GROUP][f"step_{size}"] for size in sizes(run)}


def table(run: Experiment) -> str:
    """Return time and throughput of each number of environments."""
    rows = {f"{size}": (ms(step), three(size / step)) for size, step in steps(run).items()}
    heads = {"one step [ms]": 0, "steps per second, all": 0}
    return tables.number_table("environments", heads, rows)


def details(run: Experiment) -> str:
    """Return what else was measured with each number of environments."""
    found, rows = run.readings[GROUP], {}
    for size, step in steps(run).items():
        of = [found[f"{name}_{size}"] for name in ("fastest", "slowest", "build", "memory")]
        rows[f"{size}"] = f"{ms(of[0])} to {ms(of[1])}", three(DT / step), *of[2:]
    heads = ("fastest to slowest [ms]", "simulated s per s, each", "build [s]", "memory [MiB]")
    return tables.number_table("environments", dict(zip(heads, (0, 0, 1, 0), strict=True)), rows)


def maximum(run: Experiment) -> str:
    """Say which of the measured numbers of environments has the largest throughput."""
    rate = {size: size / step for size, step in steps(run).items()}
    best, last = max(rate, key=rate.__getitem__), max(rate)
    text = f"The largest throughput is {two(rate[best])} steps per second, with {best}"
    fall = f"With {last} it is {two(rate[last])}, {two(rate[last] / rate[best])} times as much."
    return f"{text} environments. {fall if best < last else 'More were not measured.'}"


def conclusions(run: Experiment) -> str:
    """Return the sentences about one measurement."""
    found = run.readings[GROUP]
    rate = {size: size / found[f"step_{size}"] for size in sizes(run)}
    few, *_, many = rate
    best = max(rate, key=rate.__getitem__)
    longer = two(found[f"step_{many}"] / found[f"step_{few}"])
    spread = max(found[f"slowest_{size}"] / found[f"fastest_{size}"] for size in rate)
    lines = [
        f"A step with {many} environments takes {longer} times as long as a step with {few}.",
        f"All environments together make {two(rate[few])} steps per second with {few} and "
        f"{two(rate[many])} with {many} environments. The largest throughput is "
        f"{two(rate[best])}, with {best} environments.",
        f"In one second of the machine, an environment advances by {two(DT * rate[few] / few)} s "
        f"with {few}, and by {two(DT * rate[many] / many)} s with {many} environments.",
        f"The slowest repeat took up to {two(spread)} times as long as the fastest of the same "
        "size. If this is far above 1, another program ran: measure again. Two runs of this page "
        "can differ more than the repeats of one.",
    ]
    return bullets(lines)


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
    return tables.number_table("B", heads, rows)


def model_sentence(run: Experiment) -> str:
    """Return both constants, and what follows from them."""
    model = fitted(run)
    return (
        f"The fit gives *a* = {ms(model.fixed)} ms and *b* = {three(1e6 * model.each)} µs. With "
        f"these constants the throughput stays below 1/*b* = {three(1 / model.each)} steps per "
        f"second, and *B* = *a*/*b* = {three(model.fixed / model.each)} environments make half "
        "of it."
    )


def content_table(run: Experiment) -> str:
    """Return the time of a step with a sphere and with the robot."""
    rows = []
    for size in (1, 256):
        sphere, robot = (run.readings[GROUP][f"step_{of}{size}"] for of in ("sphere_", ""))
        times = {"sphere [ms]": ms(sphere), "robot [ms]": ms(robot)}
        rows.append({"B": f"{size}"} | times | {"ratio": three(robot / sphere)})
    return tables.markdown(rows)


def cache_sentence(run: Experiment) -> str:
    """Compare one scene of 1024 environments with four of 256."""
    found = run.readings[GROUP]
    one, four = found["step_1024"], found["step_four_scenes"]
    grown = (found["memory_1024"] - found["memory_256"]) / (1024 - 256)
    return (
        f"One scene of 1024 environments needs {ms(one)} ms for a step of all. Four scenes of 256, "
        f"stepped in turn, need {ms(four)} ms. The first time is {three(one / four)} times the "
        f"second. Each environment takes {three(grown)} MiB of memory."
    )
