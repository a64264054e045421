import re
import signal
import sys
import threading
from multiprocessing.context import SpawnProcess
from pathlib import Path
from types import SimpleNamespace

import nbformat
import psutil
import pytest
from tiny_book import LAB_FRONT, WRITE_BUNDLE, cell, make_book, notebook, raising

from robo_genesis.core.project import (
    ROOT,
    engine_cache_environment,
    engine_cache_folder,
)
from robo_genesis.pipeline.pages import opened
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.execute import Lines, execute_pages, in_order
from robo_genesis.pipeline.pages.folder import PageRefused, read_record
from robo_genesis.pipeline.pages.results import failure_report
from robo_genesis.pipeline.pages.store import failed_mark, places, stored_result

CHECK = """\
import sys
print("early line", file=sys.stderr)
for number in range(20):
    print(f"\\x1b[31mengine line {number}\\x1b[0m", file=sys.stderr)
class CheckFailed(Exception): pass"""

GREEN = """\
for k in range(2000): print(f"{k} %", end="\\r")
print("\\x1b[32mtwo\\x1b[0m")
import warnings
warnings.warn("old")"""

# The kernel passes on what is written to its file descriptors; a moment lets it do so.
LAST_WORDS = """\
import os, time
os.write(2, b"last words\\n")
time.sleep(1)
os._exit(3)"""
LINKED = WRITE_BUNDLE + '\n(folder / "log.txt").symlink_to("/etc/hostname")'
# As the system does when memory runs out.
MEMORY = "import os\nos.kill(os.getpid(), 9)"
KILLS = "import os, signal\nos.kill(os.getppid(), signal.SIGKILL)\nimport time; time.sleep(60)"
BROKEN = {
    "good": notebook(cell(GREEN)),
    "check": notebook(
        cell(CHECK), cell("# proof\nraise CheckFailed('[factor] kp,\\nkv too')")
    ),
    "dead": notebook(cell(LAST_WORDS)),
    "slow": notebook(
        cell("import time\ntime.sleep(60)"), front="execution: {timeout: 2}\n"
    ),
    "bundle": notebook(cell("5 + 1"), front=LAB_FRONT.replace("lab", "more")),
    "link": notebook(cell(LINKED), front=LAB_FRONT),
    "killed": notebook(cell(KILLS)),
    "long": notebook(cell("for k in range(9): print('x' * 600_000, flush=True)")),
    "memory": notebook(cell(MEMORY)),
    "twin": notebook(cell(GREEN)),  # the code of `good`
}


def execute(folder: Path, **settings):
    """Execute the book of a folder with its own store; return results by page."""
    pages = find_pages(folder / "book")
    results = execute_pages(pages, places(pages, folder / "store"), **settings)
    return {result.page.docname: result for result in results}


@pytest.fixture(scope="module")
def broken(tmp_path_factory):
    folder = tmp_path_factory.mktemp("broken")
    make_book(folder, **BROKEN)
    with (
        pytest.MonkeyPatch.context() as changed
    ):  # a socket's path may have 107 characters
        changed.setattr("tempfile.tempdir", str(tmp_path_factory.mktemp("long" * 30)))
        return folder, execute(folder, jobs=2, environment={"TMPDIR": "/tmp"})


def test_all_pages_are_tried_and_only_good_ones_are_stored(broken):
    results = broken[1]
    assert list(results) == list(BROKEN)
    assert {name for name in results if results[name].status == "executed"} == {
        "good",
        "twin",
    }
    assert {result.status for result in results.values()} == {"executed", "failed"}
    stored = {path.parts[-3]: path for path in (broken[0] / "store").rglob("*.ipynb")}
    assert sorted(stored) == ["good", "twin"]
    printed, warned = nbformat.read(stored["good"], 4).cells[0].outputs
    assert (
        printed.text == "two\n"
    )  # without colour, and without what a terminal overwrites
    assert warned.text == 'cell:4: UserWarning: old\n  warnings.warn("old")\n'


