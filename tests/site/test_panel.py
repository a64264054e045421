"""The panel of a reference run shows its bundle, or the command that creates a missing one."""

import shutil
from types import SimpleNamespace

import numpy as np
import pygltflib
import pytest
import trimesh
from docutils import nodes
from docutils.parsers.rst import DirectiveError
from docutils.utils import new_document
from spoilers import edit, metrics, on, part, predicate, seal
from without_sphinx import Panel

from robo_genesis.core import project
from robo_genesis.core.quantities import format_value, six_digits
from robo_genesis.evidence import bundle, replay_data
from robo_genesis.evidence.status import Status, recorded_status
from robo_genesis.evidence.trace_files import read_trace
from robo_genesis.evidence.verify import verify_bundle
from robo_genesis.lessons.declaration import Filmed
from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.lessons.registry import LESSONS
from robo_genesis.sim import visual_shape
from robo_genesis.sim.visual_shape import Part
from robo_genesis.site.evidence import ledger as sphinx_ledger
from robo_genesis.site.evidence import ledger_data, provenance
from robo_genesis.site.evidence import panel as sphinx_panel
from robo_genesis.site.evidence.ledger_data import Run

FILMED = Filmed("the box", "the first run")


@pytest.fixture
def verified(folder) -> Status:
    return Status("verified", "cpu", "", verify_bundle(folder))


def test_a_missing_run_is_named_with_its_command(tmp_path):
    text = sphinx_panel.missing_text("l04", recorded_status(tmp_path, "l04", "amdgpu"))
    assert f"No evidence from amdgpu for Genesis {project.engine_pin()} (amdgpu-missing)." in text
    assert "$ make evidence LESSON=l04 BACKEND=amdgpu" in text


def test_backend_facts_are_the_manifest_s(verified):
    text = sphinx_panel.backend_text(verified)
    facts = verified.manifest.predicate
    for fact in (facts.backend.device_name, facts.run_id[:8], facts.render.renderer):
        assert f"| {fact} |" in text
    assert "| engine switches | none set |" in text


def test_the_figure_changes_with_the_bundle_s_arrays(folder, verified, monkeypatch):
    picture = sphinx_panel.response(folder, LESSONS["l04"].compared, "cpu")
    assert picture.content.startswith(b"<?xml")
    assert "joint4 over time on cpu" in picture.alt
    assert sphinx_panel.response(folder, LESSONS["l04"].compared, "cpu") == picture
    shown = {"G1": "G2", "G2": "G1", "G3": "G3"}
    monkeypatch.setattr(replay_data, "read_trace", lambda f, a, case: read_trace(f, a, shown[case]))
    assert sphinx_panel.response(folder, LESSONS["l04"].compared, "cpu") != picture


def test_frames_are_the_bundle_s_files_and_only_where_there_are_any(folder, verified):
    digests = {s.name: s.digest.sha256 for s in verified.manifest.subject}
    pictures = list(sphinx_panel.frames(folder, FILMED, verified))
    for picture in pictures:
        assert ledger_data.sha256(picture.content) == digests[f"frames/{picture.name}.png"]
    states = [f"{name} state of the first run on cpu." for name in ("initial", "final")]
    assert [p.alt for p in pictures] == [f"Camera frame of the box, {state}" for state in states]
    shutil.rmtree(folder / "frames")
    assert list(sphinx_panel.frames(folder, FILMED, verified)) == []


def test_switches_are_shown_as_they_were_set(folder):
    predicate(environment={"GS_ENABLE_ZEROCOPY": "0", "EGL_LOG": "a|b`c"})(folder)
    text = sphinx_panel.backend_text(Status("verified", "cpu", "", bundle.read_manifest(folder)))
    assert "| engine switches | `GS_ENABLE_ZEROCOPY=0`, `EGL_LOG=a\\|b'c` |" in text


@pytest.fixture
def there(folder, tmp_path):
    """A bundle of an accelerator, otherwise the same."""
    return on("amdgpu")(shutil.copytree(folder, tmp_path / "there" / "cpu"))


def moved(folder, case, metric, by):
    """Move one metric, as another machine might have measured it."""
    metrics(lambda m: m[case][metric].update(value=m[case][metric]["value"] + by))(folder)
    seal(folder)


def compared(folder, there):
    """The text on two bundles of L04, and the cells of every line of its tables."""
    text = sphinx_panel.metrics_text("l04", folder, there)
    lines = [line for line in text.splitlines() if line.startswith("| ")]
    return text, [[cell.strip() for cell in line.strip("| ").split(" | ")] for line in lines]


