"""The panel of a reference run shows its bundle, or the command that creates a missing one."""

import dataclasses
import shutil
from types import SimpleNamespace

import numpy as np
import pytest
import trimesh
from bundles import engine_on, written
from docutils import nodes
from docutils.utils import new_document
from spoilers import edit, on, part, predicate
from without_sphinx import Panel, rows_of

from robo_genesis.core import project
from robo_genesis.core.declaration import Filmed
from robo_genesis.evidence import bundle, recorder, replay_data, report
from robo_genesis.evidence.bundle_store import put
from robo_genesis.evidence.compare import compare
from robo_genesis.evidence.trace_files import read_trace
from robo_genesis.pipeline.bundles.status import Status, recorded_status
from robo_genesis.sim import visual_shape
from robo_genesis.sim.visual_shape import Part
from robo_genesis.site.evidence import ledger as sphinx_ledger
from robo_genesis.site.evidence import ledger_data, provenance
from robo_genesis.site.evidence import panel as sphinx_panel
from robo_genesis.site.evidence.ledger_data import PageRun

FILMED = Filmed("the box", "the first run")


ATTACKS = (
    "<script>alert(1)</script>",
    "![a](https://example.org/x.png)",
    "[a](javascript:alert(1))",
    "{raw}`x`",
    "```{literalinclude} /etc/hostname",
    ":::{raw} html",
    "| a | **b** |",
    "&lt;b&gt; $x$ \\(x\\) `y`",
)


@pytest.mark.parametrize("attack", ATTACKS)
def test_text_of_a_bundle_is_shown_as_it_is_and_never_as_markup(folder, tmp_path, attack):
    fields = ("device_name", "torch_version", "hip_version", "cuda_version", "driver")
    part("backend", **dict.fromkeys(fields, attack))(folder)
    part("render", renderer=attack)(folder)
    predicate(environment={"GS_LOG": attack})(folder)
    facts = bundle.read_manifest(folder).predicate
    sentence = sphinx_panel.introduction(f"Frames by {attack}.")
    table = sphinx_panel.backend_facts(facts)
    assert sentence.astext() == f"Reference run. Frames by {attack}."
    found = dict(rows_of([table]))
    both = f"{attack}, {attack}"
    shown = {"device": attack, "Torch": attack, "HIP, CUDA": both, "driver": attack}
    shown |= {"renderer": attack, "engine switches": f"GS_LOG={attack}"}
    assert found | shown == found
    plain = {
        "paragraph",
        "strong",
        "literal",
        *["table", "tgroup", "colspec", "thead", "tbody", "row", "entry"],
    }
    made = {n.tagname for part in (sentence, table) for n in part.findall(nodes.Element)}
    assert made == plain
    status = Status("stale", attack, "", None, "stale", attack)
    run = PageRun("l04/lab", tmp_path / attack[:3], status, recorded=True)
    block = nodes.container("", *sphinx_panel.withheld(run))
    assert block.astext().count(attack) == 4
    made = {n.tagname for n in block.findall(nodes.Element)}
    assert made == {"container", "paragraph", "strong", "literal_block"}


def test_a_panel_with_text_that_is_no_markup(folder, tmp_path, record, monkeypatch):
    """What a run says reaches no parser: only our own sentences do."""
    said, attack = [], "<script>alert(1)</script>"
    parse = Panel.parse_text_to_nodes
    monkeypatch.setattr(
        Panel, "parse_text_to_nodes", lambda self, text: said.append(text) or parse(self, text)
    )
    run = record()
    part("backend", device_name=attack, driver=attack)(run.folder)
    edit(run.folder, "arrays.json", lambda a: a["coords"].update(link=[attack, "b", "c"]))
    links = bundle.read_arrays(run.folder).coords["link"]
    box = trimesh.creation.box((0.1, 0.1, 0.1))
    parts = [Part(link, (9, 9, 9), box.vertices.astype(np.float32), box.faces) for link in links]
    visual_shape.write_shape(tmp_path / "l04" / "lecture", parts)
    trace = read_trace(run.folder, bundle.read_arrays(run.folder), "G1")
    monkeypatch.setattr(
        replay_data,
        "read_trace",
        lambda *asked: dataclasses.replace(trace, link_pos=trace.link_pos[:, [2, 1, 0]]),
    )
    run = accepted("l04/lab", run.folder, recorded=True)
    monkeypatch.setattr(sphinx_panel, "comparison", lambda *asked: [nodes.paragraph("", "x")])
    panel = Panel(tmp_path / "book").panel(run)
    assert f"The link {attack} moves farthest" in panel.astext()
    assert not [text for text in said if attack in text]
    assert attack not in "".join(raw.astext() for raw in panel.findall(nodes.raw))


