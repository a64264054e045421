"""The panel of a reference run shows its bundle, or why it does not."""

import shutil
from types import SimpleNamespace

import pytest
from bs4 import BeautifulSoup
from bundles import engine_on, written
from docutils import nodes
from docutils.utils import new_document
from spoilers import on
from without_sphinx import Panel, box, rows_of

from robo_genesis.core import project
from robo_genesis.core.files import put
from robo_genesis.evidence import bundle, recorder, report
from robo_genesis.evidence.compare import compare
from robo_genesis.pipeline.bundles.status import Status, recorded_status
from robo_genesis.sim import visual_shape
from robo_genesis.site.evidence import panel as sphinx_panel
from robo_genesis.site.evidence import provenance
from robo_genesis.site.evidence.runs import PageRun


def write_shape(folder, tmp_path):
    """Let this build's lecture have the shape of a bundle's links."""
    parts = [box(link) for link in bundle.read_arrays(folder).coords["link"]]
    visual_shape.write_shape(tmp_path / "l04" / "lecture" / "cpu", parts)


def accepted(page, folder, **more) -> PageRun:
    """An accepted run whose bundle is in a folder that is named after its backend."""
    status = Status("verified", folder.name, "", bundle.read_manifest(folder))
    return PageRun(page, folder, status, **more)


def test_frames_are_the_bundle_s_files_and_only_where_there_are_any(folder):
    run = accepted("l04/lab", folder)
    _, *found = sphinx_panel.pictures(run)
    for name, content, alt, _ in found:
        assert content == (folder / "frames" / name).read_bytes()
        state = name.removesuffix(".png")
        assert alt == f"Camera frame of the Franka, {state} state on cpu."
    shutil.rmtree(folder / "frames")
    assert (len(found), len(list(sphinx_panel.pictures(run)))) == (2, 1)


@pytest.fixture
def record(folder, tmp_path, built, courses_pages):
    """Record the bundle on another backend; this build's outputs and shape are in `tmp_path`."""
    built({f"l04/{page}": tmp_path / "l04" / page for page in ("lab", "lecture")})
    write_shape(folder, tmp_path)

    def run(backend="amdgpu", lesson="l04") -> PageRun:
        copy = shutil.copytree(folder, tmp_path / "book" / "evidence" / lesson / "cpu")
        return accepted(f"{lesson}/lab", on(backend)(copy), recorded=True)

    return run


def test_the_comparison_names_both_runs_and_all_else_one(
    folder, tmp_path, record, monkeypatch
):
    both_runs = accepted("l04/lab", folder), record("cuda")
    monkeypatch.setattr(provenance, "measured_pages", lambda book: {})
    monkeypatch.setattr(
        provenance, "all_runs", lambda book: {run.key: run for run in both_runs}
    )
    env = SimpleNamespace(srcdir=tmp_path / "book", docname="page", found_docs=())
    document = new_document("page")
    panel = Panel(tmp_path / "book").panel(both_runs[1])
    document += nodes.section("", nodes.title("", "Page"), panel, ids=["page"])
    for image in document.findall(nodes.image):
        image["uri"] = image["uri"].removeprefix("/")
    builder = SimpleNamespace(get_relative_uri=lambda page, to: f"{to}.html")
    provenance.read_page(SimpleNamespace(env=env, builder=builder), document)

    ours, theirs = (
        provenance.of_runs(False, [of]).removeprefix("Measured ") for of in both_runs
    )
    places = document.findall(lambda n: "provenance" in classes(n))
    lines = [BeautifulSoup(n.astext(), "html.parser").span.text for n in places]
    alone, compared = f"Measured {theirs}", f"Measured {ours} and {theirs}"
    assert (ours[:9], theirs[:10]) == ("on cpu · ", "on cuda · ")
    assert lines == [alone] * 6 + [compared] * 2


@pytest.mark.parametrize(
    ("actual", "facts", "axis"),
    [
        (
            "amdgpu",
            {"HIP, CUDA": "7.1.25424, –", "renderer": "AMD Instinct (radeonsi)"},
            "backend cpu → amdgpu",
        ),
        (
            "cuda",
            {"HIP, CUDA": "–, 13.0", "renderer": "NVIDIA H100/PCIe/SSE2"},
            "backend cpu → cuda",
        ),
        ("cpu", {"HIP, CUDA": "–, –", "renderer": "llvmpipe"}, "repeat"),
    ],
)
def test_what_the_recorder_writes_on_each_backend_is_accepted_shown_and_compared(
    folder, tmp_path, record, engine, experiment, monkeypatch, actual, facts, axis
):
    drivers = {"amdgpu": "the driver of amdgpu", "cuda": "the driver of cuda"}
    monkeypatch.setattr(recorder, "driver_version", drivers.get)
    there = engine_on(engine, actual)
    left = written(there, tmp_path / "outputs", "l04", "lab", experiment)
    place = tmp_path / "book" / "evidence" / "l04" / left.name
    put(left, place)
    status = recorded_status(tmp_path / "book", "l04", actual)
    assert (status.badge, place.name) == (f"{actual}-verified", actual)
    panel = Panel(tmp_path / "book").panel(
        PageRun("l04/lab", place, status, recorded=True)
    )
    shown = dict(row for row in rows_of([panel]) if len(row) == 2)
    facts |= {"device": there.backend.device_name, "driver": drivers.get(actual, "–")}
    facts["backend requested, actual"] = f"{there.backend.requested}, {actual}"
    assert shown | facts == shown
    assert "Compared with this build's run on cpu: equal." in panel.astext()
    assert report.summary(compare(folder, place)).startswith(f"L04 lab: {axis}\nEqual.")


def test_a_recorded_run_replays_from_its_own_record(tmp_path, record):
    panel = Panel(tmp_path / "book").panel(record())
    (block,) = [
        n for n in panel.findall(nodes.container) if "replay-block" in classes(n)
    ]
    assert block["evidence_runs"] == ("l04/lab/amdgpu/recorded",)
    name = "replay-l04-lab-amdgpu-recorded"
    assert f'data-model="../replay/{name}.js"' in block[0].astext()


@pytest.mark.parametrize("state", ["inconclusive", "stale", "failed", "refused"])
def test_a_run_that_is_not_verified_shows_its_state_alone(tmp_path, record, state):
    run = record()
    manifest = run.status.manifest if state == "inconclusive" else None
    status = Status(state, "amdgpu", "Found a, expected b.", manifest, summary="Why.")
    panel = Panel(tmp_path / "book").panel(PageRun("l04/lab", run.folder, status, True))
    text = f"No figures from amdgpu for Genesis {project.engine_pin()} (amdgpu-{state}). Why."
    assert panel.astext().startswith(text)
    shown = (nodes.image, nodes.table, nodes.raw, nodes.bullet_list)
    assert not [n for n in panel.findall(nodes.Element) if isinstance(n, shown)]


def test_a_run_that_was_never_recorded_has_no_panel(tmp_path, record, monkeypatch):
    status = Status("missing", "amdgpu", "None.", None, summary="None.")
    absent = PageRun("l04/lab", tmp_path, status, recorded=True)
    monkeypatch.setattr(sphinx_panel, "recorded_runs", lambda *asked: (absent,))
    panel = Panel(tmp_path / "book")
    panel.arguments = ["l04"]
    assert panel.shown() == []


def classes(node):
    return node.get("classes", ()) if isinstance(node, nodes.Element) else ()
