"""The replay of recorded runs as text and markup: a table of all samples, and the controls."""

import json
from html import escape
from typing import Any

from robo_genesis.core import tables
from robo_genesis.core.channels import Runs
from robo_genesis.core.palette import css_name, marks_of
from robo_genesis.core.text import time_digits
from robo_genesis.lessons.registry import COURSE_MARKS

SPEEDS = {"1": "real time", "0.25": "1/4", "0.1": "1/10"}
SLOW = "0.1"
"""The initial speed: most of the motion happens in a small part of the window."""

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


def markup(name: str, runs: Runs, script: str, viewer: str, weight: int) -> str:
    """Return the controls as HTML, hidden until `_static/replay.js` fills and shows them.

    Args:
        name: of the replay, unique on the site.
        runs: the runs to play.
        script: address of the script that holds the model.
        viewer: address of the viewer's script.
        weight: of both, compressed [kB].
    """
    name, thing = escape(name), escape(runs.view.thing)
    speeds = "".join(
        f'<option value="{value}"{" selected" * (value == SLOW)}>{text}</option>'
        for value, text in SPEEDS.items()
    )
    terms = ["time", *(c.name for c in runs.channels), *(level.name for level in runs.levels)]
    return (
        f'<div class="replay" hidden {_data(name, runs)} data-model="{escape(script)}" '
        f'data-viewer="{escape(viewer)}">'
        f"<fieldset><legend>Run of {escape(runs.subject)}</legend>{_cases(name, runs)}</fieldset>"
        '<div class="stage"><p class="shown" hidden></p></div>'
        '<p class="in-space"><button type="button" class="show" aria-expanded="false">'
        f'Show the {thing} in 3D</button> <span class="weight">{weight} kB, loaded only if you ask '
        "for it</span>"
        ' <span role="status"></span></p>'
        f'<div class="controls"><button type="button" class="play">Play</button>'
        f'<p><label for="{name}-time">Time</label><input type="range" id="{name}-time" min="0" '
        f'max="{len(runs.t) - 1}" step="1" value="0"></p>'
        f'<p><label for="{name}-speed">Speed</label><select id="{name}-speed">{speeds}</select></p>'
        f"</div><dl>{''.join(map(_term, terms))}</dl>"
        f'<div class="plots">{PLOT * len(runs.channels)}</div>'
        f'<p class="legend">{escape(_legend(runs))}</p></div>'
    )


def _data(name: str, runs: Runs) -> str:
    """Return the data of all cases for the script as attributes, the channels as JSON."""
    view = runs.view
    channels = [{"name": c.name, "unit": c.unit, "digits": c.digits} for c in runs.channels]
    words = {
        "name": name,
        "subject": runs.subject,
        "channels": _json(channels),
        "time-digits": str(time_digits(next(iter(runs.traces.values())).dt)),
        "thing": view.thing,
        "alt": view.alt,
        "orbit": view.orbit,
        "target": view.target,
    }
    return " ".join(f'data-{key}="{escape(text)}"' for key, text in words.items())


def _cases(name: str, runs: Runs) -> str:
    """Return one radio button per case, with its mark and the levels of its run as JSON."""
    marks = marks_of(list(runs.traces), COURSE_MARKS)
    return "".join(
        f'<span><input type="radio" name="{name}" id="{name}-{case}" value="{case}" '
        f'data-mark="{css_name(mark)}" data-levels="{escape(_levels(runs, case))}"'
        f"{' checked' * (number == 0)}>"
        f'<label for="{name}-{case}" class="case-mark {css_name(mark)}">{case}</label></span>'
        for number, (case, mark) in enumerate(marks.items())
    )


def _levels(runs: Runs, case: str) -> str:
    return _json(
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


def _json(content: Any) -> str:
    return json.dumps(content, separators=(",", ":"), ensure_ascii=False, allow_nan=False)


def _term(name: str) -> str:
    """Return a line of the readout; it has its final height before the script fills it."""
    return f"<div><dt>{escape(name)}</dt><dd>&nbsp;</dd></div>"


def _legend(runs: Runs) -> str:
    """Return the meaning of the lines of the plots."""
    bold = "Bold: the chosen run; each run has the line beside its name."
    levels = (level.legend for level in runs.levels)
    parts = (bold * (len(runs.traces) > 1), *levels, "Drag in a plot to move through time.")
    return " ".join(filter(None, parts))