def test_frames_are_the_bundle_s_files_and_only_where_there_are_any(folder):
    pictures = list(sphinx_panel.frames(folder, FILMED, "cpu"))
    assert [picture.content for picture in pictures] == [
        (folder / "frames" / f"{name}.png").read_bytes() for name in ("initial", "final")
    ]
    states = [f"{name} state of the first run on cpu." for name in ("initial", "final")]
    assert [p.alt for p in pictures] == [f"Camera frame of the box, {state}" for state in states]
    shutil.rmtree(folder / "frames")
    assert list(sphinx_panel.frames(folder, FILMED, "cpu")) == []


def accepted(page, folder, **more) -> PageRun:
    """An accepted run whose bundle is in a folder that is named after its backend."""
    status = Status("verified", folder.name, "", bundle.read_manifest(folder))
    return PageRun(page, folder, status, **more)


@pytest.fixture
def record(folder, tmp_path, built, courses_pages):
    """Record the bundle on another backend; this build's outputs and shape are in `tmp_path`."""
    built({f"l04/{page}": tmp_path / "l04" / page for page in ("lab", "lecture")})
    box = trimesh.creation.box((0.1, 0.1, 0.1))
    links = bundle.read_arrays(folder).coords["link"]
    parts = [Part(link, (9, 9, 9), box.vertices.astype(np.float32), box.faces) for link in links]
    visual_shape.write_shape(tmp_path / "l04" / "lecture", parts)

    def run(backend="amdgpu", lesson="l04") -> PageRun:
        copy = shutil.copytree(folder, tmp_path / "book" / "evidence" / lesson / "cpu")
        return accepted(f"{lesson}/lab", on(backend)(copy), recorded=True)

    return run


@pytest.mark.parametrize("accelerator", ["amdgpu", "cuda"])
def test_the_comparison_names_both_runs_and_all_else_the_recorded_one(
    folder, tmp_path, record, monkeypatch, accelerator
):
    book = tmp_path / "book"
    runs = accepted("l04/lab", folder), record(accelerator)
    monkeypatch.setattr(provenance, "measured_pages", lambda book: {})
    monkeypatch.setattr(provenance, "all_runs", lambda book: {run.key: run for run in runs})
    app = SimpleNamespace(env=SimpleNamespace(srcdir=book, docname="page"))
    document = new_document("page")
    document += Panel(book).panel(runs[1])
    for image in document.findall(nodes.image):
        image["uri"] = image["uri"].removeprefix("/")
    provenance.read_page(app, document)

    ours, theirs = (
        ledger_data.provenance("table", [run]).removeprefix("Measured ") for run in runs
    )
    lines = [n.astext() for n in document.findall(lambda n: "provenance" in classes(n))]
    alone, compared = f"Measured {theirs} · ledger", f"Measured {ours} and {theirs} · ledger"
    assert ours.startswith("on cpu · ")
    assert theirs.startswith(f"on {accelerator} · ")
    assert lines == [alone] * 6 + [compared] * 2
    items = app.env.robo_genesis_items["page"]
    both = ("l04/lab/cpu", f"l04/lab/{accelerator}/recorded")
    assert [item.runs for item in items] == [both[1:]] * 6 + [both] * 2
    run, badge, *_ = sphinx_ledger._of_runs(runs)
    anchors = ["#run-l04-lab-cpu", f"#run-l04-lab-{accelerator}-recorded"]
    assert [link["refuri"] for link in run] == anchors
    assert [node.astext() for node in badge] == ["cpu-verified", f"{accelerator}-verified"]


