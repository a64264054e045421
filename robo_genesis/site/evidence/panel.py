"""The reference run in a lab: its figures, frames, metrics and backend.

A lab writes ```` ```{evidence} l04 ````. The panel shows only a verified bundle of
`book/evidence/<lesson>/<backend>/`. Otherwise it gives the state, the reason and the
command that records a new one. A run that was never recorded has no panel; the pages on
evidence list it.
"""

from collections.abc import Iterator, Sequence
from html import escape
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment

from robo_genesis.core import project, shown
from robo_genesis.core.channels import Replay
from robo_genesis.core.text import listed
from robo_genesis.evidence.bundle import Manifest
from robo_genesis.evidence.compare import BundleComparison, compare
from robo_genesis.lessons import course_marks, find_replay
from robo_genesis.site.evidence.plain_nodes import (
    bullets,
    image,
    marked,
    paragraph,
    table,
)
from robo_genesis.site.evidence.runs import BACKEND, PageRun, page_run, recorded_runs
from robo_genesis.site.pages import PageDirective
from robo_genesis.site.replay.directive import replay_block
from robo_genesis.site.replay.recorded_runs import read_runs

VALUES, RELATIONS = ("Values", "Exact counts"), "Relations"
AS_NEEDED = [
    "colwidths-auto"
]  # The class of a table whose columns are as wide as needed
RECORDING = "{doc}`/evidence/recording` says what that machine needs."


class Evidence(PageDirective):
    """Show the recorded runs of a lesson, the reference backend first."""

    required_arguments = 1

    def shown(self) -> list[nodes.Node]:
        """Return one panel per backend with a run."""
        runs = recorded_runs(Path(self.env.srcdir), self.arguments[0])
        return [self.panel(run) for run in runs if run.status.state != "missing"]

    def panel(self, run: PageRun) -> nodes.Node:
        """Return the panel of one backend."""
        lesson, folder, status = run.lesson, run.folder, run.status
        panel = nodes.container(classes=["evidence-panel", f"status-{status.state}"])
        if run.manifest is None or status.state != "verified":
            panel += withheld(run)
            panel += self.parse_text_to_nodes(RECORDING)
            return panel
        panel["evidence_runs"] = (run.key,)
        panel += paragraph(nodes.strong("", "Reference run."), f" {status.sentence}")
        panel += backend_facts(run.manifest)
        run_shown = (
            f"{lesson}-{status.backend}",
            folder,
            find_replay(lesson),
            status.backend,
        )
        panel += response(self.env, *run_shown)
        panel += frames(self.env, *run_shown)
        panel += replay_block(self, run.key, folder)
        here = page_run(Path(self.env.srcdir), lesson)
        found = comparison(here.folder, folder)
        panel += nodes.container("", *found, evidence_runs=(here.key, run.key))
        panel += nodes.raw("", warnings_html(run.manifest.warnings), format="html")
        return panel


def figure(
    env: BuildEnvironment,
    anchor: str,
    suffix: str,
    content: bytes,
    alt: str,
    caption: str,
) -> nodes.figure:
    """Return a figure; its picture is in a file that is named after its anchor."""
    picture = image(env, f"{anchor}{suffix}", content, alt)
    return nodes.figure("", picture, nodes.caption("", caption), ids=[anchor])


def withheld(run: PageRun) -> list[nodes.Node]:
    """Return the state of a run that is not shown, the reason, and the command that records one."""
    status = run.status
    what = f"No figures from {status.backend} for Genesis {project.engine_pin()} ({status.badge})."
    why = f" {status.summary or status.reason} On a machine with this backend, this records a run:"
    return [
        paragraph(nodes.strong("", what), why),
        nodes.literal_block(run.command, run.command, language="console"),
    ]


def backend_facts(manifest: Manifest) -> nodes.Node:
    """Return the facts of a run's backend as a table."""
    backend = manifest.backend
    pairs = (f"{name}={value}" for name, value in manifest.environment.items())
    switches = [nodes.literal("", pair) for pair in pairs]
    facts = {
        "device": backend.device_name,
        "backend requested, actual": f"{backend.requested}, {backend.actual}",
        "Torch": backend.torch_version,
        "HIP, CUDA": f"{backend.hip_version or '–'}, {backend.cuda_version or '–'}",
        "driver": backend.driver or "–",
        "renderer": manifest.render.renderer or "SKIP",
        "engine switches": switches or "none set",
        "recorded": manifest.started[:10],
        "run": manifest.run_id[:8],
    }
    return table(("what", "value"), list(facts.items()), classes=AS_NEEDED)


