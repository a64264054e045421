"""The replay of recorded runs as text and markup: a table of samples, what moves, the controls."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from robo_genesis import tables
from robo_genesis.evidence.bundle import Metric
from robo_genesis.metrics import format_value
from robo_genesis.palette import css_name
from robo_genesis.robot_model import JointMap
from robo_genesis.trace import Trace

SPEEDS = {"1": "real time", "0.25": "1/4", "0.1": "1/10"}
SLOW = "0.1"
"""The speed at which a replay opens: most happens in the first tenth of the window."""


CREDIT = (
    "Franka Emika Panda model of MuJoCo Menagerie, Apache-2.0, from franka_description, "
    "© Franka Robotics GmbH; decimated and converted"
)
"""Of the shape that is replayed."""


@dataclass(frozen=True, slots=True)
class Replay:
    """Runs of one bundle that are replayed for one joint; `name` is unique on the site."""

    name: str
    traces: Mapping[str, Trace]
    joints: JointMap
    joint: str
    links: Sequence[str]

    @property
    def units(self) -> tuple[str, str]:
        """Unit of position and of effort."""
        k = self.joints.entry(self.joint)
        return self.joints.position_units[k], self.joints.effort_units[k]


def samples(replay: Replay) -> str:
    """Return every sample of every case as a Markdown table, the start of the runs first.

    The first row is the state before the first step: its control force is what the controller
    asks for once the target has been set.
    """
    k = replay.joints.entry(replay.joint)
    position, effort = replay.units
    columns = {"t [s]": next(iter(replay.traces.values())).t}
    for case, trace in replay.traces.items():
        columns |= {
            f"{case} q [{position}]": trace.q[:, k],
            f"{case} q̇ [{position}/s]": np.append(trace.start_qd[k], trace.qd[:, k]),
            f"{case} force [{effort}]": np.append(
                trace.start_control_force[k], trace.control_force[:, k]
            ),
        }
    rows = zip(*(values.tolist() for values in columns.values()), strict=True)
    return tables.markdown([dict(zip(columns, row, strict=True)) for row in rows])


def moving(replay: Replay, metrics: Mapping[str, Mapping[str, Metric]]) -> dict[str, str]:
    """Say for each case, as Markdown, what a viewer would see move, and how it goes."""
    k = replay.joints.entry(replay.joint)
    unit = replay.units[0]
    said = {}
    for case, trace in replay.traces.items():
        far = np.linalg.norm(trace.link_pos - trace.link_pos[0], axis=2).max(axis=0)
        value = {name: format_value(m.value, m.unit) for name, m in metrics[case].items()}
        said[case] = (
            f"**{case}**: `{replay.joint}` starts at {_signed(trace.q[0, k])} {unit} and is told "
            f"to go to {_signed(trace.target[0, k])} {unit}. The link "
            f"`{replay.links[far.argmax()]}` moves farthest, by up to {100 * far.max():.1f} cm. "
            f"Rise time {value['rise_time']}, overshoot {value['overshoot']}, final error "
            f"{value['final_error']}; at the force limit: {value['saturation_samples']}."
        )
    return said


def _signed(value: float) -> str:
    return f"{value:.4f}".replace("-", "−")


def markup(replay: Replay, script: str, viewer: str, weight: int) -> str:
    """Return the controls as HTML: hidden until `_static/replay.js` fills and shows them.

    Args:
        replay: what is played.
        script: address of the script that holds the model.
        viewer: address of the viewer's script.
        weight: of both, compressed [kB].
    """
    name, steps = escape(replay.name), next(iter(replay.traces.values())).steps
    speeds = "".join(
        f'<option value="{value}"{" selected" * (value == SLOW)}>{text}</option>'
        for value, text in SPEEDS.items()
    )
    return (
        f'<div class="replay" hidden data-model="{escape(script)}" data-viewer="{escape(viewer)}" '
        f'data-joint="{escape(replay.joint)}" data-name="{name}">'
        f"<fieldset><legend>Run of {escape(replay.joint)}</legend>{_cases(replay)}</fieldset>"
        '<div class="stage"><p class="shown" hidden></p></div>'
        '<p class="in-space"><button type="button" class="show" aria-expanded="false">'
        f'Show the robot in 3D</button> <span class="weight">{weight} kB, loaded only if you ask '
        "for it</span>"
        ' <span role="status"></span></p>'
        f'<div class="controls"><button type="button" class="play">Play</button>'
        f'<p><label for="{name}-time">Time</label><input type="range" id="{name}-time" min="0" '
        f'max="{steps}" step="1" value="0"></p>'
        f'<p><label for="{name}-speed">Speed</label><select id="{name}-speed">{speeds}</select></p>'
        '</div><dl></dl><div class="plots"></div>'
        '<p class="legend">Bold: the chosen run; each run has the line beside its name. '
        "Dotted: the target. Short dashes, at the edges of the control force: its limits. Drag in "
        "a plot to move through time.</p></div>"
    )


def _cases(replay: Replay) -> str:
    """Return one radio button a case; each carries the target and limit of its run."""
    k, name = replay.joints.entry(replay.joint), escape(replay.name)
    position, effort = replay.units
    return "".join(
        f'<span><input type="radio" name="{name}" id="{name}-{case}" value="{case}" '
        f'data-target="{trace.target[0, k]:.6g}" data-limit="{trace.effort_limit[k]:.6g}" '
        f'data-position="{position}" data-effort="{effort}"{" checked" * (number == 0)}>'
        f'<label for="{name}-{case}" class="case-mark {css_name(case)}">{case}</label></span>'
        for number, (case, trace) in enumerate(replay.traces.items())
    )
