"""Tables and sentences about a box that lands, each a function of the experiment."""

from robo_genesis.core import tables
from robo_genesis.lessons.experiment import Experiment


def metric_table(run: Experiment) -> str:
    """Return the metrics of the run."""
    return tables.six_digits(run.metrics)


CLAIMS: dict[str, str] = {
    "structure": "The scene has two entities, and the box has the expected links and DOFs.",
    "times": "The record has a state for t = 0 and one for each outer step.",
    "lands": "At the end the underside of the box is at the ground, and the box is at rest.",
    "posture": "The pictures of both ends show the box at two heights.",
}
"""What each named check of the pages requires, shown where it passed."""
