"""Figures of the studies around lesson L04: axes in, axes out; no numerics, no show()."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from robo_genesis.core.plotting import TARGET, look, style
from robo_genesis.core.scene import FloatArray

IDEAL = look("target", linestyle=(0, (1, 1.2)), linewidth=1.8)
ENGINE_STYLES = {
    "Genesis": look("G2", linestyle="-", marker="o"),
    "MuJoCo implicitfast": look("other", marker="s"),
    "MuJoCo Euler": look("further", marker="^"),
}
"""The curves are G2's; shapes tell the engines apart, too."""


def beside_ideal(
    axes: Sequence[Axes],
    t: FloatArray,
    measured: Mapping[str, FloatArray],
    ideal: Mapping[str, FloatArray],
    target: float,
    until: float,
) -> Sequence[Axes]:
    """Draw each case's measured position [rad] over the ideal joint's, one axes a case.

    All arrays (n+1,) over `t` [s], shown up to `until` [s].
    """
    for ax, (name, q) in zip(axes, measured.items(), strict=True):
        ax.axhline(target, label="target", **TARGET)
        ax.plot(t, ideal[name], label="ideal joint", **IDEAL)
        ax.plot(t, q, label="measured", **style(name))
        _finish(ax, name, "q of joint4 [rad]", until)
    return axes


def step_sizes(
    axes: Sequence[Axes],
    t: FloatArray,
    shares: Mapping[str, Mapping[str, FloatArray]],
    until: float,
) -> Sequence[Axes]:
    """Draw responses as shares of their step, one axes a case, one curve a label.

    A curve called `ideal joint` is drawn as such. All arrays (n+1,) over `t` [s].
    """
    for ax, (name, curves) in zip(axes, shares.items(), strict=True):
        ax.axhline(1.0, **TARGET)
        measured = iter((look("other"), style(name)))
        for label, curve in curves.items():
            ax.plot(t, curve, label=label, **(IDEAL if label == "ideal joint" else next(measured)))
        _finish(ax, name, "share of the step", until)
    return axes


def convergence(ax: Axes, overshoot: Mapping[str, Mapping[float, float]], declared: float) -> Axes:
    """Draw overshoot [rad] over the solver's step [s], one curve an engine, the finest at the left.

    `declared` [s] marks the step of the lesson's own runs.
    """
    for name, values in overshoot.items():
        ax.plot(list(values), list(values.values()), label=name, markersize=6,
                **ENGINE_STYLES[name])  # fmt: skip
    ax.axvline(declared, label="the lesson's step", **TARGET)
    ax.set_xscale("log")
    ax.set_ylim(bottom=0)
    ax.set_xlabel("solver step [s]")
    ax.set_ylabel("overshoot of G2 [rad]")
    ax.legend(fontsize="small", loc="upper left")
    return ax


def grid_maps(
    axes: Sequence[Axes],
    values: FloatArray,
    labels: Sequence[str],
    steps: Sequence[float],
    kp: Sequence[float],
    kv: Sequence[float],
) -> Sequence[Axes]:
    """Draw one value a point of a grid, one axes a step size, KP upwards and KV to the right.

    Args:
        axes: as many as steps.
        values: (points,) in the grid's order; one colour scale for all, from zero.
        labels: (points,), what stands in each cell: the number is read, the colour only helps.
        steps: step sizes [rad].
        kp: gains of the rows [N·m/rad].
        kv: gains of the columns [N·m·s/rad].
    """
    shape = (len(steps), len(kp), len(kv))
    maps, texts = np.reshape(values, shape), np.reshape(np.array(labels), shape)
    for number, (ax, step) in enumerate(zip(axes, steps, strict=True)):
        _grid_map(ax, maps[number], texts[number], float(maps.max()))
        ax.set_xticks(np.arange(len(kv)) + 0.5, [f"{value:g}" for value in kv])
        ax.set_yticks(np.arange(len(kp)) + 0.5, [f"{value:g}" for value in kp])
        ax.set_title(f"step {step:g} rad", loc="left")
        ax.set_xlabel("KV [N·m·s/rad]")
        ax.set_ylabel("KP [N·m/rad]")
        ax.label_outer()
    return axes


def _grid_map(ax: Axes, values: FloatArray, texts: np.ndarray, highest: float) -> None:
    look: dict[str, Any] = {"edgecolors": "#d9d9d9", "linewidth": 1}
    ax.pcolormesh(values, cmap="Blues", vmin=0, vmax=highest, **look)
    for (row, column), text in np.ndenumerate(texts):
        color = "white" if values[row, column] > 0.55 * highest else "black"
        ax.text(column + 0.5, row + 0.5, text, ha="center", va="center", fontsize="small",
                color=color)  # fmt: skip
    ax.grid(visible=False)


def _finish(ax: Axes, title: str, ylabel: str, until: float) -> None:
    ax.set_title(title, loc="left")
    ax.set_xlim(0, until)
    ax.set_xlabel("time [s]")
    ax.set_ylabel(ylabel)
    ax.legend(fontsize="small", loc="lower right")
    ax.label_outer()
