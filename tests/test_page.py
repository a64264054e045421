"""A page while it runs, with an engine that is not real."""

import json
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from bundles import RENDERER, RUN_ID
from IPython.core.interactiveshell import ExecutionResult
from lessons.body_runs import make_drop
from lessons.exercise_cells import solutions

import __main__
import robo_genesis as rg
from robo_genesis import page as pages
from robo_genesis.core import project, shown, tables
from robo_genesis.core.checks import CheckFailed
from robo_genesis.core.exercises import FunctionFailed
from robo_genesis.lessons.l02 import exercises, plots, spec, text
from robo_genesis.sim import session

SOLVED = solutions("l02")
FRAME = np.arange(540 * 720 * 3, dtype=np.uint32).astype(np.uint8).reshape(540, 720, 3)


@pytest.fixture
def displayed(monkeypatch):
    """What a page displays: (data, metadata)."""
    kept = []
    monkeypatch.setattr(
        pages,
        "display",
        lambda data, metadata, raw: kept.append((data, metadata["robo_genesis"])),
    )
    return kept


@pytest.fixture
def page(quiet, tmp_path, monkeypatch, engine, displayed):
    """L02's lab, opened in a folder of its own; its engine is not real."""
    for name in ("BACKEND", "RENDER"):
        monkeypatch.delenv(f"ROBO_GENESIS_{name}", raising=False)
    monkeypatch.setenv("ROBO_GENESIS_OUTPUTS_DIR", str(tmp_path / "outputs"))
    monkeypatch.setenv("ROBO_GENESIS_RUN_ID", RUN_ID)
    monkeypatch.setattr(session, "started", lambda contract: engine)
    monkeypatch.setattr(pages, "_opened", [])
    monkeypatch.setattr(pages.cameras, "read_renderer", lambda scene: RENDERER)
    return rg.open_page("l02", "lab")


def measure(page):
    """Fill a page with a synthetic drop that passes every check."""
    frames = iter((FRAME, FRAME[::-1]))
    camera = SimpleNamespace(render=lambda **_: [next(frames)])
    page.readings |= {
        "model": spec.EXPECTED_MODEL,
        "body": {"mass": spec.BASELINE.mass},
    }
    page.capture(camera, "initial")
    page.traces["baseline"] = make_drop(spec.BASELINE)
    page.capture(camera, "final")


@pytest.mark.parametrize(
    ("run_id", "compiled", "lines"),
    [(None, False, 4), (RUN_ID, False, 0), (None, True, 0)],
)
def test_a_reader_s_first_start_says_what_the_next_minutes_do(
    page, tmp_path, monkeypatch, capsys, run_id, compiled, lines
):
    monkeypatch.setattr(pages, "_opened", [])
    monkeypatch.setenv(project.KERNELS, str(tmp_path))
    monkeypatch.delenv(project.RUN_ID)
    if run_id:
        monkeypatch.setenv(project.RUN_ID, run_id)
    if compiled:
        (tmp_path / "one.qdc").touch()
    rg.open_page("l02", "lab")
    said = capsys.readouterr().out.splitlines()
    assert [line[:13] for line in said[1:]] == [
        f"Step {n} of 3: "[:13] for n in range(1, lines)
    ]
    assert len(said) == lines


def test_the_names_are_loaded_only_when_used():
    code = (
        "import sys, robo_genesis; "
        "assert not {'numpy', 'matplotlib', 'robo_genesis.page'} & sys.modules.keys()"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=project.ROOT)
    with pytest.raises(AttributeError, match=r"no 'openpage'. Names: .*open_page"):
        rg.openpage  # noqa: B018


def test_a_page_is_opened_once_and_only_by_a_known_name(page):
    assert (page.render, list(page.links)) == (True, [spec.LINK])
    with pytest.raises(
        session.EngineError, match=r"l02/lab is open .*Restart the kernel"
    ):
        rg.open_page("l02", "lecture")
    with pytest.raises(LookupError, match=r"l02/extra .*Choices: l02/lab, l02/lecture"):
        rg.open_page("l02", "extra")


def test_a_page_without_an_engine_is_refused(monkeypatch, tmp_path):
    monkeypatch.setenv("ROBO_GENESIS_OUTPUTS_DIR", str(tmp_path))
    monkeypatch.setattr(
        session, "import_engine", lambda: SimpleNamespace(_initialized=False)
    )
    monkeypatch.setattr(pages, "_opened", [])
    with pytest.raises(session.EngineError, match="not initialised"):
        rg.open_page("l02", "lab")
    assert pages._opened == []


def test_a_function_of_the_experiment_is_shown_with_its_name(page, displayed):
    measure(page)
    page.show(text.metric_table)
    page.show(plots.height)
    (table, named), (drawing, drawn) = displayed
    assert named == {
        "function": "robo_genesis.lessons.l02.text.metric_table",
        "arguments": [],
    }
    assert list(table) == ["text/markdown"]
    assert "distance fallen" in table["text/markdown"]
    assert list(drawing) == ["image/svg+xml"]
    assert drawn["function"].endswith("l02.plots.height")
    assert shown.mime_data(drawn["function"], page.experiment, []) == drawing


