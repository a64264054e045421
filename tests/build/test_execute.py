import os
import signal
import subprocess
import sys
import threading
import time
from multiprocessing.context import SpawnProcess
from pathlib import Path

import psutil
import pytest
from tiny_book import LAB_FRONT, WRITE_BUNDLE, cell, make_book, notebook, raising

from robo_genesis.build.execute import execute_pages
from robo_genesis.build.page_cache import PageCache, notebooks_folder
from robo_genesis.build.page_results import failure_report
from robo_genesis.core.project import ROOT, engine_cache_environment, engine_cache_folder
from robo_genesis.lessons.book_pages import find_pages

CHECK = """\
import sys
print("early line", file=sys.stderr)
for number in range(20):
    print(f"\\x1b[31mengine line {number}\\x1b[0m", file=sys.stderr)
class CheckFailed(Exception): pass"""

# The kernel passes on what is written to its file descriptors; a moment lets it do so.
LAST_WORDS = """\
import os, time
os.write(2, b"last words\\n")
time.sleep(1)
os._exit(3)"""
BROKEN = {
    "good": notebook(cell("1 + 1")),
    "check": notebook(
        cell(CHECK), cell("# proof\nraise CheckFailed('[one_factor] kp changed,\\nkv too')")
    ),
    "dead": notebook(cell(LAST_WORDS)),
    "slow": notebook(cell("import time\ntime.sleep(60)"), front="execution: {timeout: 2}\n"),
    "calm": notebook(raising("2 + 1", "ValueError: no")),
    "other": notebook(raising("raise ValueError('maybe')", "ValueError: no")),
    "type": notebook(raising("raise KeyError('no')", "ValueError: no")),
    "silent": notebook(raising("raise ValueError('no')", None)),
    "untagged": notebook(cell("3 + 1", ':expects: "ValueError: no"\n')),
    "skipped": notebook(cell("4 + 1", ":tags: [skip-execution]\n")),
    "bundle": notebook(cell("5 + 1"), front=LAB_FRONT),
    "kernel": notebook(cell("6 + 1")).replace("python3", "some-users-kernel"),
    "twin": notebook(cell("1 + 1")),
}


def execute(folder: Path, **settings):
    """Execute the book of a folder with its own cache; return results by page."""
    results = execute_pages(find_pages(folder / "book"), folder / "cache", **settings)
    return {result.page.docname: result for result in results}


def outputs(folder: Path, docname: str) -> str:
    """Return the text that a page's cells printed, from the cache."""
    cache = PageCache(notebooks_folder(folder / "cache"))
    (page,) = [page for page in find_pages(folder / "book") if page.docname == docname]
    executed = cache.get_cache_bundle(cache.match_cache_notebook(page.notebook).pk).nb
    return "".join(out.get("text", "") for c in executed.cells for out in c.outputs)


@pytest.fixture(scope="module")
def broken(tmp_path_factory):
    folder = tmp_path_factory.mktemp("broken")
    make_book(folder, **BROKEN)
    return folder, execute(folder, jobs=2, environment={"TMPDIR": "/tmp"})


def failure(broken, name):
    failure = broken[1][name].failure
    return failure.error, failure.message, failure.cell


def test_all_pages_are_tried_and_the_good_one_is_executed(broken):
    results = broken[1]
    assert list(results) == list(BROKEN)
    assert results["good"].status == "executed"
    assert {results[name].status for name in BROKEN if name != "good"} == {"failed"}


def test_a_failing_check_is_reported_whole_with_cell_and_last_log_lines(broken):
    report = failure_report(list(broken[1].values()))
    assert "12 of 13 pages failed." in report
    place = report.index("check, code cell 2, line ")
    part = report[place : report.index("\n\n", place)]
    assert part.startswith("check, code cell 2, line 18: # proof\n")
    assert "    CheckFailed: [one_factor] kp changed,\n    kv too\n" in part
    assert "    | engine line 5\n" in part
    assert part.endswith("    | engine line 19")
    assert "engine line 4\n" not in part


def test_a_dead_kernel_is_a_failed_page(broken):
    assert failure(broken, "dead") == ("DeadKernelError", "Kernel died", 1)


def test_a_dead_kernel_leaves_its_last_words(broken):
    log = broken[1]["dead"].failure.log
    assert any("last words" in line for line in log)


def test_a_timeout_is_a_failed_page_and_names_the_limit_of_the_front_matter(broken):
    error, message, number = failure(broken, "slow")
    assert (error, number) == ("CellTimeoutError", 1)
    assert "2 seconds" in message
    assert broken[1]["slow"].seconds < 20


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("calm", "but the cell raised no exception."),
        ("other", "expected was 'ValueError: no', but the cell raised ValueError: maybe."),
        ("type", "but the cell raised KeyError: 'no'."),
        ("silent", "it raised ValueError: no. Add the option `expects:"),
        ("untagged", "without the tag raises-exception"),
        ("skipped", "skip-execution is not allowed"),
    ],
)
def test_an_exception_that_is_not_the_expected_one_fails_the_page(broken, name, said):
    error, message, number = failure(broken, name)
    assert (error, number) == ("ExpectedException", 1)
    assert said in message


