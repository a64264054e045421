"""The reference run in a lesson: its figures, frames, metrics and backend, or why it is missing.

A page writes ```` ```{evidence} l04 ````. The panel shows only an accepted bundle of
`book/evidence/<lesson>/<backend>/`. Where there is none, it gives the reason and the command that
creates one.
"""

import io
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

from docutils import nodes
from matplotlib.figure import Figure
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robo_genesis.core import plotting, project, tables
from robo_genesis.core.quantities import format_value
from robo_genesis.core.text import listed
from robo_genesis.evidence import bundle
from robo_genesis.evidence.compare import Comparison, compare, specification
from robo_genesis.evidence.findings import DIFFERS
from robo_genesis.evidence.replay_data import read_runs
from robo_genesis.evidence.status import RECORDED_PAGE, Status
from robo_genesis.lessons.declaration import Compared, Filmed, Moving
from robo_genesis.lessons.registry import compared_cases, filmed, find_lesson
from robo_genesis.site.evidence import measured
from robo_genesis.site.evidence.ledger_data import Run
from robo_genesis.site.evidence.measured import BACKEND
from robo_genesis.site.replay.directive import replay_block


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture of a bundle, with its alternative text and caption."""

    name: str
    suffix: str
    content: bytes
    alt: str
    caption: str


VALUES, RELATIONS = ("Values", "Exact counts"), "Relations"


class Evidence(SphinxDirective):
    """Show the recorded runs of a lesson, the reference backend first."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return one panel per backend; the reference backend has one even without a run."""
        lesson, book = self.arguments[0], Path(self.env.srcdir)
        backends = measured.lesson_backends(book, lesson)
        return [
            self.panel(lesson, measured.recorded_state(book, lesson, name)) for name in backends
        ]

    def panel(self, lesson: str, status: Status) -> nodes.Node:
        """Return the panel of one backend."""
        panel = nodes.container(classes=["evidence-panel", f"status-{status.state}"])
        if status.manifest is None:
            panel += self.parse_text_to_nodes(missing_text(lesson, status))
            return panel
        folder = Path(self.env.srcdir) / "evidence" / lesson / status.backend
        here = measured.outputs_folder() / lesson / RECORDED_PAGE / BACKEND
        panel += self.parse_text_to_nodes(backend_text(status))
        recorded = Run(f"{lesson}/{RECORDED_PAGE}", folder, status, recorded=True).key
        panel["evidence_runs"] = (recorded,)
        compared = compared_cases(lesson)
        drawn = [response(folder, compared, status.backend)] if compared else []
        for picture in (*drawn, *frames(folder, filmed(lesson), status)):
            panel += figure(self, f"{lesson}-{status.backend}-{picture.name}", picture)
        if compared:
            panel += replay_block(self, recorded, folder)
        tables = self.parse_text_to_nodes(metrics_text(lesson, here, folder))
        both = (f"{lesson}/{RECORDED_PAGE}/{BACKEND}", recorded)
        panel += nodes.container("", *tables, evidence_runs=both)
        panel += nodes.raw("", warnings_html(status.manifest.predicate.warnings), format="html")
        return panel


def figure(directive: SphinxDirective, anchor: str, picture: Picture) -> nodes.Node:
    """Return a figure; its file is written outside the site until Sphinx copies it."""
    file = Path(directive.env.app.outdir).parent / "panel" / f"{anchor}{picture.suffix}"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(picture.content)
    image = nodes.image(uri=f"/{os.path.relpath(file, directive.env.srcdir)}", alt=picture.alt)
    return nodes.figure("", image, nodes.caption("", picture.caption), ids=[anchor])


def missing_text(lesson: str, status: Status) -> str:
    """Return the missing evidence, the reason, and the command that creates it, as Markdown."""
    return (
        f"**No evidence from {status.backend} for Genesis {project.engine_pin()} "
        f"({status.badge}).** {status.summary or status.reason} On a machine with this backend, "
        "this makes it:\n\n"
        f"```console\n$ make evidence LESSON={lesson} BACKEND={status.backend}\n```\n\n"
        "{doc}`/evidence/recording` says what that machine needs.\n"
    )


def backend_text(status: Status) -> str:
    """Return the run's state and the facts of its backend as Markdown."""
    assert status.manifest is not None
    predicate = status.manifest.predicate
    backend = predicate.backend
    facts = {
        "device": backend.device_name,
        "backend requested, actual": f"{backend.requested}, {backend.actual}",
        "Torch": backend.torch_version,
        "HIP, CUDA": f"{backend.hip_version or '–'}, {backend.cuda_version or '–'}",
        "driver": backend.driver or "–",
        "renderer": predicate.render.renderer or "SKIP",
        "engine switches": switches_text(predicate.environment),
        "recorded": predicate.started[:10],
        "run": predicate.run_id[:8],
    }
    rows = [{"what": name, "value": value} for name, value in facts.items()]
    return f"**Reference run.** {status.sentence}\n\n{tables.markdown(rows)}"


