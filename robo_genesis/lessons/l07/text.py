"""Tables of L07, each a function of the experiment."""

from collections.abc import Iterator

from robo_genesis.core import tables
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.text import decimal
from robo_genesis.lessons.l07 import rungs, spec

MEASURES = False


@tables.as_table
def ladder_table(run: Experiment) -> Iterator[dict[str, str]]:
    """Return which rungs each scene passes."""
    for name in rungs.scenes(run):
        words = {
            rung: "passes" if good else "**fails**"
            for rung, good in rungs.verdicts(run, name).items()
        }
        yield {"scene": spec.LETTERS[name], **words}


DECIDES = {
    "built": ("ball above the bowl's foot [mm]", "ball", 1000.0, 1),
    "stable": ("support error [mm]", "support", 1000.0, 3),
    "seen": ("pixels", "pixels", 1.0, 0),
    "reachable": ("touching postures", "touches", 1.0, 0),
    "graspable": ("rise, share of the hand's", "rise", 1.0, 2),
}
"""By rung: head, quantity, factor and digits of the value that decides in this lesson."""


@tables.as_table
def value_table(run: Experiment) -> Iterator[dict[str, str]]:
    """Return of each scene the value of each rung that differs between the scenes."""
    for name in rungs.scenes(run):
        found = rungs.measured(run, name)
        yield {"scene": spec.LETTERS[name]} | {
            head: decimal(factor * found[rung][quantity], digits)
            for rung, (head, quantity, factor, digits) in DECIDES.items()
        }


@tables.as_table
def grip_table(run: Experiment) -> Iterator[dict[str, str]]:
    """Return what the lifts of the page's objects measured."""
    for name in (*rungs.scenes(run), *spec.FURTHER):
        if name in spec.SHOWN_LIFTS:
            m, contacts = run.metrics[name], run.readings["contacts"]
            yield {
                "object": spec.SHOWN_LIFTS[name],
                "steps in contact before closing": f"{contacts[f'{name}_descending']:g}",
                "pushed [mm]": decimal(1000 * m.pushed, 1),
                "rise [mm]": decimal(1000 * m.rise, 1),
                "hand's rise [mm]": decimal(1000 * m.hand_rise, 1),
            }
