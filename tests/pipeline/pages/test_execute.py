import re
import signal
import sys
import threading
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import Mock

import nbformat
import psutil
import pytest
from tiny_book import (
    LAB_FRONT,
    WRITE_BUNDLE,
    cell,
    make_book,
    notebook,
    raising,
    run_pages,
)

from robo_genesis.core.project import engine_cache_environment, engine_cache_folder
from robo_genesis.pipeline.pages import execute as execution
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.execute import Schedule, in_order
from robo_genesis.pipeline.pages.kernels import CleanKernelManager
from robo_genesis.pipeline.pages.page_folder import PageRefused
from robo_genesis.pipeline.pages.results import failure_report
from robo_genesis.pipeline.pages.store import places, stored_result

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
# As the system does when memory runs out.
MEMORY = "import os\nos.kill(os.getpid(), 9)"
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
    "long": notebook(cell("for k in range(9): print('x' * 600_000, flush=True)")),
    "memory": notebook(cell(MEMORY)),
    "twin": notebook(cell(GREEN)),  # the code of `good`
}


def execute(folder: Path, **settings):
    """Execute the book of a folder with its own store; return results by page."""
    pages = find_pages(folder / "book")
    results = run_pages(pages, folder, **settings)
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
    assert "6 of 8 pages failed." in report
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
        ("long", "OutputSize", "puts out 1,200,002 characters", 1),
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
    assert said in result.failure.message + result.log.read_text()
    assert result.seconds < 20


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    folder = tmp_path_factory.mktemp("lab")
    expected = raising("raise ValueError('no way')", "ValueError: no")
    make_book(folder, lab=notebook(cell(WRITE_BUNDLE), expected, front=LAB_FRONT))
    assert execute(folder)["lab"].status == "executed"
    return folder


