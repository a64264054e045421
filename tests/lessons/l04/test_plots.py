"""Figures of L04 draw the recorded arrays, with the labels and units of what they show."""

from dataclasses import replace

import numpy as np
import pytest
from axes import curves
from matplotlib.figure import Figure

from robo_genesis.lessons.l04 import plots
from robo_genesis.lessons.l04.metrics import SETTLING_BAND
from robo_genesis.lessons.l04.study_spec import EXAMPLE

JOINT, K = "joint4", 3


@pytest.fixture
def ax():
    return Figure().subplots()


@pytest.fixture
def three(traces):
    return {name: traces[name] for name in ("G1", "G2", "G3")}


def assert_drawn(ax, arrays, until=np.inf):
    """The axes have these curves, (x, y) by label, up to a time [s]."""
    found = curves(ax)
    for label, array in arrays.items():
        points = np.column_stack(array)
        assert np.array_equal(found[label], points[points[:, 0] <= until])


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
    plots.response(axes, three, joints, joint, 0.4)
    for ax, (draw, heading, ylabel, array), unit in zip(axes, PANELS, units, strict=True):
        alone = Figure().subplots()
        assert draw(alone, three, joints, joint, 0.4) is alone
        for drawn in (ax, alone):
            assert drawn.get_title("left") == heading.format(joint)
            assert drawn.get_ylabel() == ylabel.format(unit)
            assert drawn.get_xlim()[1] == 0.4
            assert_drawn(drawn, {name: array(trace, k) for name, trace in three.items()}, 0.4)
    assert axes[-1].get_xlabel() == "time [s]"


def test_measured_lines_are_solid_and_named_beside_their_curves(three, joints):
    axes = Figure().subplots(3, 1)
    plots.response(axes, three, joints, JOINT, 0.4, plots.GAINS_LABELS)
    for ax in axes:
        lines = {line.get_label(): line for line in ax.get_lines()}
        named = {text.get_text(): text for text in ax.texts}
        for name in three:
            assert lines[name].get_linestyle() == "-"
            assert named[name].get_color() == lines[name].get_color()
            assert list(named[name].xy) in np.column_stack(lines[name].get_data()).tolist()
        assert ax.get_legend() is None


def test_position_draws_target_and_settling_band(ax, three, joints):
    plots.position(ax, three, joints, JOINT, 0.4)
    target = three["G1"].target[0, K]
    assert heights(ax) == [target]
    (band,) = ax.patches
    edges = band.get_extents().transformed(ax.transData.inverted())
    assert (edges.y0, edges.y1) == pytest.approx((target - SETTLING_BAND, target + SETTLING_BAND))
    assert [text.get_text() for text in ax.texts] == ["target ±0.01 rad"]


@pytest.mark.parametrize(("joint", "limit"), [(JOINT, 87), ("joint5", 12), ("finger_joint1", 100)])
def test_control_force_draws_both_limits_of_its_joint(ax, three, joints, joint, limit):
    plots.control_force(ax, three, joints, joint, 0.4)
    assert heights(ax) == [-limit, limit]
    assert [text.get_text() for text in ax.texts] == ["limit, read back"]


@pytest.mark.parametrize("n", [2, 4])
def test_response_needs_three_axes(three, joints, n):
    with pytest.raises(ValueError, match="argument"):
        plots.response(Figure().subplots(n, 1), three, joints, JOINT, 0.4)


def test_two_forces_are_labelled_with_their_getters(ax, traces, joints):
    trace = traces["G1"]
    plots.two_forces(ax, trace, joints, JOINT)
    assert_drawn(ax, {
        "get_dofs_control_force": (trace.t_step, trace.control_force[:, K]),
        "get_dofs_force": (trace.t_step, trace.internal_force[:, K]),
    })  # fmt: skip
    assert heights(ax) == [-87, 87]
    assert ax.get_ylabel() == "force [N·m]"
    names = ["limit, read back", "get_dofs_control_force", "get_dofs_force"]
    assert [text.get_text() for text in ax.texts] == names


def test_assigned_and_commanded_name_their_calls(ax, traces, joints):
    assigned, commanded = traces["G3"], traces["G1"]
    plots.assigned_and_commanded(ax, assigned, commanded, joints, JOINT)
    assert_drawn(ax, {
        "assigned: set_dofs_position": (assigned.t[::4], assigned.q[::4, K]),
        "commanded: control_dofs_position": (commanded.t, commanded.q[:, K]),
    })  # fmt: skip
    assert heights(ax) == [commanded.target[0, K]]


def test_the_metrics_are_drawn_on_the_curve_that_has_them(study_runs):
    (ax,) = plots.defined(study_runs).axes
    found = " ".join(" ".join(text.get_text() for text in ax.texts).split())
    m = study_runs.metrics[EXAMPLE]
    assert f"rise time, 90 % of the step: {m.rise_time:.2f} s" in found
    assert f"settling time, in the band from here on: {m.settling_time:.2f} s" in found
    assert f"overshoot: {m.overshoot:.4f} rad" in found
    assert f"final error: {m.final_error:.4f} rad" in found
    never = replace(m, rise_time=None, settling_time=None)
    run = replace(study_runs, accepted=dict(study_runs.metrics) | {EXAMPLE: never})
    texts = [text.get_text() for text in plots.defined(run).axes[0].texts]
    assert not any("time" in text for text in texts)