def test_a_failing_check_is_reported_whole_with_cell_and_last_log_lines(broken):
    report = failure_report(list(broken[1].values()))
    assert "8 of 10 pages failed." in report
    place = report.index("check, code cell 2, line ")
    part = report[place : report.index("\n\n", place)]
    assert part.startswith(
        "check, code cell 2, line 19: raise CheckFailed('[factor] kp,\\nkv"
    )
    assert "    CheckFailed: [factor] kp,\n    kv too\n" in part
    assert "    | engine line 5\n" in part
    assert part.endswith("    | engine line 19")
    assert "engine line 4\n" not in part


@pytest.mark.parametrize(
    ("name", "error", "said", "cell"),
    [
        ("dead", "DeadKernelError", "last words", 1),
        ("slow", "CellTimeoutError", "2 seconds", 1),
        (
            "bundle",
            "BundleMissing",
            "the run left no l04/more/<backend>/manifest.json",
            None,
        ),
        ("link", "NotStored", "files: outputs/cpu/log.txt is a link or device", None),
        ("long", "OutputSize", "puts out 2 lines, 1,200,002 characters.", 1),
        (
            "killed",
            "WorkerDied",
            "ended in cell 1 with SIGKILL (Killed). If nobody stopped",
            None,
        ),
        (
            "memory",
            "DeadKernelError",
            "SIGKILL (Killed). If nobody stopped it, the memory",
            1,
        ),
    ],
)
def test_each_kind_of_failure_is_named(broken, name, error, said, cell):
    result = broken[1][name]
    assert (result.failure.error, result.failure.cell) == (error, cell)
    assert said in "\n".join([result.failure.message, *result.failure.log])
    assert result.seconds < 20


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    folder = tmp_path_factory.mktemp("lab")
    expected = raising("raise ValueError('no way')", "ValueError: no")
    make_book(folder, lab=notebook(cell(WRITE_BUNDLE), expected, front=LAB_FRONT))
    assert execute(folder)["lab"].status == "executed"
    return folder


def test_a_page_is_reused_unless_it_is_to_be_executed_again(lab):
    first, second = execute(lab)["lab"], execute(lab)["lab"]
    assert (first.status, second.status) == ("reused", "reused")
    assert first.run_id == second.run_id
    assert first.bundle == first.folder / "outputs/cpu"
    said = []
    again = execute(lab, reuse=False, report=Lines(lambda *words: said.append(words)))[
        "lab"
    ]
    assert (again.status, again.folder) == ("executed", first.folder)
    assert re.match(r"started: 2 cells, about \d+ s$", said[0][1])
    assert execute(lab)["lab"].run_id == again.run_id != first.run_id


def test_a_run_that_fails_with_the_same_code_keeps_the_page(tmp_path):
    make_book(
        tmp_path, page=notebook(cell("import os\nassert 'FAIL' not in os.environ"))
    )
    before = execute(tmp_path)["page"].run_id
    failed = execute(tmp_path, reuse=False, environment={"FAIL": "1"})["page"]
    assert failed.failure.error == "AssertionError"
    assert execute(tmp_path)["page"].run_id == before


def test_an_edit_of_prose_or_metadata_is_checked_without_a_run(lab):
    page = lab / "book/lab.md"
    text = page.read_text()
    places_now = places(find_pages(lab / "book"), lab / "store")
    for old, new in (
        ("# Page", "# Another title"),
        ("ValueError: no", "ValueError: no way"),
    ):
        assert old in text
        page.write_text(text.replace(old, new))
        [now] = find_pages(lab / "book")
        assert stored_result(now, places_now["lab"]).status == "reused"
    page.write_text(text.replace("ValueError: no", "ValueError: yes"))
    [now] = find_pages(lab / "book")
    with pytest.raises(
        PageRefused, match=r"outcome: .* expected was 'ValueError: yes', but"
    ):
        stored_result(now, places_now["lab"])
    page.write_text(text)


MEET_AND_SAVE = """\
import atexit, os, pathlib, time
def save():
    time.sleep(6)
    pathlib.Path(os.environ["QD_OFFLINE_CACHE_FILE_PATH"], "{mine}").write_text("compiled")
atexit.register(save)
pathlib.Path({place!r}, "{mine}").touch()
while not pathlib.Path({place!r}, "{theirs}").exists(): time.sleep(0.05)"""