def test_a_page_is_reused_unless_it_is_to_be_executed_again(lab):
    first = execute(lab)["lab"]
    assert first.status == "reused"
    assert first.bundle == first.folder / "outputs/cpu"
    said = []
    (first.folder / "outputs/cpu/manifest.json").write_text("damaged")
    again = execute(lab, say=lambda *words: said.append(words))["lab"]
    assert (again.status, again.folder) == ("executed", first.folder)
    assert "outputs/cpu/manifest.json changed since" in said[0][1]
    assert re.match(r"started: 2 cells, about \d+ s; its log: .*lab\.log$", said[2][1])
    assert execute(lab)["lab"].status == "reused"


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
    with pytest.raises(PageRefused, match=r"expected was 'ValueError: yes', but"):
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
assert len([*pathlib.Path({place!r}).glob("measured-*")]) == {count}"""


def test_cells_that_measure_time_run_when_no_other_page_does(tmp_path):
    """Three pages meet in their first cells; two of them then measure, one after the other.

    The fourth, for which there is no room at first, starts while both wait, and then
    measures last.
    """
    meets, measures = (
        {n: code.format(place=str(tmp_path), name=n) for n in "abc"}
        for code in (MEETS, MEASURES)
    )
    tag = ":tags: [alone]\n"
    pages = {
        name: notebook(cell(meets[name]), cell(measures[name], tag)) for name in "ab"
    }
    first, last = (LATER.format(place=str(tmp_path), count=n) for n in (0, 2))
    later = notebook(cell(first), cell(last, tag))
    make_book(tmp_path, **pages, c=notebook(cell(meets["c"] + ENDS)), d=later)
    results = execute(tmp_path, jobs=3, timeout=60)
    assert {result.status for result in results.values()} == {"executed"}, results


# What a cell waits for: the file that another page's first cell writes.
WRITES = "import pathlib\npathlib.Path({place!r}).touch()"
ENDS_AFTER = (
    "import pathlib, time\nwhile not pathlib.Path({place!r}).exists(): time.sleep(0.1)"
)


@pytest.mark.parametrize("tagged", [False, True])
@pytest.mark.parametrize("saved", [False, True])
def test_one_page_compiles_before_the_others_start(tmp_path, saved, tagged):
    """It is the first lab, until it ends, or the page with the tag, until its next cell."""
    place = str(tmp_path / "a_started")
    wait = cell(ENDS_AFTER.format(place=place))
    lab = notebook(cell(WRITE_BUNDLE), front=LAB_FRONT)
    books = {"a": notebook(cell(WRITES.format(place=place))), "b": lab}
    if tagged:
        books["c"] = notebook(cell("1", ":tags: [compiles-first]\n"), wait)
    make_book(tmp_path, **books)
    environment = engine_cache_environment(cache=tmp_path / "cache")
    kernels = engine_cache_folder(cache=tmp_path / "cache") / "kernels"
    (kernels / "manager").mkdir()  # the compiler makes it before it has a kernel
    (kernels / "manager" / ("T1.qdc" if saved else "asked.txt")).touch()
    said = []

    def say(name, event):  # a page and the first word of its event
        said.append(f"{name} {event.split()[0].strip(':')}")

    results = execute(tmp_path, jobs=2, environment=environment, say=say)
    assert {result.status for result in results.values()} == {"executed"}
    order = ["a started", "b started"]
    if not saved:
        order = ["c started", "a started"] if tagged else ["b started", "b executed"]
    assert said[1:3] == order


def waiting(lesson="l04", expected=1.0, alone=0):
    """A page that waits for its start: of a lesson, for a run of so many seconds."""
    page = SimpleNamespace(lesson=lesson, alone=alone)
    return Mock(page=page, expected=expected, waits=False)


def test_the_longest_pages_start_first_those_that_measure_time_last():
    long, longer, short, alone = runs = (
        waiting(expected=20.0),
        waiting(expected=30.0),
        waiting(expected=2.0),
        waiting(expected=90.0, alone=1),
    )
    assert in_order(runs) == [longer, long, short, alone]
    schedule = Schedule(runs, None, 2, Mock())
    assert schedule.left == "0 of 4 pages, about 2 min left"
    schedule.ended, schedule.expected, schedule.elapsed = 1, 10.0, 100.0
    assert schedule.left == "1 of 5 pages, about 3 min left"


def test_a_page_of_another_lesson_starts_beside_a_running_one():
    """Pages of one compile the same kernels, and a process saves its own when it ends."""
    first, second, other = waiting(), waiting(), waiting("l05")
    alone = waiting("l06", alone=1)
    schedule = Schedule([second, other], None, 2, Mock())
    assert schedule.next_page() is second
    schedule.running[first] = Mock()
    assert schedule.next_page() is other
    schedule.waiting = [second, alone]
    assert schedule.next_page() is second
    first.waits, schedule.waiting = True, [second, other]
    assert schedule.next_page() is second


def test_how_far_the_running_pages_are_is_said_now_and_then(tmp_path, monkeypatch):
    monkeypatch.setattr(execution, "EVERY", 0.5)
    make_book(tmp_path, page=notebook(cell("1"), cell("import time\ntime.sleep(2)")))
    said = []
    execute(tmp_path, say=lambda *words: said.append(" ".join(words)))
    pattern = re.compile(
        r"1 running: page: cell 2 of 2, \d s 0 of 1 pages, about 1 min left"
    )
    assert any(map(pattern.fullmatch, said)), said


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
import os, sys
from robo_genesis.core import text
names = os.environ["ROBO_GENESIS_PAGE_IMPORTS"].split()
assert names == ["robo_genesis.core", "robo_genesis.core.text"], names
print(sys.executable, "leaked" in globals(), os.listdir("."))
print(os.environ["GIVEN"], len(os.environ["ROBO_GENESIS_RUN_ID"]))"""
    make_book(tmp_path, page=notebook(cell(code)))
    assert execute(tmp_path, environment={"GIVEN": "yes"})["page"].status == "executed"
    [executed] = (tmp_path / "store/page").glob("*/executed.ipynb")
    [output] = nbformat.read(executed, as_version=4).cells[0].outputs
    assert output.text == f"{sys.executable} False []\nyes 32\n"


def test_ctrl_c_while_a_kernel_starts_kills_it(tmp_path, monkeypatch):
    start, started = CleanKernelManager.start_kernel, []

    async def start_and_interrupt(manager, **given):
        await start(manager, **given)
        started.append(manager.process.pid)
        signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)

    monkeypatch.setattr(CleanKernelManager, "start_kernel", start_and_interrupt)
    make_book(tmp_path, page=notebook(cell("import time\ntime.sleep(60)")))
    with pytest.raises(KeyboardInterrupt):
        execute(tmp_path)
    assert [psutil.pid_exists(pid) for pid in started] == [False]
