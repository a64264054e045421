import subprocess
import sys

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


def lines(ax):
    return {line.get_label(): line for line in ax.get_lines()}


def title(ax):
    return "".join(ax.get_title(loc) for loc in ("left", "center", "right"))


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def assert_drawn(line, x, y):
    assert (np.asarray(line.get_xdata()) == x).all()
    assert (np.asarray(line.get_ydata()) == y).all()


def heights(ax):
    return sorted(
        float(line.get_ydata()[0])
        for line in ax.get_lines()
        if list(line.get_xdata()) == [0, 1] and len(set(line.get_ydata())) == 1
    )


def test_position_draws_every_state(ax, three, joints):
    assert plots.position(ax, three, joints, JOINT) is ax
    for name, trace in three.items():
        assert_drawn(lines(ax)[name], trace.t, trace.q[:, K])
    assert title(ax) == "Position of joint4"
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("time [s]", "q [rad]")


def test_position_draws_target_and_settling_band(ax, three, joints):
    plots.position(ax, three, joints, JOINT)
    target = three["G1"].target[0, K]
    assert heights(ax) == [target]
    (band,) = ax.patches
    edges = band.get_extents().transformed(ax.transData.inverted())
    assert (edges.y0, edges.y1) == pytest.approx((target - SETTLING_BAND, target + SETTLING_BAND))
    labels = legend(ax)
    assert labels[0].endswith("band ±0.01 rad")
    assert labels[1:] == ["target", "G1", "G2", "G3"]


def test_velocity_draws_the_samples_after_each_step(ax, three, joints):
    plots.velocity(ax, three, joints, JOINT)
    for name, trace in three.items():
        assert_drawn(lines(ax)[name], trace.t[1:], trace.qd[:, K])
    assert (title(ax), ax.get_ylabel()) == ("Velocity of joint4", "q̇ [rad/s]")
    assert legend(ax) == ["G1", "G2", "G3"]


def test_control_force_draws_samples_and_both_limits(ax, three, joints):
    plots.control_force(ax, three, joints, JOINT)
    for name, trace in three.items():
        assert_drawn(lines(ax)[name], trace.t[1:], trace.control_force[:, K])
    assert heights(ax) == [-87, 87]
    assert title(ax) == "Control force of joint4"
    assert ax.get_ylabel() == "control force [N·m]"
    assert legend(ax) == ["G1", "G2", "G3", "limit, read back"]


@pytest.mark.parametrize(
    ("draw", "ylabel"),
    [
        (plots.position, "q [m]"),
        (plots.velocity, "q̇ [m/s]"),
        (plots.control_force, "control force [N]"),
    ],
)
def test_units_follow_the_joint(ax, three, joints, draw, ylabel):
    draw(ax, three, joints, "finger_joint2")
    assert ax.get_ylabel() == ylabel
    assert_drawn(lines(ax)["G1"], *{
        plots.position: (three["G1"].t, three["G1"].q[:, 8]),
        plots.velocity: (three["G1"].t_step, three["G1"].qd[:, 8]),
        plots.control_force: (three["G1"].t_step, three["G1"].control_force[:, 8]),
    }[draw])  # fmt: skip


@pytest.mark.parametrize(("joint", "limit"), [("joint5", 12), ("finger_joint1", 100)])
def test_limits_are_the_joints_own(ax, three, joints, joint, limit):
    plots.control_force(ax, three, joints, joint)
    assert heights(ax) == [-limit, limit]


def test_response_draws_three_axes(three, joints):
    axes = Figure().subplots(3, 1)
    plots.response(axes, three, joints, JOINT)
    assert [title(ax).split()[0] for ax in axes] == ["Position", "Velocity", "Control"]


@pytest.mark.parametrize("n", [2, 4])
def test_response_needs_three_axes(three, joints, n):
    with pytest.raises(ValueError, match="argument"):
        plots.response(Figure().subplots(n, 1), three, joints, JOINT)


def test_two_forces_are_labelled_with_their_getters(ax, traces, joints):
    trace = traces["G1"]
    plots.two_forces(ax, trace, joints, JOINT)
    drawn = lines(ax)
    assert_drawn(drawn["get_dofs_control_force"], trace.t_step, trace.control_force[:, K])
    assert_drawn(drawn["get_dofs_force"], trace.t_step, trace.internal_force[:, K])
    assert heights(ax) == [-87, 87]
    assert ax.get_ylabel() == "force [N·m]"
    assert legend(ax) == ["get_dofs_control_force", "get_dofs_force", "limit, read back"]


def test_assigned_and_commanded_name_their_calls(ax, traces, joints):
    assigned, commanded = traces["G3"], traces["G1"]
    plots.assigned_and_commanded(ax, assigned, commanded, joints, JOINT)
    drawn = lines(ax)
    assert_drawn(drawn["state assigned: set_dofs_position"], assigned.t, assigned.q[:, K])
    assert_drawn(drawn["target commanded: control_dofs_position"], commanded.t, commanded.q[:, K])
    assert heights(ax) == [commanded.target[0, K]]


def test_frames_are_shown_as_they_are(frames):
    axes = Figure().subplots(1, 2)
    plotting.frames(axes, frames)
    for ax, (name, picture) in zip(axes, frames.items(), strict=True):
        assert title(ax) == f"Camera frame, {name}"
        assert (ax.get_images()[0].get_array() == picture).all()


def test_a_schematic_says_that_it_is_no_camera_frame(ax, traces):
    plotting.schematic(ax, traces["G1"], (-1, 0, 1))
    assert "not a camera frame" in title(ax)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x [m]", "z [m]")
    assert legend(ax) == ["before the first step", "after the last step"]


def test_a_schematic_draws_the_measured_links_at_both_ends(ax, traces):
    trace, parents = traces["G1"], (-1, 0, 1)
    plotting.schematic(ax, trace, parents)
    bones = [(when, [parents[link], link]) for when in (0, -1) for link in (1, 2)]
    for line, (when, ends) in zip(ax.get_lines(), bones, strict=True):
        assert_drawn(line, trace.link_pos[when, ends, 0], trace.link_pos[when, ends, 2])


def test_cases_differ_in_colour_and_in_dashes():
    named = [plotting.style(name) for name in ("G1", "G2", "G3")]
    assert len({look["color"] for look in named}) == 3
    assert len({str(look["linestyle"]) for look in named}) == 3
    assert plotting.style("another") == plotting.style("baseline")


def test_the_same_arrays_give_the_same_bytes(three, joints, draw_svg):
    assert draw_svg(three, joints) == draw_svg(three, joints)


def test_other_arrays_give_other_bytes(three, joints, draw_svg):
    assert draw_svg(three, joints) != draw_svg({**three, "G3": three["G1"]}, joints)


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
    for label, (x, y) in curves.items():
        assert_drawn(lines(ax)[label], x, y)
    assert legend(ax) == ["wrong", "right"]
    assert ax.get_ylabel() == "position [m]"