def response(
    env: BuildEnvironment, prefix: str, folder: Path, replay: Replay, backend: str
) -> nodes.figure:
    """Return every channel of the compared cases, drawn from the bundle's arrays."""
    from robo_genesis.core import plotting  # it loads slowly

    runs = read_runs(folder, replay)

    with plotting.course_style():
        drawing = plotting.figure(0.5 + 3 * len(runs.channels))
        axes = drawing.subplots(len(runs.channels), 1, sharex=True, squeeze=False)[:, 0]
        for ax, drawn in zip(axes, runs.channels, strict=True):
            levels = runs.levels_of(drawn)
            plotting.channel(ax, runs.t, drawn, runs.subject, course_marks(), levels)
            ax.label_outer()
        content = shown.svg(drawing).encode()
    names = listed([channel.name for channel in runs.channels])
    what = f"{names.capitalize()} of {runs.subject}"
    several = f", with the cases {listed(replay.cases)} drawn over each other"
    alt = f"{what} over time on {backend}{several if len(runs.traces) > 1 else ''}."
    caption = f"{what} on {backend}, drawn from the arrays of the recorded run."
    return figure(env, f"{prefix}-response", ".svg", content, alt, caption)


def frames(
    env: BuildEnvironment, prefix: str, folder: Path, replay: Replay, backend: str
) -> Iterator[nodes.figure]:
    """Yield the unchanged camera frames as figures, nothing where rendering was off."""
    for name in ("initial", "final"):
        path = folder / "frames" / f"{name}.png"
        if path.is_file():
            subject = replay.filmed or f"the {replay.thing}"
            alt = f"Camera frame of {subject}, {name} state on {backend}."
            caption = f"Camera frame on {backend}, {name} state."
            yield figure(
                env, f"{prefix}-{name}", ".png", path.read_bytes(), alt, caption
            )


def comparison(here: Path, folder: Path) -> list[nodes.Node]:
    """Return the comparison of this build's CPU run with the recorded run, as `make compare` does.

    Args:
        here: bundle of this build.
        folder: the recorded bundle.
    """
    compared = compare(here, folder)
    if compared.obstacles:
        title = nodes.strong("", f"Not comparable with this build's run on {BACKEND}.")
        return [paragraph(title), bullets(*([reason] for reason in compared.obstacles))]
    both = f"{BACKEND}, this build", f"{compared.new.backend.actual}, recorded"
    intro = (
        f"**Compared with this build's run on {BACKEND}: {compared.state}.** The lesson's "
        "specification declares tolerances and orderings; counts must be equal. "
        "`make compare` shows all rows, also those of the arrays."
    )
    claimed = "The orderings that the lesson claims, in both runs:"
    orderings = compared_table(compared, (RELATIONS,), "claim", both)
    return [
        paragraph(*marked(intro)),
        *compared_table(compared, VALUES, "metric", both),
        nodes.paragraph("", claimed if orderings else "The lesson claims no ordering."),
        *orderings,
    ]


def compared_table(
    compared: BundleComparison, titles: Sequence[str], what: str, both: tuple[str, str]
) -> list[nodes.Node]:
    """Return the findings of some sections as a table, nothing if there are none.

    Args:
        compared: the comparison.
        titles: of the sections.
        what: the name of the first column.
        both: the names of the runs.
    """
    head = (what, *both, "difference", "allowed", "verdict")
    rows = [
        (row.what, row.old, row.new, row.delta or "–", row.allowed or "–", row.state)
        for section in compared.sections
        if section.title in titles
        for row in section.rows
    ]
    return [table(head, rows, classes=AS_NEEDED)] if rows else []


def warnings_html(warnings: Sequence[str]) -> str:
    """Return the engine's warnings in a fold."""
    lines = "".join(f"<li>{escape(text)}</li>" for text in warnings)
    return f"<details><summary>{len(warnings)} engine warnings</summary><ol>{lines}</ol></details>"


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("evidence", Evidence)