def cells(rows, start, at=0):
    """The other cells of the only row whose cell number `at` is `start`."""
    (found,) = [row for row in rows if row[at] == start]
    return found[1:] if at == 0 else found


def test_equal_runs_are_side_by_side(folder, there):
    text, rows = compared(folder, there)
    assert text.startswith("**Compared with this build's run on cpu: equal.**")
    record = bundle.read_metrics(folder)["G2"]["overshoot"]
    value = format_value(record.value, record.unit)
    assert cells(rows, "G2 overshoot")[:3] == [value, value, "0 rad"]
    both = ["cpu, this build", "amdgpu, recorded"]
    assert rows[0] == ["metric", *both, "difference", "allowed", "verdict"]
    names = LESSONS["l04"].about_metrics("label").values()
    assert {f"{case} {name}" for case in l04.CASES for name in names} <= {row[0] for row in rows}


@pytest.mark.parametrize(("by", "verdict"), [(5e-5, "within tolerance"), (0.5, "differs")])
def test_a_difference_has_a_tolerance_and_a_verdict(folder, there, by, verdict):
    moved(there, "G2", "overshoot", by)
    text, rows = compared(folder, there)
    value = bundle.read_metrics(there)["G2"]["overshoot"].value
    atol, rtol = l04.TOLERANCES["rad"]
    expected = [six_digits(by, "rad"), six_digits(atol + rtol * value, "rad"), verdict]
    assert cells(rows, "G2 overshoot")[2:] == expected
    assert f": {verdict}.**" in text


def test_the_lesson_s_own_tolerance_is_shown_and_a_count_may_not_differ(folder, there, monkeypatch):
    monkeypatch.setitem(l04.TOLERANCES, "overshoot", (7.0, 0.0))
    moved(there, "G2", "saturation_samples", 1)
    _, rows = compared(folder, there)
    assert cells(rows, "G2 overshoot")[3] == "7 rad"
    assert cells(rows, "G2 saturation")[2:] == ["1", "0", "differs"]


def test_each_claimed_ordering_has_the_result_of_both_runs(folder, there):
    _, rows = compared(folder, there)
    claims = [row for row in rows if row[-1] == "held in both"]
    assert len(claims) == len(l04.RELATIONS)
    assert all(row[1].startswith("held: G") and row[2].startswith("held: G") for row in claims)
    moved(there, "G1", "overshoot", 1.0)
    claim, ours, theirs, margin, _ = cells(compared(folder, there)[1], "flipped", at=-1)
    assert (claim, margin) == ("overshoot: G2 higher than G1", "0.001 rad")
    assert ours.startswith("held: ")
    assert theirs.startswith("broken: ")


def test_an_ordering_within_the_margin_is_inconclusive(folder, there):
    g1, g2 = (bundle.read_metrics(folder)[case]["overshoot"].value for case in ("G1", "G2"))
    moved(there, "G1", "overshoot", g2 - g1)
    row = cells(compared(folder, there)[1], "inconclusive", at=-1)
    assert row[2].startswith("within the margin: ")


def test_a_difference_outside_the_tables_is_named(folder, there):
    edit(there, "arrays.json", lambda a: a["joints"][3].update(dof_idx_local=0))
    seal(there)
    text, _ = compared(folder, there)
    assert ": differs.** They also differ in coverage: see `make compare`." in text


def test_runs_that_cannot_be_compared_have_the_reason(folder, there):
    part("parameters", rise_fraction=0.5)(there)
    text, rows = compared(folder, there)
    assert text.startswith("**Not comparable with this build's run on cpu.**")
    assert "- parameters.rise_fraction differs: 0.9 and 0.5." in text
    assert rows == []


@pytest.mark.parametrize("accelerator", ["amdgpu", "cuda"])
def test_the_comparison_names_both_runs_and_all_else_the_recorded_one(
    folder, tmp_path, monkeypatch, accelerator
):
    book = tmp_path / "book"
    place = shutil.copytree(folder, book / "evidence" / "l04" / "cpu")
    status = Status("verified", accelerator, "", bundle.read_manifest(on(accelerator)(place)))
    runs = (
        Run("l04/lab", folder, Status("verified", "cpu", "", bundle.read_manifest(folder))),
        Run("l04/lab", book / "evidence" / "l04" / accelerator, status, recorded=True),
    )
    monkeypatch.setenv("ROBO_GENESIS_BUILD_OUTPUTS", str(tmp_path))
    write_a_shape(tmp_path)
    monkeypatch.setattr(provenance, "measured_pages", lambda book: {})
    monkeypatch.setattr(provenance, "all_runs", lambda book: {run.key: run for run in runs})
    app = SimpleNamespace(env=SimpleNamespace(srcdir=book, docname="page"))
    document = new_document("page")
    document += Panel(book).panel("l04", status)
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
    assert lines == [alone] * 5 + [compared] * 2
    items = app.env.robo_genesis_items["page"]
    both = ("l04/lab/cpu", f"l04/lab/{accelerator}/recorded")
    assert [item.runs for item in items] == [both[1:]] * 5 + [both] * 2
    run, badge, *_ = sphinx_ledger._of_runs(runs)
    anchors = ["#run-l04-lab-cpu", f"#run-l04-lab-{accelerator}-recorded"]
    assert [link["refuri"] for link in run] == anchors
    assert [node.astext() for node in badge] == ["cpu-verified", f"{accelerator}-verified"]


