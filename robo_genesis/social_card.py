"""The picture that a link to the site shows elsewhere: its name beside a measured response."""

import io
from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure

from robo_genesis import plots
from robo_genesis.lessons import Compared, Moving
from robo_genesis.played import read_runs

SIZE = (12.0, 6.3)
"""Inches at 100 dots an inch: the 1200 × 630 pixels that most services show whole."""


def card(folder: Path, compared: Compared | Moving) -> bytes:
    """Return the card as PNG.

    Args:
        folder: an accepted bundle, whose traces are drawn.
        compared: which of them, and what is followed; its first channel is drawn.

    Raises:
        BundleRefused: the bundle cannot be read.
    """
    runs = read_runs(folder, compared)
    stream = io.BytesIO()
    with plots.course_style():
        mpl.rcParams.update({"font.size": 15, "lines.linewidth": 3})
        figure = Figure(figsize=SIZE, dpi=100)
        words, drawn = figure.subplots(1, 2, width_ratios=(4, 5))
        words.set_axis_off()
        words.text(0, 0.72, "RoboGenesis", fontsize=40, fontweight="bold")
        words.text(0, 0.45, "Robot simulation,\nmeasured", fontsize=28)
        words.text(0, 0.12, "Every curve comes\nfrom a run of the engine.", fontsize=18)
        plots.first_channel(drawn, runs)
        figure.savefig(stream, format="png", metadata={"Software": None})
    return stream.getvalue()
