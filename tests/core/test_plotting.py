"""Figures draw the recorded arrays, with the labels and units of what they show."""

import io
import subprocess
import sys

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

from robo_genesis.core import plotting
from robo_genesis.lessons.l04 import plots
from robo_genesis.lessons.l04.metrics import SETTLING_BAND

JOINT, K = "joint4", 3


@pytest.fixture
def ax():
    return Figure().subplots()


@pytest.fixture
def three(traces):
    return {name: traces[name] for name in ("G1", "G2", "G3")}


def title(ax):
    return "".join(ax.get_title(loc) for loc in ("left", "center", "right"))


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def assert_drawn(ax, curves):
    """The axes have these curves, (x, y) by label."""
    lines = {line.get_label(): line for line in ax.get_lines()}
    for label, (x, y) in curves.items():
        assert (np.asarray(lines[label].get_xdata()) == x).all()
        assert (np.asarray(lines[label].get_ydata()) == y).all()


def heights(ax):
    """Heights of the lines across the axes."""
    return sorted(
        float(line.get_ydata()[0]) for line in ax.get_lines() if list(line.get_xdata()) == [0, 1]
    )


PANELS = [
    (plots.position, "Position of {}", "q [{}]", lambda run, k: (run.t, run.q[:, k])),
    (plots.velocity, "Velocity of {}", "q̇ [{}/s]", lambda run, k: (run.t_step, run.qd[:, k])),
    (plots.control_force, "Control force of {}", "control force [{}]",
     lambda run, k: (run.t_step, run.control_force[:, k])),
]  # fmt: skip


@pytest.mark.parametrize(
    ("joint", "k", "units"),
    [(JOINT, K, ("rad", "rad", "N·m")), ("finger_joint2", 8, ("m", "m", "N"))],
)
def test_a_response_draws_each_array_of_the_joint_with_its_unit(three, joints, joint, k, units):
    axes = Figure().subplots(3, 1)
    plots.response(axes, three, joints, joint)
    for ax, (draw, heading, ylabel, array), unit in zip(axes, PANELS, units, strict=True):
        alone = Figure().subplots()
        assert draw(alone, three, joints, joint) is alone
        for drawn in (ax, alone):
            assert title(drawn) == heading.format(joint)
            assert drawn.get_ylabel() == ylabel.format(unit)
            assert_drawn(drawn, {name: array(trace, k) for name, trace in three.items()})
    assert axes[-1].get_xlabel() == "time [s]"


def test_position_draws_target_and_settling_band(ax, three, joints):
    plots.position(ax, three, joints, JOINT)
    target = three["G1"].target[0, K]
    assert heights(ax) == [target]
    (band,) = ax.patches
    edges = band.get_extents().transformed(ax.transData.inverted())
    assert (edges.y0, edges.y1) == pytest.approx((target - SETTLING_BAND, target + SETTLING_BAND))
    assert legend(ax) == ["band ±0.01 rad", "target", "G1", "G2", "G3"]


@pytest.mark.parametrize(("joint", "limit"), [(JOINT, 87), ("joint5", 12), ("finger_joint1", 100)])
def test_control_force_draws_both_limits_of_its_joint(ax, three, joints, joint, limit):
    plots.control_force(ax, three, joints, joint)
    assert heights(ax) == [-limit, limit]
    assert legend(ax) == ["G1", "G2", "G3", "limit, read back"]


@pytest.mark.parametrize("n", [2, 4])
def test_response_needs_three_axes(three, joints, n):
    with pytest.raises(ValueError, match="argument"):
        plots.response(Figure().subplots(n, 1), three, joints, JOINT)


def test_two_forces_are_labelled_with_their_getters(ax, traces, joints):
    trace = traces["G1"]
    plots.two_forces(ax, trace, joints, JOINT)
    assert_drawn(ax, {
        "get_dofs_control_force": (trace.t_step, trace.control_force[:, K]),
        "get_dofs_force": (trace.t_step, trace.internal_force[:, K]),
    })  # fmt: skip
    assert heights(ax) == [-87, 87]
    assert ax.get_ylabel() == "force [N·m]"
    assert legend(ax) == ["get_dofs_control_force", "get_dofs_force", "limit, read back"]


def test_assigned_and_commanded_name_their_calls(ax, traces, joints):
    assigned, commanded = traces["G3"], traces["G1"]
    plots.assigned_and_commanded(ax, assigned, commanded, joints, JOINT)
    assert_drawn(ax, {
        "state assigned: set_dofs_position": (assigned.t, assigned.q[:, K]),
        "target commanded: control_dofs_position": (commanded.t, commanded.q[:, K]),
    })  # fmt: skip
    assert heights(ax) == [commanded.target[0, K]]


def test_frames_are_shown_as_they_are(frames):
    axes = Figure().subplots(1, 2)
    plotting.frames(axes, frames)
    for ax, (name, picture) in zip(axes, frames.items(), strict=True):
        assert title(ax) == f"Camera frame, {name}"
        assert (ax.get_images()[0].get_array() == picture).all()


def test_a_schematic_draws_the_measured_links_at_both_ends(ax, traces):
    trace, parents = traces["G1"], (-1, 0, 1)
    plotting.schematic(ax, trace, parents)
    assert "not a camera frame" in title(ax)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x [m]", "z [m]")
    assert legend(ax) == ["before the first step", "after the last step"]
    bones = [trace.link_pos[when, [parents[link], link]] for when in (0, -1) for link in (1, 2)]
    for line, bone in zip(ax.get_lines(), bones, strict=True):
        assert np.array_equal(line.get_xydata(), bone[:, [0, 2]])


def test_equal_arrays_and_no_others_give_the_same_bytes(three, joints, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib_inline.backend_inline", None)

    def draw(traces):
        figure, stream = Figure(), io.BytesIO()
        plots.response(figure.subplots(3, 1), traces, joints, JOINT)
        figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None})
        return stream.getvalue()

    with mpl.rc_context():
        plotting.use_course_style()
        assert draw(three) == draw(three) != draw({**three, "G3": three["G1"]})


def test_the_style_starts_no_shell_outside_a_notebook():
    code = (
        "from robo_genesis.core import plotting; plotting.use_course_style()\n"
        "from IPython.core.interactiveshell import InteractiveShell\n"
        "assert not InteractiveShell.initialized()"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_a_failure_draws_each_of_its_curves(ax):
    t = np.arange(3) * 0.01
    curves = {"wrong": (t, t + 1), "right": (t, t + 2)}
    assert plotting.failure(ax, curves, "", "m") is ax
    assert_drawn(ax, curves)
    assert legend(ax) == ["wrong", "right"]
    assert ax.get_ylabel() == "position [m]"