def test_pages_run_at_the_same_time_and_save_what_they_compiled_even_where_they_fail(
    tmp_path,
):
    """Each page waits for a file of the other: one after the other, both would time out.

    They save in an exit handler, as the engine does; six seconds are more than
    Jupyter's usual wait."""
    good = cell(MEET_AND_SAVE.format(mine="good", theirs="bad", place=str(tmp_path)))
    bad = cell(MEET_AND_SAVE.format(mine="bad", theirs="good", place=str(tmp_path)))
    make_book(tmp_path, good=notebook(good), bad=notebook(bad, cell("1 / 0")))
    caches = engine_cache_environment(cache=tmp_path / "cache")
    folder = engine_cache_folder(cache=tmp_path / "cache") / "kernels"
    results = execute(tmp_path, jobs=2, timeout=20, environment=caches)
    assert [result.status for result in results.values()] == ["executed", "failed"]
    assert "ZeroDivisionError" in results["bad"].failure.error
    assert sorted(path.name for path in folder.iterdir()) == ["bad", "good"]


MEASURES = """\
import pathlib, time
here = pathlib.Path({place!r})
assert (here / "ended").exists()
(here / "measuring").touch(exist_ok=False)
time.sleep(0.5)
(here / "measuring").unlink()
(here / "measured-{name}").touch()"""
MEETS = """\
import pathlib, time
here = pathlib.Path({place!r})
(here / "met-{name}").touch()
while len([*here.glob("met-*")]) < 3: time.sleep(0.05)"""
ENDS = "\ntime.sleep(1)\n(here / 'ended').touch()"


LATER = """\
import pathlib
assert len([*pathlib.Path({place!r}).glob("measured-*")]) == 2"""


def test_cells_that_measure_time_run_when_no_other_page_does(tmp_path):
    """Three pages meet in their first cells; two of them then measure, one after the other.

    The fourth, for which there is no room at first, waits until both have measured.
    """
    meets, measures = (
        {n: code.format(place=str(tmp_path), name=n) for n in "abc"}
        for code in (MEETS, MEASURES)
    )
    tag = ":tags: [alone]\n"
    pages = {
        name: notebook(cell(meets[name]), cell(measures[name], tag)) for name in "ab"
    }
    later = notebook(cell(LATER.format(place=str(tmp_path))), cell("1", tag))
    make_book(tmp_path, **pages, c=notebook(cell(meets["c"] + ENDS)), d=later)
    results = execute(tmp_path, jobs=3, timeout=60)
    assert {result.status for result in results.values()} == {"executed"}, results
    waited = [
        results[name].seconds - read_record(results[name].folder).seconds
        for name in "ab"
    ]
    assert max(waited) > 0.5  # the record has the time without waiting


def noting(said: list) -> Lines:
    """Note each start and end of a page; an event is cut to its first word."""
    return Lines(lambda name, event: event and said.append((name, event[:7])))


def test_a_page_that_was_not_accepted_is_the_first_to_run_again(tmp_path):
    make_book(tmp_path, a=notebook(cell("1")), b=notebook(cell("1"), cell("2")))
    said = []

    def accept(result):
        said.append((result.page.docname, "judged"))
        return result.page.docname == "b"

    results = execute(tmp_path, report=noting(said), accept=accept)
    order = [("b", "started"), ("b", "execute"), ("a", "started"), ("b", "judged")]
    assert said[:4] == order
    marks = [failed_mark(result.folder).exists() for result in results.values()]
    assert marks == [True, False]
    execute(tmp_path, report=noting(said), reuse=False)
    assert not failed_mark(results["a"].folder).exists()
    assert [name for name, event in said if event == "started"] == ["b", "a", "a", "b"]


ENDS_AFTER_C = (
    "\nimport time\nwhile not [*pathlib.Path({store!r}).glob('*/executed.ipynb')]:"
)
ENDS_AFTER_C += " time.sleep(0.1)\ntime.sleep(1)"


