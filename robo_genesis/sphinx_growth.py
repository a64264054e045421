"""How the course's cost grows: ```` ```{cost-growth} ````, from what `make growth` kept.

Where nothing is kept, or it is no longer of this engine and lock, the page says so and names the
command.
"""

import os
from pathlib import Path
from typing import Any

from docutils import nodes
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robo_genesis import growth, kept, plots
from robo_genesis.growth import COMMAND, Growth


class CostGrowth(SphinxDirective):
    """Show two plots with a sentence each, and what was measured with what."""

    def run(self) -> list[nodes.Node]:
        """Return plots and sentences, or the command that makes them."""
        book = Path(self.env.srcdir)
        try:
            found = growth.read(book)
        except kept.KeptError as error:
            raise self.error(f"cost-growth: {error}") from error
        self.env.note_dependency(str(book / growth.FILE))
        if found is None:
            missing = f"Not measured. One command does it:\n\n    {COMMAND}\n"
            return self.parse_text_to_nodes(missing)
        building, size, verifying = growth.sentences(found)
        sizes = ", ".join(str(b.lessons) for b in found.built)
        counts = ", ".join(str(v.bundles) for v in found.verified)
        return [
            *self.parse_text_to_nodes(f"{origin_text(found)}\n\n{building} {size}"),
            self.figure(
                "lessons", lessons_figure(found),
                f"Build time and size of the site over the number of lessons, at {sizes} lessons.",
                "`make book` with all pages executed and with none, and the size of its site.",
            ),
            *self.parse_text_to_nodes(verifying),
            self.figure(
                "bundles", bundles_figure(found),
                f"Seconds of verification over the number of bundles, at {counts} bundles.",
                "One process that verifies copies of a lab's bundle, its start included.",
            ),
        ]  # fmt: skip

    def figure(self, name: str, drawn: Figure, alt: str, caption: str) -> nodes.Node:
        """Return a figure; its file stands beside the site until Sphinx copies it."""
        anchor = f"fig-growth-{name}"
        file = Path(self.env.app.outdir).parent / "panel" / f"{anchor}.svg"
        file.parent.mkdir(parents=True, exist_ok=True)
        with plots.course_style():
            drawn.savefig(file, format="svg", metadata={"Date": None, "Creator": None})
        image = nodes.image(uri=f"/{os.path.relpath(file, self.env.srcdir)}", alt=alt)
        text = nodes.caption("", "", *self.parse_inline(caption, lineno=self.lineno)[0])
        return nodes.figure("", image, text, ids=[anchor], performance=COMMAND)


def lessons_figure(found: Growth) -> Figure:
    """Draw build time and size of the site over the number of lessons."""
    lessons = [b.lessons for b in found.built]
    with plots.course_style():
        figure = Figure(figsize=(7, 5))
        time, size = figure.subplots(2, 1, sharex=True)
        time.plot(lessons, [b.executing for b in found.built], label="all pages executed",
                  **plots.look("other", marker="o"))  # fmt: skip
        time.plot(lessons, [b.rendering for b in found.built], label="no page executed",
                  **plots.look("further", marker="s"))  # fmt: skip
        time.legend()
        _label(time, "build [s]")
        size.plot(lessons, [b.site / 1e6 for b in found.built], **plots.look("other", marker="^"))
        size.xaxis.set_major_locator(MaxNLocator(integer=True))
        _label(size, "site [MB]", "lessons")
    return figure


def bundles_figure(found: Growth) -> Figure:
    """Draw verification time over the number of bundles."""
    with plots.course_style():
        figure = Figure(figsize=(7, 3))
        ax = figure.subplots()
        bundles, seconds = zip(*((v.bundles, v.seconds) for v in found.verified), strict=True)
        ax.plot(bundles, seconds, **plots.look("other", marker="^"))
        _label(ax, "verification [s]", "bundles")
    return figure


def _label(ax: Axes, ylabel: str, xlabel: str = "") -> None:
    ax.set_xlim(left=0)
    ax.set_ylim(bottom=0)
    ax.set_ylabel(ylabel)
    ax.set_xlabel(xlabel)


def origin_text(found: Growth) -> str:
    """Return what was measured with what, and whether that is still so."""
    text = (
        f"Measured by `{COMMAND}` on {found.date} with Genesis {found.engine}, lock "
        f"{found.lock[:12]}, on a machine of {found.cores} cores, one run each."
    )
    reason = kept.stale(found)
    return f"**Stale**: {reason}. `{COMMAND}` measures anew. {text}" if reason else text


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive."""
    app.add_directive("cost-growth", CostGrowth)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