def test_a_declared_bundle_that_was_not_written_fails_the_page(broken):
    error, message, _ = failure(broken, "bundle")
    assert error == "BundleMissing"
    assert "l04/lab/<backend>/manifest.json" in message
    assert broken[1]["bundle"].run_id in message


def test_only_the_kernel_of_this_environment_starts(broken):
    assert failure(broken, "kernel")[0] == "NoSuchKernel"


def test_pages_with_the_same_code_are_refused(broken):
    error, message, _ = failure(broken, "twin")
    assert error == "SameCode"
    assert "good" in message


def test_failed_pages_are_never_cached(broken):
    cached = list((notebooks_folder(broken[0] / "cache") / "executed").iterdir())
    assert len(cached) == 1


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    folder = tmp_path_factory.mktemp("lab")
    expected = raising("raise ValueError('no way')", "ValueError: no")
    make_book(folder, lab=notebook(cell(WRITE_BUNDLE), expected, front=LAB_FRONT))
    assert execute(folder)["lab"].status == "executed"
    return folder


def test_a_second_run_executes_nothing_and_finds_the_same_run(lab):
    first, second = execute(lab)["lab"], execute(lab)["lab"]
    assert (first.status, second.status) == ("reused", "reused")
    assert first.run_id == second.run_id
    assert first.bundle == lab / "cache/outputs/l04/lab/cpu"


def test_another_title_executes_nothing(lab):
    page = lab / "book/lab.md"
    page.write_text(page.read_text().replace("# Page", "# Another title"))
    assert execute(lab)["lab"].status == "reused"


def test_an_edited_expectation_is_checked_again_without_a_run(lab):
    page = lab / "book/lab.md"
    text = page.read_text()
    page.write_text(text.replace("ValueError: no", "ValueError: yes"))
    try:
        result = execute(lab)["lab"]
    finally:
        page.write_text(text)
    assert result.status == "failed"
    assert "expected was 'ValueError: yes'" in result.failure.message
    assert execute(lab)["lab"].status == "reused"


def test_a_removed_tag_is_seen_without_a_run(lab):
    page = lab / "book/lab.md"
    text = page.read_text()
    page.write_text(text.replace(":tags: [raises-exception]\n", "").replace(":expects:", ":name:"))
    try:
        result = execute(lab)["lab"]
    finally:
        page.write_text(text)
    assert "is not tagged raises-exception" in result.failure.message


def spoil_manifest(folder: Path) -> None:
    (folder / "cache/outputs/l04/lab/cpu/manifest.json").unlink()


def replace_run(folder: Path) -> None:
    manifest = folder / "cache/outputs/l04/lab/cpu/manifest.json"
    manifest.write_text('{"predicate": {"run_id": "of another run"}}')


def halve_notebook(folder: Path) -> None:
    (path,) = (folder / "cache/notebooks/executed").glob("*/base.ipynb")
    path.write_text(path.read_text()[:100])


def remove_notebook(folder: Path) -> None:
    (path,) = (folder / "cache/notebooks/executed").glob("*/base.ipynb")
    path.unlink()


@pytest.mark.parametrize("spoil", [spoil_manifest, replace_run, halve_notebook, remove_notebook])
def test_outputs_and_bundle_of_one_run_or_it_is_executed_again(lab, spoil):
    before = execute(lab)["lab"].run_id
    spoil(lab)
    result = execute(lab)["lab"]
    assert result.status == "executed"
    assert result.run_id != before
    assert execute(lab)["lab"].status == "reused"


def test_two_pages_run_at_the_same_time(tmp_path):
    """Each page waits for a file that the other one writes: one after the other, both time out."""
    meet = """\
import pathlib, time
pathlib.Path({place!r}, {mine!r}).touch()
while not pathlib.Path({place!r}, {theirs!r}).exists(): time.sleep(0.05)"""
    place = str(tmp_path)
    one = cell(meet.format(place=place, mine="one", theirs="two"))
    two = cell(meet.format(place=place, mine="two", theirs="one"))
    make_book(tmp_path, one=notebook(one), two=notebook(two))
    results = execute(tmp_path, jobs=2, timeout=20)
    assert [result.status for result in results.values()] == ["executed", "executed"]


SAVES_AT_EXIT = """\
import atexit, os, pathlib, time
def save():
    time.sleep(6)
    pathlib.Path(os.environ["QD_OFFLINE_CACHE_FILE_PATH"], "{name}").write_text("compiled")
atexit.register(save)"""