@pytest.mark.parametrize("saved", [False, True])
def test_beside_the_first_lab_runs_what_has_own_kernels_while_none_is_compiled(
    tmp_path, saved
):
    """The page with kernels of its own ends before the lab; that starts no other page."""
    lab = cell(WRITE_BUNDLE + ENDS_AFTER_C.format(store=str(tmp_path / "store" / "c")))
    more, own = cell("1"), cell("1", ":tags: [own-kernels]\n")
    own_first = notebook(
        own, more, more
    )  # more cells than the lab, which yet starts first
    books = {
        "a": notebook(more, more),
        "b": notebook(lab, front=LAB_FRONT),
        "c": own_first,
    }
    books["d"] = notebook(own, cell("1", ":tags: [alone]\n"))  # never among the first
    make_book(tmp_path, **books)
    environment = engine_cache_environment(cache=tmp_path / "cache")
    kernels = engine_cache_folder(cache=tmp_path / "cache") / "kernels"
    (kernels / "manager").mkdir()  # the compiler makes it before it has a kernel
    (kernels / "manager" / ("T1.qdc" if saved else "asked.txt")).touch()
    said = []
    results = execute(tmp_path, jobs=2, environment=environment, report=noting(said))
    assert {result.status for result in results.values()} == {"executed"}
    if saved:
        assert [name for name, event in said if event == "started"] == [
            "c",
            "a",
            "b",
            "d",
        ]
    else:
        start, end = "started", "execute"
        order = [
            ("b", start),
            ("c", start),
            ("c", end),
            ("b", end),
            ("a", start),
            ("d", start),
        ]
        assert said[:6] == order


def test_a_store_that_cannot_be_used_is_named_before_any_run(tmp_path):
    make_book(tmp_path, page=notebook(cell("1")))
    (tmp_path / "store").mkdir()
    (tmp_path / "store" / "page").symlink_to("no folder/page")
    said = []
    with pytest.raises(OSError, match=str(tmp_path / "store" / "page")):
        execute(tmp_path, report=Lines(lambda *words: said.append(words)))
    assert said == []


def test_failed_pages_start_first_then_new_ones_with_many_cells_then_the_longest(
    tmp_path,
):
    cells = {"a": 1, "b": 1, "c": 1, "d": 9, "e": 2}
    books = {name: notebook(*[cell("1")] * n) for name, n in cells.items()}
    make_book(tmp_path, **books, f=notebook(*[cell("1", ":tags: [alone]\n")] * 9))
    last = {
        name: SimpleNamespace(seconds=s)
        for name, s in (("a", 2.0), ("c", 30.0), ("d", 2.0))
    }
    pages = find_pages(tmp_path / "book")
    found = in_order(pages, {"b": None, "e": None, "f": None} | last, ["a"])
    assert [page.docname for page in found] == ["a", "e", "b", "c", "d", "f"]


def test_kernels_are_clean(tmp_path, monkeypatch):
    """A user's kernelspec, start-up file and search path do not reach the page; its imports do."""
    spec = tmp_path / "jupyter/kernels/python3"
    spec.mkdir(parents=True)
    (spec / "kernel.json").write_text(
        '{"argv": ["/bin/false"], "display_name": "python3"}'
    )
    startup = tmp_path / "ipython/profile_default/startup"
    startup.mkdir(parents=True)
    (startup / "leak.py").write_text("leaked = 1")
    monkeypatch.setenv("JUPYTER_DATA_DIR", str(tmp_path / "jupyter"))
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path / "ipython"))
    code = """\
import inspect, os, sys
from robo_genesis.core import text
names = os.environ["ROBO_GENESIS_PAGE_IMPORTS"].split()
assert names == ["robo_genesis.core", "robo_genesis.core.text"], names
assert "<frozen importlib._bootstrap>" in inspect.modulesbyfile  # the engine's searches are spared
print(sys.executable, "leaked" in globals(), os.listdir("."))
print(os.environ["GIVEN"], len(os.environ["ROBO_GENESIS_RUN_ID"]))"""
    make_book(tmp_path, page=notebook(cell(code)))
    assert execute(tmp_path, environment={"GIVEN": "yes"})["page"].status == "executed"
    [executed] = (tmp_path / "store/page").glob("*/executed.ipynb")
    [output] = nbformat.read(executed, as_version=4).cells[0].outputs
    assert output.text == f"{sys.executable} False []\nyes 32\n"