@pytest.mark.parametrize(
    ("actual", "facts", "axis"),
    [
        ("amdgpu", {"HIP, CUDA": "7.1.25424, –", "renderer": "AMD Instinct (radeonsi)"},
         "backend cpu → amdgpu"),
        ("cuda", {"HIP, CUDA": "–, 13.0", "renderer": "NVIDIA H100/PCIe/SSE2"},
         "backend cpu → cuda"),
        ("cpu", {"HIP, CUDA": "–, –", "renderer": "llvmpipe"}, "repeat"),
    ],
)  # fmt: skip
def test_what_the_recorder_writes_on_each_backend_is_accepted_shown_and_compared(
    folder, tmp_path, record, engine, experiment, monkeypatch, actual, facts, axis
):
    monkeypatch.setattr(recorder, "driver_version", lambda name: f"the driver of {name}")
    there = engine_on(engine, actual)
    left = written(there, tmp_path / "outputs", "l04", "lab", experiment)
    place = put(left, tmp_path / "book" / "evidence" / "l04")
    status = recorded_status(tmp_path / "book", "l04", actual)
    assert (status.badge, place.name) == (f"{actual}-verified", actual)
    panel = Panel(tmp_path / "book").panel(PageRun("l04/lab", place, status, recorded=True))
    shown = dict(row for row in rows_of([panel]) if len(row) == 2)
    facts |= {"device": there.backend.device_name, "driver": f"the driver of {actual}"}
    facts["backend requested, actual"] = f"{there.backend.requested}, {actual}"
    assert shown | facts == shown
    assert "Compared with this build's run on cpu: equal." in panel.astext()
    comparison = compare(folder, place)
    assert report.summary(comparison).startswith(f"L04 lab: {axis}\nEqual.")
    assert (
        f"{actual} (requested: {there.backend.requested})" in report.document(comparison).markdown()
    )


def test_a_recorded_run_replays_from_its_own_record(tmp_path, record):
    run = record()
    panel = Panel(tmp_path / "book").panel(run)
    (block,) = [n for n in panel.findall(nodes.container) if "replay-block" in classes(n)]
    assert block["evidence_runs"] == ("l04/lab/amdgpu/recorded",)
    name = "replay-l04-lab-amdgpu-recorded"
    assert f'data-model="../replay/{name}.js"' in block[0].astext()


def test_a_lecture_shows_the_compared_metrics_and_no_picture(tmp_path, record, monkeypatch):
    metrics = [nodes.paragraph("", "The metrics.")]
    monkeypatch.setattr(sphinx_panel, "comparison", lambda *asked: metrics)
    panel = Panel(tmp_path / "book", table=None).panel(record())
    assert "Reference run." in panel.astext()
    assert "The metrics." in panel.astext()
    assert not list(panel.findall(nodes.image)) + list(panel.findall(nodes.table))


@pytest.mark.parametrize("options", [{}, {"table": None}])
def test_a_backend_without_a_run_is_one_sentence(tmp_path, record, options):
    status = Status("missing", "cuda", "Nothing is recorded.", None)
    run = PageRun("l04/lab", record().folder, status, True)
    panel = Panel(tmp_path / "book", **options).panel(run)
    (paragraph,) = panel.children
    assert paragraph.astext().startswith("No run on CUDA GPU is recorded for Genesis")


@pytest.mark.parametrize("state", ["inconclusive", "stale", "failed", "refused"])
@pytest.mark.parametrize("options", [{}, {"table": None}])
def test_a_run_that_is_not_verified_shows_its_state_alone(tmp_path, record, state, options):
    run = record()
    manifest = run.status.manifest if state == "inconclusive" else None
    status = Status(state, "amdgpu", "Found a, expected b.", manifest, summary="Why.")
    panel = Panel(tmp_path / "book", **options).panel(PageRun("l04/lab", run.folder, status, True))
    text = f"No figures from amdgpu for Genesis {project.engine_pin()} (amdgpu-{state}). Why."
    assert panel.astext().startswith(text)
    shown = (nodes.image, nodes.table, nodes.raw, nodes.bullet_list)
    assert not [n for n in panel.findall(nodes.Element) if isinstance(n, shown)]


def test_a_lesson_that_compares_no_cases_has_neither_figure_nor_replay(
    tmp_path, record, monkeypatch
):
    metrics = [nodes.paragraph("", "The metrics.")]
    monkeypatch.setattr(sphinx_panel, "comparison", lambda *asked: metrics)
    panel = Panel(tmp_path / "book").panel(record(lesson="l99"))
    assert not [n for n in panel.findall(nodes.container) if "replay-block" in classes(n)]
    names = [figure["ids"] for figure in panel.findall(nodes.figure)]
    assert names == [["l99-amdgpu-initial"], ["l99-amdgpu-final"]]
    assert "The metrics." in panel.astext()


def classes(node):
    return node.get("classes", ()) if isinstance(node, nodes.Element) else ()


def test_warnings_are_escaped_and_folded():
    fold = "<details><summary>1 engine warnings</summary><ol><li>a &lt; b</li></ol></details>"
    assert sphinx_panel.warnings_html(["a < b"]) == fold
