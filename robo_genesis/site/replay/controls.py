"""The replay of recorded runs as text and markup: a table of all samples, and the controls."""

import json
from collections.abc import Mapping
from html import escape
from typing import TYPE_CHECKING, Any

from robo_genesis.core import tables
from robo_genesis.core.channels import Runs
from robo_genesis.core.palette import css_name, marks_of
from robo_genesis.core.text import time_digits
from robo_genesis.site.figures.case_labels import MARKS

if TYPE_CHECKING:
    from robo_genesis.site.replay.scenery import Camera, Scenery  # loads slowly

SPEEDS = {"1": "real time", "0.25": "1/4", "0.1": "1/10"}
SLOW, SLOW_FOR_LONG = "0.1", "0.25"
"""The initial speed: most of the motion happens in a small part of the window. The other is for
runs of more than `LONG` seconds."""

LONG = 3.0


PLOT = '<div class="plot"></div>'
"""The script draws a channel here; a page may have no picture that is not in the ledger."""


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


VEIL = (
    '<p class="veil">Answer the question above to see the run. '
    '<button type="button">Show me without an answer</button></p>'
    "<noscript>The replay needs JavaScript; the table below has all samples.</noscript>"
)
"""What is on top of a replay until its question has an answer; without the script it is hidden."""


def over_the_picture(button: str) -> str:
    """Return what is on top of the still picture: the state that it shows, and a button."""
    return (
        '<p class="shown">at the start</p>'
        f'<button type="button" class="play" hidden>{button}</button>'
    )


def alt(runs: Runs) -> str:
    """Return the alternative text of the picture of the model."""
    case = next(iter(runs.traces))
    return f"The {runs.replay.thing} at the start of {case}, drawn from the recorded poses."


def caption(runs: Runs, around: "Scenery") -> str:
    """Return the caption of the model, with the meaning of what it shows besides the bodies."""
    parts = [f"Recorded poses of the {runs.replay.thing}."]
    if around.axis:
        parts.append(f"Yellow rod: the axis of {runs.subject}.")
    if around.target:
        parts.append(f"Blue and translucent: {runs.subject} at its target, other joints at rest.")
    if around.followed is not None:
        parts.append(f"The view follows the {runs.replay.thing} horizontally.")
    return " ".join(parts)


def panel(name: str, runs: Runs, weight: int) -> str:
    """Return the controls and the end of a replay as HTML; the script fills and shows them.

    Args:
        name: of the replay.
        runs: the runs to play.
        weight: of what loads with the first Play, compressed [kB].
    """
    name = escape(name)
    speeds = options(SPEEDS, SLOW_FOR_LONG if runs.t[-1] > LONG else SLOW)
    terms = ["time", *(c.name for c in runs.channels), *(level.name for level in runs.levels)]
    return (
        '<div class="panel" hidden><p role="status">'
        f"Play loads the {escape(runs.replay.thing)} in 3D: {weight} kB.</p>"
        f"<fieldset><legend>Run of {escape(runs.subject)}</legend>{_cases(name, runs)}</fieldset>"
        f'<div class="controls">'
        f'<p><label for="{name}-time">Time</label><input type="range" id="{name}-time" min="0" '
        f'max="{len(runs.t) - 1}" step="1" value="0"></p>'
        f'<p><label for="{name}-speed">Speed</label><select id="{name}-speed">{speeds}</select></p>'
        f"</div>{_rest(runs)}<dl>{''.join(map(term, terms))}</dl>"
        f'<div class="plots">{PLOT * len(runs.channels)}</div>'
        f'<p class="legend">{escape(_legend(runs))}</p></div></div>'
    )


def _rest(runs: Runs) -> str:
    """Return the button that adds the rest of the runs to their motion, if there is a rest."""
    until = runs.replay.until
    if until is None or until >= runs.t[-1]:
        return ""
    state, words = round(until / runs.first.dt), f"Show the rest, to {runs.t[-1]:g} s"
    return f'<p><button type="button" class="rest" data-until="{state}">{words}</button></p>'


def data(runs: Runs, camera: "Camera") -> dict[str, str]:
    """Return the data of all cases for `_static/replay.js`, the channels as JSON."""
    names = ("name", "unit", "digits", "top")
    channels = [{name: getattr(channel, name) for name in names} for channel in runs.channels]
    return {
        "subject": runs.subject,
        "channels": as_json(channels),
        "time-digits": str(time_digits(runs.first.dt)),
        "thing": runs.replay.thing,
        "alt": runs.replay.view or f"The {runs.replay.thing} in 3D at the sample that is shown.",
        "orbit": camera.orbit,
        "target": camera.target,
    }


def _cases(name: str, runs: Runs) -> str:
    """Return one radio button per case, with its mark and the levels of its run as JSON."""
    marks = marks_of(list(runs.traces), MARKS)
    return "".join(
        f'<span><input type="radio" name="{name}" id="{name}-{number}" value="{case}" '
        f'data-mark="{css_name(mark)}" data-levels="{escape(_levels(runs, case))}"'
        f"{' checked' * (number == 0)}>"
        f'<label for="{name}-{number}" class="case-mark {css_name(mark)}">{case}</label></span>'
        for number, (case, mark) in enumerate(marks.items())
    )


def _levels(runs: Runs, case: str) -> str:
    return as_json(
        [
            {
                "channel": level.channel,
                "mark": css_name(level.mark),
                "values": [float(f"{value:.6g}") for value in level.values[case]],
                "text": level.texts[case],
            }
            for level in runs.levels
        ]
    )


def options(texts: Mapping[str, str], selected: str) -> str:
    """Return the options of a `select` by their value."""
    chosen = {selected: " selected"}
    return "".join(
        f'<option value="{escape(value)}"{chosen.get(value, "")}>{escape(text)}</option>'
        for value, text in texts.items()
    )


def as_json(content: Any) -> str:
    """Return content as JSON without spaces."""
    return json.dumps(content, separators=(",", ":"), ensure_ascii=False, allow_nan=False)


def term(name: str) -> str:
    """Return a line of the readout; it has its final height before the script fills it."""
    return f"<div><dt>{escape(name)}</dt><dd>&nbsp;</dd></div>"


def _legend(runs: Runs) -> str:
    """Return the meaning of the lines of the plots."""
    bold = "Bold: the chosen run; each curve has the colour of the line beside its run."
    levels = (level.legend for level in runs.levels)
    parts = (bold * (len(runs.traces) > 1), *levels, "Drag in a plot to move through time.")
    return " ".join(filter(None, parts))