def test_what_pages_compiled_is_saved_even_where_they_fail(tmp_path):
    """As the engine does, in its exit handler; six seconds are more than Jupyter's usual wait."""
    good, bad = (cell(SAVES_AT_EXIT.format(name=name)) for name in ("good", "bad"))
    make_book(tmp_path, good=notebook(good), bad=notebook(bad, cell("1 / 0")))
    caches = engine_cache_environment(cache=tmp_path / "cache")
    results = execute(tmp_path, jobs=2, environment=caches)
    assert [result.status for result in results.values()] == ["executed", "failed"]
    folder = engine_cache_folder(cache=tmp_path / "cache") / "kernels"
    assert sorted(path.name for path in folder.iterdir()) == ["bad", "good"]


def test_kernels_are_clean(tmp_path, monkeypatch):
    """A user's kernelspec, start-up file and search path do not reach the page."""
    spec = tmp_path / "jupyter/kernels/python3"
    spec.mkdir(parents=True)
    (spec / "kernel.json").write_text('{"argv": ["/bin/false"], "display_name": "python3"}')
    startup = tmp_path / "ipython/profile_default/startup"
    startup.mkdir(parents=True)
    (startup / "leak.py").write_text("leaked = 1")
    monkeypatch.setenv("JUPYTER_PATH", str(tmp_path / "jupyter"))
    monkeypatch.setenv("JUPYTER_DATA_DIR", str(tmp_path / "jupyter"))
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path / "ipython"))
    monkeypatch.setenv("PYTHONSTARTUP", str(startup / "leak.py"))
    code = """\
import os, sys
print(sys.executable, "leaked" in globals(), os.listdir("."), os.environ["PYTHONPATH"])
e = os.environ
print(e["PYTHONNOUSERSITE"], e["GIVEN"], len(e["ROBO_GENESIS_RUN_ID"]))"""
    make_book(tmp_path, page=notebook(cell(code)))
    assert execute(tmp_path, environment={"GIVEN": "yes"})["page"].status == "executed"
    first, second = outputs(tmp_path, "page").splitlines()
    assert first == f"{sys.executable} False [] {ROOT}"
    assert second == "1 yes 32"


def test_a_killed_worker_is_a_failed_page(tmp_path):
    """The kernel kills its parent, as the system does when memory runs out."""
    code = "import os, signal\nos.kill(os.getppid(), signal.SIGKILL)\nimport time; time.sleep(60)"
    make_book(tmp_path, page=notebook(cell(code)), good=notebook(cell("1")))
    results = execute(tmp_path)
    assert results["page"].failure.error == "WorkerDied"
    assert results["good"].status == "executed"


def test_a_long_silence_is_broken_by_what_runs(tmp_path):
    """The page ends when the line that names it has been said."""
    said = tmp_path / "said"
    code = f"import pathlib, time\nwhile not pathlib.Path({str(said)!r}).exists(): time.sleep(0.05)"
    make_book(tmp_path, page=notebook(cell(code)))

    def hear(what, event):
        if what == "1 running: page":
            said.touch()

    execute(tmp_path, timeout=30, on_progress=hear, heartbeat=0.1)
    assert said.exists()


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


RUN = """\
import sys
from pathlib import Path
from robo_genesis.build.execute import execute_pages
from robo_genesis.lessons.book_pages import find_pages
if __name__ == "__main__":
    execute_pages(find_pages(Path("book")), Path("cache"), jobs=2)
"""


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGKILL])
def test_no_process_outlives_an_interrupted_or_killed_stage(tmp_path, sent):
    wait = "import os, pathlib, time\npathlib.Path({!r}).write_text(str(os.getpid()))\n{}"
    endless = "while True:\n    time.sleep(0.1)"
    deaf = "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)\n" + endless
    pids = [tmp_path / "one.pid", tmp_path / "two.pid"]
    one, two = wait.format(str(pids[0]), endless), wait.format(str(pids[1]), deaf)
    make_book(tmp_path, one=notebook(cell(one)), two=notebook(cell(two)))
    (tmp_path / "run.py").write_text(RUN)
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    stage = subprocess.Popen(
        [sys.executable, "run.py"], cwd=tmp_path, env=environment, stderr=subprocess.DEVNULL
    )
    wait_until(lambda: all(path.exists() and path.read_text() for path in pids))
    below = psutil.Process(stage.pid).children(recursive=True)
    assert {int(path.read_text()) for path in pids} <= {process.pid for process in below}
    (kernel, *_) = [process for process in below if process.pid == int(pids[0].read_text())]
    scratch = Path(kernel.cwd()).parent
    assert scratch.name.startswith("robo-")
    stage.send_signal(sent)
    assert stage.wait(30) != 0
    _, alive = psutil.wait_procs(below, timeout=15)
    assert alive == []
    assert not list((tmp_path / "cache/notebooks").glob("executed/*"))
    assert not scratch.exists()


def wait_until(true, seconds=30):
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.05)