def switches_text(switches: Mapping[str, str]) -> str:
    """Return the variables that were set for the engine as code for a cell of a table."""
    pairs = (" ".join(f"{name}={value}".split()) for name, value in switches.items())
    marks = str.maketrans({"`": "'", "|": "\\|"})
    return ", ".join(f"`{pair.translate(marks)}`" for pair in pairs) or "none set"


def response(folder: Path, compared: Compared | Moving, backend: str) -> Picture:
    """Return every channel of the compared cases, drawn from the bundle's arrays."""
    runs = read_runs(folder, compared)
    stream, count = io.BytesIO(), len(runs.channels)
    with plotting.course_style():
        figure = Figure(figsize=(7, 1 + 2.5 * count))
        axes = figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
        for ax, drawn in zip(axes, runs.channels, strict=True):
            plotting.channel(ax, runs.t, drawn, runs.subject, runs.levels_of(drawn))
            ax.label_outer()
        figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None})
    names = listed([channel.name for channel in runs.channels])
    what = f"{names.capitalize()} of {runs.subject}"
    several = f", with the cases {compared.names} drawn over each other"
    alt = f"{what} over time on {backend}{several if len(runs.traces) > 1 else ''}."
    caption = f"{what} on {backend}, drawn from the arrays of the recorded run."
    return Picture("response", ".svg", stream.getvalue(), alt, caption)


def frames(folder: Path, shown: Filmed, status: Status) -> Iterator[Picture]:
    """Yield the unchanged camera frames, nothing where rendering was off."""
    for name in ("initial", "final"):
        path = folder / "frames" / f"{name}.png"
        if path.is_file():
            what, state = f"Camera frame of {shown.thing}", f"{name} state of {shown.case}"
            alt = f"{what}, {state} on {status.backend}."
            caption = f"Camera frame on {status.backend}, {state}."
            yield Picture(name, ".png", path.read_bytes(), alt, caption)


def metrics_text(lesson: str, here: Path, folder: Path) -> str:
    """Return the comparison of this build's CPU run with the recorded run, as `make compare` does.

    Args:
        lesson: its tolerances and orderings apply.
        here: bundle of this build.
        folder: the recorded bundle.
    """
    found = compare(here, folder, specification(lesson))
    if found.obstacles:
        reasons = "".join(f"- {reason}\n" for reason in found.obstacles)
        return f"**Not comparable with this build's run on {BACKEND}.**\n\n{reasons}"
    both = f"{BACKEND}, this build", f"{found.new.backend.actual}, recorded"
    elsewhere = [
        section.title.lower()
        for section in found.sections
        if section.title not in (*VALUES, RELATIONS) and section.state == DIFFERS
    ]
    more = f" They also differ in {' and '.join(elsewhere)}: see `make compare`." * bool(elsewhere)
    orderings = "The lesson claims no ordering between cases."
    if rows := ordering_rows(found, both):
        claimed = "The orderings that the lesson claims, in both runs:"
        orderings = f"{claimed}\n\n{tables.markdown(rows)}"
    return (
        f"**Compared with this build's run on {BACKEND}: {found.state}.**{more} The lesson's "
        "specification declares tolerances and orderings; counts must be equal.\n\n"
        f"{tables.markdown(value_rows(found, both, (here, folder)))}\n{orderings}"
    )


def value_rows(
    found: Comparison, both: tuple[str, str], folders: tuple[Path, Path]
) -> list[dict[str, str]]:
    """Return a row for each metric of each case, in the lesson's order, with values as in prose."""
    spec = specification(found.new.lesson)
    ours, theirs = (bundle.read_metrics(folder) for folder in folders)
    rows = {f.what: f for s in found.sections if s.title in VALUES for f in s.findings}
    labels = find_lesson(found.new.lesson).about_metrics("label")
    return [
        {
            "metric": f"{case} {labels[name]}",
            both[0]: format_value(ours[case][name].value, ours[case][name].unit),
            both[1]: format_value(theirs[case][name].value, theirs[case][name].unit),
            "difference": row.delta or "–",
            "allowed": row.allowed or "–",
            "verdict": row.state,
        }
        for case, names in spec.metrics.items()
        for name in names
        if (row := rows.get(f"{case}.{name}"))
    ]


def ordering_rows(found: Comparison, both: tuple[str, str]) -> list[dict[str, str]]:
    """Return a row for each ordering that the lesson claims, with the result in each run."""
    rows = []
    labels = find_lesson(found.new.lesson).about_metrics("label")
    for f in (f for s in found.sections if s.title == RELATIONS for f in s.findings):
        claim, _, verdict = f.what.partition(", ")
        metric, _, order = claim.partition(": ")
        rows.append(
            {
                "claim": f"{labels[metric]}: {order}",
                both[0]: f.old,
                both[1]: f.new,
                "margin": f.allowed.removeprefix("margin "),
                "verdict": verdict,
            }
        )
    return rows


def warnings_html(warnings: Sequence[str]) -> str:
    """Return the engine's warnings in a fold."""
    lines = "".join(f"<li>{escape(text)}</li>" for text in warnings)
    return f"<details><summary>{len(warnings)} engine warnings</summary><ol>{lines}</ol></details>"


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("evidence", Evidence)
