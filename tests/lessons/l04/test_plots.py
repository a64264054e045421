"""Figures of L04 draw the recorded arrays, with the labels and units of what they show."""

import io

import numpy as np
import pytest
from axes import curves, legend
from matplotlib.figure import Figure
from PIL import Image

from robo_genesis.lessons.l04 import plots, study_plots
from robo_genesis.lessons.l04.metrics import SETTLING_BAND

JOINT, K = "joint4", 3


@pytest.fixture
def ax():
    return Figure().subplots()


@pytest.fixture
def three(traces):
    return {name: traces[name] for name in ("G1", "G2", "G3")}


def assert_drawn(ax, arrays):
    """The axes have these curves, (x, y) by label."""
    found = curves(ax)
    for label, array in arrays.items():
        assert np.array_equal(found[label], np.column_stack(array))


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
            assert drawn.get_title("left") == heading.format(joint)
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


def test_a_strip_names_the_times_in_their_order_and_is_light(frames):
    figure = Figure(figsize=(7, 3))
    axes = figure.subplots(1, 2)
    study_plots.film_strip(axes, {20: frames["final"], 0: frames["initial"]}, dt=0.01)
    assert [ax.get_title() for ax in axes] == ["t = 0.00 s", "t = 0.20 s"]
    with Image.open(io.BytesIO(study_plots.jpeg(figure))) as picture:
        assert picture.format == "JPEG"
        assert picture.size == (630, 270)
