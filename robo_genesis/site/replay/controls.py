"""The replay of recorded runs as text and markup: a table of all samples, and the controls."""

import json
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import Any

from robo_genesis.core import tables
from robo_genesis.core.channels import Runs
from robo_genesis.core.markup import filled
from robo_genesis.core.palette import css_name, marks_of
from robo_genesis.core.text import time_digits
from robo_genesis.site.figures.case_labels import MARKS

from .scenery import Scenery

PANEL = Path(__file__).with_name("panel.html")  # The template of the controls

# The speeds of a replay as shares of real time, in words. A run plays at the slowest
# one at which it ends soon: much happens in small parts of it, and feedback waits for
# its end.
SPEEDS = {0.1: "1/10", 0.25: "1/4", 1: "real time"}
LONGEST = 8  # [s]


def samples(runs: Runs) -> str:
    """Return every sample of every case as a Markdown table, in the order of time.

    The columns of a case are its channels, in the order that the script expects.
    """
    columns = {"t [s]": runs.t} | {
        f"{case} {channel.head} [{channel.unit}]": channel.values[case]
        for case in runs.traces
        for channel in runs.channels
    }
    rows = zip(*(values.tolist() for values in columns.values()), strict=True)
    return tables.markdown([dict(zip(columns, row, strict=True)) for row in rows])


def opening(kind: str, words: Mapping[str, str]) -> str:
    """Return the start of a replay or an explorer as HTML, with the data for its script."""
    data = " ".join(f'data-{key}="{escape(text)}"' for key, text in words.items())
    return f'<div class="{kind}" {data}>'


def over_the_picture(button: str) -> str:
    """Return what is on top of the still picture: the state that it shows, and a button."""
    return filled(PANEL.with_name("over_the_picture.html"), button=button)


def alt(runs: Runs) -> str:
    """Return the alternative text of the picture of the model."""
    case = next(iter(runs.traces))
    return f"The {runs.replay.thing} at the start of {case}, drawn from the recorded poses."


def caption(runs: Runs, around: Scenery) -> str:
    """Return the caption of the model, with the meaning of what it shows besides the bodies."""
    parts = ["The poses are recorded."]
    if around.axis:
        parts.append(f"Yellow rod: the axis of {runs.subject}.")
    if around.target:
        parts.append(
            f"Blue and translucent: {runs.subject} at its target, other joints at rest."
        )
    if around.followed is not None:
        parts.append(f"The view follows the {runs.replay.thing} horizontally.")
    return " ".join(parts)


def panel(name: str, runs: Runs, weight: int, veiled: bool = False) -> str:
    """Return the controls and the end of a replay as HTML; the script fills and shows them.

    Args:
        name: of the replay.
        runs: the runs to play.
        weight: of what loads with the first Play, compressed [kB].
        veiled: whether a sentence is in their place until the question has an answer.
    """
    marks = marks_of(list(runs.traces), MARKS)
    until = runs.replay.until or float(runs.t[-1])
    return filled(
        PANEL,
        name=name,
        runs=runs,
        weight=weight,
        veiled=veiled,
        until=until,
        speeds=SPEEDS,
        speed=next((speed for speed in SPEEDS if until <= LONGEST * speed), 1),
        marks={case: css_name(mark) for case, mark in marks.items()},
        levels={case: as_json(levels(runs, case)) for case in runs.traces},
    )


def data(runs: Runs) -> dict[str, str]:
    """Return the data of all cases for `_static/replay.js`, the channels as JSON."""
    names = ("name", "unit", "digits", "top")
    channels = [{name: getattr(one, name) for name in names} for one in runs.channels]
    return {
        "subject": runs.subject,
        "channels": as_json(channels),
        "time-digits": str(time_digits(runs.first.dt)),
        "thing": runs.replay.thing,
        "alt": runs.replay.view
        or f"The {runs.replay.thing} in 3D at the sample that is shown.",
    }


def levels(runs: Runs, case: str) -> list[dict[str, Any]]:
    """Return the levels of a run for the script."""
    return [
        {
            "channel": level.channel,
            "mark": css_name(level.mark),
            "values": [float(f"{value:.6g}") for value in level.values[case]],
            "text": level.texts[case],
        }
        for level in runs.levels
    ]


def as_json(content: Any) -> str:
    """Return content as JSON without spaces."""
    return json.dumps(
        content, separators=(",", ":"), ensure_ascii=False, allow_nan=False
    )
