"""Tables and sentences of L06 about throughput, each a function of the experiment.

They are correct for every outcome, because elapsed times are different in each run.
"""

from collections.abc import Mapping

from robo_genesis.core import tables
from robo_genesis.core.scene import DT
from robo_genesis.core.text import bullets, listed
from robo_genesis.lessons.experiment import Experiment
from robo_genesis.lessons.l06.throughput import FITTED, GROUP, Model, column, fit, sizes_of

NEAR = 0.1
"""A prediction within this share of the measured time is called near."""

DISTURBED = 1.3
"""Slowest over fastest repeat from which a reader is told to measure again."""


def three(value: float) -> str:
    """Return a number with three significant digits, large ones with commas."""
    rounded = float(f"{value:.3g}")
    return f"{rounded:,.0f}" if abs(rounded) >= 1000 else f"{value:.3g}".replace("-", "−")


def ms(seconds: float) -> str:
    """Return a time in milliseconds."""
    return three(1000 * seconds)


def rates(found: Mapping[str, float]) -> dict[int, float]:
    """Return the steps of all environments together in a second, by number of environments."""
    return {size: size / found[f"step_{size}"] for size in sizes_of(found)}


def table(run: Experiment) -> str:
    """Return time, throughput and memory of each number of environments."""
    found = run.readings[GROUP]
    return tables.markdown(
        [
            {
                "environments": f"{size}",
                "build [s]": f"{found[f'build_{size}']:.2f}",
                "one step [ms]": ms(found[f"step_{size}"]),
                "fastest to slowest [ms]": " to ".join(
                    ms(found[f"{what}_{size}"]) for what in ("fastest", "slowest")
                ),
                "steps per second, all": three(rate),
                "simulated s per s, each": three(DT * rate / size),
                "memory [MiB]": f"{found[f'memory_{size}']:.0f}",
            }
            for size, rate in rates(found).items()
        ]
    )


def conclusions(run: Experiment) -> str:
    """Return the sentences about one measurement."""
    found = run.readings[GROUP]
    rate, build = rates(found), column(found, "build")
    few, *_, many = rate
    best = max(rate, key=rate.__getitem__)
    gain = rate[best] / rate[few]
    lines = [
        f"All environments together make {three(rate[few])} steps per second with {few} and "
        f"{three(rate[best])} with {best} environments, {three(gain)} times as many. "
        + (
            f"With {many} there are fewer again: {three(rate[many])}."
            if best != many
            else "No smaller number of environments makes more."
        ),
        f"One environment advances by {three(DT * rate[few] / few)} s in a second of the machine "
        f"with {few} environment, and by {three(DT * rate[many] / many)} s with {many}.",
        f"Building took from {build.min():.1f} to {build.max():.1f} s. The times of the steps do "
        "not contain it.",
    ]
    spread = (column(found, "slowest") / column(found, "fastest")).max()
    lines.append(
        f"The slowest repeat of a size took up to {three(spread)} times as long as its fastest. "
        + (
            "Another program probably ran at the same time: measure again on a quiet machine."
            if spread >= DISTURBED
            else "The medians are repeatable to about that factor."
        )
    )
    return bullets(lines)


def fitted(run: Experiment) -> Model:
    """Return the model of the time of a step, fitted on the sizes of `FITTED`."""
    found = run.readings[GROUP]
    return fit(FITTED, [found[f"step_{size}"] for size in FITTED])


def model_table(run: Experiment) -> str:
    """Return measured time and model of each number of environments."""
    found, model = run.readings[GROUP], fitted(run)
    rows = []
    for size in sizes_of(found):
        measured, expected = found[f"step_{size}"], float(model.step_time(size))
        rows.append(
            {
                "environments": f"{size}",
                "measured [ms]": ms(measured),
                "model [ms]": ms(expected),
                "measured / model": f"{measured / expected:.2f}",
                "the model": "is fitted here" if size in FITTED else "predicts",
            }
        )
    return tables.markdown(rows)


def model_sentences(run: Experiment) -> str:
    """Return both constants, and where the model predicts well."""
    found, model = run.readings[GROUP], fitted(run)
    if model.fixed <= 0 or model.each <= 0:
        return (
            f"The fit gives {ms(model.fixed)} ms + B · {three(1e6 * model.each)} µs. A negative "
            "constant means that these times do not have the form of the model."
        )
    ratio = {s: found[f"step_{s}"] / float(model.step_time(s)) for s in sizes_of(found)}
    near = [s for s, r in ratio.items() if s not in FITTED and abs(r - 1) <= NEAR]
    far = [s for s, r in ratio.items() if s not in FITTED and abs(r - 1) > NEAR]
    lines = [
        f"A step takes {ms(model.fixed)} ms and, for each environment, "
        f"{three(1e6 * model.each)} µs more.",
        f"With these constants no number of environments makes more than {three(1 / model.each)} "
        f"steps per second, and {three(model.half)} environments make half of that.",
    ]
    if near:
        lines.append(
            f"The prediction for {listed([str(s) for s in near])} environments is within "
            f"{100 * NEAR:.0f} % of the measurement."
        )
    if far:
        wrong = listed([f"{ratio[s]:.2f} times the prediction with {s}" for s in far])
        lines.append(f"The model fails elsewhere: the measured time is {wrong} environments.")
    return bullets(lines)


def content_table(run: Experiment) -> str:
    """Return the time of a step with a sphere and with the robot."""
    found = run.readings[GROUP]
    rows = []
    for scene, name in {"plane and sphere": "sphere_", "plane and robot": ""}.items():
        few, many = found[f"step_{name}1"], found[f"step_{name}256"]
        rows.append(
            {
                "scene": scene,
                "1 environment [ms]": ms(few),
                "256 environments [ms]": ms(many),
                "added by each environment [µs]": three(1e6 * (many - few) / 255),
            }
        )
    return tables.markdown(rows)


def content_sentence(run: Experiment) -> str:
    """Say whether the content of the scene matters with one environment, and with many."""
    found = run.readings[GROUP]
    few, many = (found[f"step_{n}"] / found[f"step_sphere_{n}"] for n in (1, 256))
    return (
        f"With one environment, a step with the robot takes {three(few)} times as long as one with "
        f"the sphere; with 256 environments, {three(many)} times."
        + (
            " So the fixed part hardly depends on what the scene contains, and the other part does."
            if few < 1.5 < many
            else " In this run that does not separate the two parts."
        )
    )


def cache_sentence(run: Experiment) -> str:
    """Compare one scene of 1024 environments with four of 256."""
    found = run.readings[GROUP]
    one, four = found["step_1024"], found["step_four_scenes"]
    grown = (found["memory_1024"] - found["memory_256"]) / (1024 - 256)
    return (
        f"One scene of 1024 environments needs {ms(one)} ms for a step of all. Four scenes of 256, "
        f"stepped in turn, need {ms(four)} ms for the same number of environments, "
        f"{three(one / four)} times less. "
        if four < one
        else f"One scene of 1024 environments needs {ms(one)} ms for a step of all, and four scenes "
        f"of 256 need {ms(four)} ms. On this machine, smaller scenes are not faster. "
    ) + f"Each environment takes {three(grown)} MiB of memory."