@pytest.mark.parametrize(
    ("function", "arguments", "message"),
    [
        (lambda run: "", (), "cannot be shown"),
        ("a table", (), r"'a table'. Give a function of a lesson and not its result"),
    ],
)
def test_anything_else_is_refused(page, displayed, function, arguments, message):
    measure(page)
    with pytest.raises(shown.ShownError, match=message):
        page.show(function, *arguments)
    assert displayed == []


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("os.system", "cannot be shown"),
        ("robo_genesis.lessons.l02.text.tables", "cannot be shown"),
        ("robo_genesis.core.checks.model_counts", "returned generator"),
    ],
)
def test_only_functions_that_return_a_table_or_figure_are_shown(page, name, message):
    measure(page)
    with pytest.raises(shown.ShownError, match=message):
        shown.mime_data(name, page.experiment, [{}])


def test_finish_shows_the_checks_writes_the_bundle_and_prints_the_verdict(
    page, displayed, capsys
):
    measure(page)
    page._written |= dict.fromkeys(page._written, 1)
    page.finish(None)
    assert displayed[-1][1] == {
        "function": shown.name_of(tables.checks_of_run),
        "arguments": [],
    }
    assert "**FAILED**" not in displayed[-1][0]["text/markdown"]
    lines = capsys.readouterr().out.splitlines()
    assert lines[-1] == "L02 CHECK: PASSED"
    assert lines[-2] == "functions 4 of 4"
    assert lines[-3] == "The bundle is in outputs/l02/lab/cpu."
    manifest = json.loads((page._recorder.folder / "manifest.json").read_text())
    assert manifest["run_id"] == RUN_ID
    page.readings["body"] = {"mass": 2 * spec.BASELINE.mass}
    for _ in range(2):  # what passed is kept once, and not replaced by what failed
        with pytest.raises(CheckFailed, match=r"L02 CHECK: FAILED \[mass\]"):
            page.finish(None)
        kept = page._recorder.folder.with_name("cpu-passed") / "manifest.json"
        assert json.loads(kept.read_text()) == manifest
    assert "**FAILED**" in displayed[-1][0]["text/markdown"]
    said = capsys.readouterr().out
    assert said.count("cpu-passed keeps the earlier bundle, which passed.") == 1
    assert "PASSED" not in said


def usable_frame(rgb):
    return rgb["wide"]


def test_functions_are_counted_and_a_failed_one_is_shown_without_our_frames(
    page, capsys
):
    measure(page)
    page._written |= {"make_scene": 1, "record": 1}
    page.test(exercises.stepped, SOLVED["stepped"])
    with pytest.raises(FunctionFailed) as failed:
        page.test(exercises.usable_frame, usable_frame)
    first, *_, line = failed.value._render_traceback_()
    assert first == "usable_frame does not pass its test yet."
    assert line.endswith('of its cell: return rgb["wide"]')
    with pytest.raises(
        LookupError, match=r"test_\w+ is not declared\. Functions: make_scene"
    ):
        page.test(exercises.stepped, test_without_a_camera_no_frame_is_taken)
    page.finish(None)
    last = capsys.readouterr().out.splitlines()[-2:]
    assert last == [
        "functions 3 of 4",
        "L02 CHECK: INCOMPLETE, not passed: usable_frame",
    ]
    metrics = json.loads((page._recorder.folder / "metrics.json").read_text())
    assert {
        name: of["value"] for name, of in metrics["functions"].items()
    } == page._written


@pytest.mark.parametrize(
    ("error", "code", "said"),
    [
        (TypeError(), "at, turn = record(2)", "No passed test yet: record."),
        (TypeError(), "1 + at", "Begin with the first cell that has an error."),
        (SyntaxError(), "def stepped(:", "No passed test yet: stepped."),
        (NameError(), "record(at)", "Begin with the first cell that has an error."),
        (TypeError(), "def stepped(t): ...\nrecord()", "No passed test yet: record."),
        (session.EngineError(), "gs.init()", None),
        (session.EngineError(), "build(record)", "No passed test yet: record."),
        (KeyboardInterrupt(), "record(2)", None),
        (None, "record(2)", None),
    ],
)
def test_after_an_error_the_next_cells_run_and_a_reader_knows_what_is_missing(
    page, capsys, monkeypatch, error, code, said
):
    page._written["stepped"] = 1
    monkeypatch.setitem(vars(__main__), "stepped", None)
    cell = SimpleNamespace(raw_cell=code, cell_id="a")
    result = ExecutionResult(cell)
    result.error_in_exec, result.execution_count = error, 7
    page.go_on(result)
    assert capsys.readouterr().out == (f"{said}\n" if said else "")
    assert page._errors == ({"a": "[7]"} if said else {})
    assert hasattr(__main__, "stepped") == bool(page._written["stepped"])
    passes_on = isinstance(error, Exception)
    assert result.error_in_exec is (None if passes_on else error)
    page.begin(cell)
    assert page._errors == {}


def test_without_a_camera_no_frame_is_taken(page, monkeypatch):
    page.render = False
    page.capture(None, "initial")
    assert page.frames == {}
    assert not page.experiment.rendered
    monkeypatch.setattr(pages, "_opened", [])
    assert not rg.open_page("l04", "formula").render  # the page declares none


def test_the_facts_name_the_backend(page, engine, capsys):
    assert (
        f"{engine.backend.actual} ({engine.backend.device_name})" in page.facts().data
    )
    page.require("boxes", same=True)
    assert capsys.readouterr().out == "L02 BOXES CHECK: PASSED\n"