def write_a_shape(outputs):
    """Write the shape of this build's lecture: a box for each link of the record."""
    box = trimesh.creation.box((0.1, 0.1, 0.1))
    links = bundle.read_arrays(outputs / "l04" / "lab" / "cpu").coords["link"]
    parts = [Part(link, (9, 9, 9), box.vertices.astype(np.float32), box.faces) for link in links]
    visual_shape.write_shape(outputs / "l04" / "lecture", parts)


def test_a_recorded_run_replays_from_its_own_record(folder, tmp_path, monkeypatch):
    write_a_shape(tmp_path)
    panel = panel_of(folder, tmp_path, monkeypatch)
    book = tmp_path / "book"
    place = book / "evidence" / "l04" / "amdgpu"

    (block,) = [n for n in panel.findall(nodes.container) if "replay-block" in classes(n)]
    assert block["evidence_runs"] == ("l04/lab/amdgpu/recorded",)
    name = "replay-l04-lab-amdgpu-recorded"
    assert f'data-model="../replay/{name}.js"' in block[0].astext()
    written = book / "_build" / "html" / "replay"
    assert (written / f"{name}.js").read_bytes().startswith(b"(globalThis.replayModels ??= {})")
    trace = read_trace(place, bundle.read_arrays(place), "G2")
    model = pygltflib.GLTF2.load_binary(written / f"{name}.glb")
    assert [animation.name for animation in model.animations] == ["G1", "G2", "G3"]
    assert trace.link_pos[:, 2].astype(np.float32).tobytes() in model.binary_blob()
    assert len(list(block.findall(nodes.row))) == 1 + len(trace.t)


def panel_of(folder, tmp_path, monkeypatch, lesson="l04"):
    """The panel of a recorded run; this build's outputs are below `tmp_path`."""
    book = tmp_path / "book"
    place = on("amdgpu")(shutil.copytree(folder, book / "evidence" / lesson / "cpu"))
    monkeypatch.setenv("ROBO_GENESIS_BUILD_OUTPUTS", str(tmp_path))
    status = Status("verified", "amdgpu", "", bundle.read_manifest(place))
    return Panel(book).panel(lesson, status)


def test_another_robot_s_shape_is_an_error_of_the_page(folder, tmp_path, monkeypatch):
    corner = np.eye(3, dtype=np.float32), np.array([[0, 1, 2]])
    visual_shape.write_shape(tmp_path / "l04" / "lecture", [Part("wheel", (9, 9, 9), *corner)])
    with pytest.raises(DirectiveError) as caught:
        panel_of(folder, tmp_path, monkeypatch)
    assert "l04/lab/amdgpu/recorded: The shape has parts of wheel" in caught.value.msg
    assert "at one pin" in caught.value.msg


def test_a_lesson_that_compares_no_cases_has_neither_figure_nor_replay(
    folder, tmp_path, monkeypatch
):
    monkeypatch.setattr(sphinx_panel, "metrics_text", lambda *asked: "The metrics.")
    panel = panel_of(folder, tmp_path, monkeypatch, lesson="l01")
    assert not [n for n in panel.findall(nodes.container) if "replay-block" in classes(n)]
    names = [figure["ids"] for figure in panel.findall(nodes.figure)]
    assert names == [["l01-amdgpu-initial"], ["l01-amdgpu-final"]]
    assert "The metrics." in panel.astext()


def classes(node):
    return node.get("classes", ()) if isinstance(node, nodes.Element) else ()


def test_warnings_are_escaped_and_folded():
    fold = "<details><summary>1 engine warnings</summary><ol><li>a &lt; b</li></ol></details>"
    assert sphinx_panel.warnings_html(["a < b"]) == fold
