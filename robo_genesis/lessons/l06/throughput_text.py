"""Tables and sentences of L06 about throughput, each a function of the experiment.

They are correct for every outcome, because elapsed times are different in each run.
"""

from robo_genesis.core import tables
from robo_genesis.core.scene import DT
from robo_genesis.core.text import bullets
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l06.throughput import FITTED, GROUP
from robo_genesis.sim.throughput import Model, fit


def three(value: float) -> str:
    """Return a number with three significant digits, large ones with commas."""
    text = f"{float(f'{value:.3g}'):,.0f}" if abs(value) >= 999.5 else f"{value:.3g}"
    return text.replace("-", "−")


def ms(seconds: float) -> str:
    """Return a time in milliseconds."""
    return three(1000 * seconds)


def sizes(run: Experiment) -> list[int]:
    """Return the numbers of environments that were timed."""
    return [int(name[6:]) for name in run.readings[GROUP] if name.startswith("build_")]


def table(run: Experiment) -> str:
    """Return time, throughput and memory of each number of environments."""
    found, rows = run.readings[GROUP], []
    for size in sizes(run):
        step, fastest, slowest = (found[f"{n}_{size}"] for n in ("step", "fastest", "slowest"))
        rows.append(
            {
                "environments": f"{size}",
                "build [s]": f"{found[f'build_{size}']:.1f}",
                "one step [ms]": ms(step),
                "fastest to slowest [ms]": f"{ms(fastest)} to {ms(slowest)}",
                "steps per second, all": three(size / step),
                "simulated s per s, each": three(DT / step),
                "memory [MiB]": f"{found[f'memory_{size}']:.0f}",
            }
        )
    return tables.markdown(rows)


def conclusions(run: Experiment) -> str:
    """Return the sentences about one measurement."""
    found = run.readings[GROUP]
    rate = {size: size / found[f"step_{size}"] for size in sizes(run)}
    few, *_, many = rate
    best = max(rate, key=rate.__getitem__)
    longer = three(found[f"step_{many}"] / found[f"step_{few}"])
    spread = max(found[f"slowest_{size}"] / found[f"fastest_{size}"] for size in rate)
    lines = [
        f"A step with {many} environments takes {longer} times as long as a step with {few}.",
        f"All environments together make {three(rate[few])} steps per second with {few} and "
        f"{three(rate[many])} with {many} environments. The most are {three(rate[best])}, with "
        f"{best}.",
        f"In one second of the machine, an environment advances by {three(DT * rate[few] / few)} s "
        f"with {few}, and by {three(DT * rate[many] / many)} s with {many} environments.",
        f"The slowest repeat took up to {three(spread)} times as long as the fastest of the same "
        "size. If this is far above 1, another program ran: measure again.",
    ]
    return bullets(lines)


def fitted(run: Experiment) -> Model:
    """Return the model of the time of a step, fitted on the sizes of `FITTED`."""
    return fit(FITTED, [run.readings[GROUP][f"step_{size}"] for size in FITTED])


def model_table(run: Experiment) -> str:
    """Return measured time and model of each number of environments."""
    rows, model = [], fitted(run)
    for size in sizes(run):
        measured, expected = run.readings[GROUP][f"step_{size}"], float(model.step_time(size))
        rows.append(
            {
                "B": f"{size}",
                "measured [ms]": ms(measured),
                "model [ms]": ms(expected),
                "ratio": f"{measured / expected:.2f}",
                "for": "fit" if size in FITTED else "test",
            }
        )
    return tables.markdown(rows)


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
        rows.append({"environments": f"{size}"} | times | {"robot / sphere": three(robot / sphere)})
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