READS = """\
import importlib, mujoco, os, pathlib
os.chdir({away!r})
mujoco.MjModel.from_xml_path("arm.xml")
mujoco.MjSpec.from_string(f"<mujoco><asset><mesh file='{{os.getcwd()}}/a.obj'/></asset></mujoco>")
for name, mode in (("relative", "r"), (os.fsencode({away!r} + "/bytes"), "r+"), ("added", "a+")):
    open(name, mode).close()
os.close(os.open("low", os.O_RDONLY))
pathlib.Path({root!r}, "README.md").read_text()
importlib.import_module("robo_genesis.core." + "palette")
pathlib.Path("written").write_text("only written")"""
MODEL = {
    "arm.xml": """<mujoco><include file="sub/tool.xml"/><worldbody>
        <geom type="mesh" mesh="tool"/></worldbody></mujoco>""",
    "sub/tool.xml": '<mujoco><asset><mesh name="tool" file="tool.obj"/></asset></mujoco>',
    "sub/tool.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4",
    "a.obj": "",
}
"""A model with what it includes, which compiled code opens, and a mesh of another one."""
READ = ("relative", "bytes", "added", "low", *MODEL, "README.md", "core/palette.py")
OWN = """\
import os, pathlib, tempfile
from robo_genesis.core import text
for name in ("own", {away!r} + "/made"):
    pathlib.Path(name).write_text("own")
with tempfile.NamedTemporaryFile() as file:
    for name in ("own", {away!r} + "/made", file.name, "/etc/passwd", os.__file__, text.__file__):
        open(name, "rb").close()"""


def test_a_page_that_reads_a_file_which_no_key_covers_is_refused_by_its_name(tmp_path):
    (tmp_path / "sub").mkdir()
    for name in READ[:8]:
        (tmp_path / name).write_text(MODEL.get(name, ""))
    codes = {"refused": READS, "accepted": OWN}
    place = {"away": str(tmp_path), "root": str(ROOT)}
    make_book(
        tmp_path,
        **{name: notebook(cell(of.format(**place))) for name, of in codes.items()},
    )
    results = execute(tmp_path, jobs=2)
    assert results["accepted"].status == "executed", results["accepted"].failure
    failure = results["refused"].failure
    names = failure.message.partition("): ")[2].partition(". It would not")[0]
    assert failure.error == "FileNotKeyed"
    assert [
        n for n in READ if not any(p.endswith(f"/{n}") for p in names.split(", "))
    ] == []


def test_of_the_files_in_folders_of_the_system_a_model_is_refused(
    tmp_path, monkeypatch
):
    share, runtime = tmp_path / "share", tmp_path / "runtime"
    monkeypatch.setattr(opened, "SYSTEM", (str(share),))
    monkeypatch.setenv(opened.RUNTIME, str(runtime))
    for folder in (share, runtime):
        folder.mkdir()
        for name in ("arm.urdf", "TOOL.STL", "table.csv"):
            (folder / name).touch()
    noted = [*share.iterdir(), *runtime.iterdir()]
    (runtime / "opened").write_text("\0".join(map(str, noted)))
    assert opened.unkeyed_files([]) == [
        str(share / name) for name in ("TOOL.STL", "arm.urdf")
    ]


def test_ctrl_c_while_a_worker_starts_kills_it(tmp_path, monkeypatch):
    start, started = SpawnProcess.start, []

    def start_and_interrupt(process):
        start(process)
        started.append(process)
        signal.pthread_kill(threading.get_ident(), signal.SIGINT)

    monkeypatch.setattr(SpawnProcess, "start", start_and_interrupt)
    make_book(tmp_path, page=notebook(cell("import time\ntime.sleep(60)")))
    with pytest.raises(KeyboardInterrupt):
        execute(tmp_path)
    assert [psutil.pid_exists(process.pid) for process in started] == [False]
