"""The reference run in a lab: its figures, frames, metrics and backend.

A lab writes ```` ```{evidence} l04 ````. The panel shows only a verified bundle of
`book/evidence/<lesson>/<backend>/`. Otherwise it gives the state, the reason and the
command that records a new one. A run that was never recorded has no panel; the pages on
evidence list it.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx

from robo_genesis.core import project, shown
from robo_genesis.core.channels import Runs
from robo_genesis.core.markup import filled
from robo_genesis.core.text import listed
from robo_genesis.evidence.compare import compare
from robo_genesis.lessons import course_marks, find_replay
from robo_genesis.site.pages import PageDirective
from robo_genesis.site.replay.directive import replay_block
from robo_genesis.site.replay.recorded_runs import read_runs

from .plain_nodes import image
from .runs import PageRun, page_run, recorded_runs


class Evidence(PageDirective):
    """Show the recorded runs of a lesson, the reference backend first."""

    required_arguments = 1

    def shown(self) -> list[nodes.Node]:
        """Return one panel per backend with a run."""
        runs = recorded_runs(self.book, self.arguments[0])
        return [self.panel(run) for run in runs if run.status.state != "missing"]

    def panel(self, run: PageRun) -> nodes.Node:
        """Return the panel of one backend."""
        status, env = run.status, self.env
        classes = ["evidence-panel", f"status-{status.state}"]
        panel = nodes.container(classes=classes)
        panel += self.filled("panel.md", run=run, pin=project.engine_pin())
        if status.state == "verified":
            panel["evidence_runs"] = (run.key,)
            for name, content, alt, caption in pictures(run):
                file = f"{run.lesson}-{status.backend}-{name}"
                picture = image(env, file, content, alt), nodes.caption("", caption)
                panel += nodes.figure("", *picture, ids=[Path(file).stem])
            panel += replay_block(self, run.key, run.folder)
            here = page_run(self.book, run.lesson)
            compared = compare(here.folder, run.folder)
            found = self.filled("comparison.md", compared=compared)
            panel += nodes.container("", *found, evidence_runs=(here.key, run.key))
        return panel

    def filled(self, template: str, **values: Any) -> list[nodes.Node]:
        """Return the nodes of a template in Markdown."""
        text = filled(Path(__file__).with_name(template), **values)
        return self.parse_text_to_nodes(text)


def pictures(run: PageRun) -> Iterator[tuple[str, bytes, str, str]]:
    """Yield (name, content, alternative text, caption) of the curves and of each camera frame."""
    replay, backend = find_replay(run.lesson), run.status.backend
    runs = read_runs(run.folder, replay, labels={})
    names = listed([channel.name for channel in runs.channels])
    what = f"{names.capitalize()} of {runs.subject}"
    several = f", with the cases {listed(replay.cases)} drawn over each other"
    alt = f"{what} over time on {backend}{several if len(runs.traces) > 1 else ''}."
    caption = f"{what} on {backend}, drawn from the arrays of the recorded run."
    yield "response.svg", curves(runs), alt, caption
    for name in ("initial", "final"):
        path = run.folder / "frames" / f"{name}.png"
        if path.is_file():
            subject = replay.filmed or f"the {replay.thing}"
            alt = f"Camera frame of {subject}, {name} state on {backend}."
            caption = f"Camera frame on {backend}, {name} state."
            yield path.name, path.read_bytes(), alt, caption


def curves(runs: Runs) -> bytes:
    """Return every channel of the compared cases, as SVG."""
    from robo_genesis.core import plotting  # it loads slowly

    with plotting.course_style():
        drawing = plotting.figure(0.5 + 3 * len(runs.channels))
        axes = drawing.subplots(len(runs.channels), 1, sharex=True, squeeze=False)[:, 0]
        for ax, drawn in zip(axes, runs.channels, strict=True):
            levels = runs.levels_of(drawn)
            plotting.channel(ax, runs.t, drawn, runs.subject, course_marks(), levels)
            ax.label_outer()
        return shown.svg(drawing).encode()


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("evidence", Evidence)
