"""The bench's arithmetic, table, record and complaints; no test here looks at a clock."""

import json
import re
import sys

import pytest

from robo_genesis import bench, bench_bare, bench_rows
from robo_genesis.bench import BenchError, Result, Row, Sample
from robo_genesis.bench_clone import Clone
from robo_genesis.lessons import LESSONS
from robo_genesis.pages import find_pages
from robo_genesis.project import BOOK, ROOT


def result(work, against, limit=2.0, name="row", where="") -> Result:
    sides = ([Sample(*pair) for pair in side] for side in (work, against))
    return Result(name, "the work", "its opponent", limit, *map(tuple, sides), where)


def test_ratios_are_of_medians_of_elapsed_and_of_processor_seconds():
    found = result([(3, 2), (9, 4), (4, 3)], [(1, 1), (2, 2), (7, 9)])
    assert found.medians == (4, 2)
    assert found.ratio == 2
    assert found.cpu_ratio == 1.5


def test_without_processor_seconds_there_is_no_ratio_of_them():
    assert result([(3,)], [(2,)]).cpu_ratio is None


@pytest.mark.parametrize(("limit", "met"), [(1.6, True), (1.5, True), (1.4, False)])
def test_a_limit_is_met_up_to_itself(limit, met):
    assert result([(3,)], [(2,)], limit).met is met


def test_the_table_shows_medians_spread_ratio_limit_and_outcome():
    lines = bench.table(
        [result([(3, 1), (5, 1), (4, 1)], [(2, 1)] * 3), result([(9,)], [(1,)])]
    ).splitlines()
    assert " ".join(lines[0].split()) == (
        "work s (least-most) against s (least-most) ratio of CPU limit runs"
    )
    assert set(lines[1]) == {"-"}
    assert lines[2].split("  ")[0] == "the work"
    assert "4 (3-5)" in lines[2]
    assert lines[2].split()[-5:] == ["2.00", "1.00", "2", "met", "3"]
    assert lines[3].split()[-6:] == ["9.00", "-", "2", "NOT", "MET", "1"]


def test_a_row_without_a_limit_states_what_both_sides_cost():
    found = result([(190,)], [(38,)], limit=None)
    assert found.met
    assert bench.table([found]).splitlines()[2].split()[-4:] == ["5.00", "-", "-", "1"]


def test_where_the_time_goes_is_said_of_a_limit_that_is_not_kept_alone():
    slow, quick = ([(3,)], [(1,)]), ([(1,)], [(1,)])
    said = bench.table([result(*slow, where="to plots."), result(*quick, where="elsewhere.")])
    assert said.splitlines()[-1] == "the work: to plots."
    assert "elsewhere" not in said


def test_both_sides_are_run_in_turn_and_each_pair_is_told():
    said, ran = [], []

    def side(name: str, seconds: float):
        def run() -> Sample:
            ran.append(name)
            return Sample(seconds)

        return run

    row = Row("r", "a", "b", 1.0, lambda runs: bench.in_turn(side("a", 2), side("b", 4), runs), 3)
    found = bench.take(row, None, said.append)
    assert ran == ["a", "b"] * 3
    assert found.ratio == 0.5
    assert said[-1] == "r  3 of 3: 2 s against 4 s"
    assert len(bench.take(row, 1, said.append).samples) == 1


def test_the_record_is_json_with_samples_figures_and_the_machine(tmp_path):
    facts = bench.machine()
    file = bench.keep(
        tmp_path / ".bench" / "latest.json", bench.record([result([(3, 2)], [(2, 1)])], facts)
    )
    found = json.loads(file.read_text())
    assert {"date", "engine", "lock", "python", "cores", "load_average"} <= found.keys()
    (row,) = found["rows"]
    assert row["samples"] == [{"wall": 3, "cpu": 2}]
    assert (row["medians"], row["ratio"], row["met"]) == ([3, 2], 1.5, True)
    assert [path.name for path in file.parent.iterdir()] == ["latest.json"]


@pytest.mark.parametrize(("asked", "names"), [("", ["a", "b"]), ("b", ["b"]), ("b, a", ["b", "a"])])
def test_rows_are_chosen_by_name(asked, names):
    assert bench.chosen(asked, ["a", "b"]) == names


def test_a_row_that_is_not_known_is_refused_with_those_that_are():
    with pytest.raises(BenchError, match=r"ROWS names 'c'\. Choices: a, b"):
        bench.chosen("a c", ["a", "b"])


@pytest.fixture
def clone(tmp_path) -> Clone:
    (tmp_path / "work").mkdir()
    return Clone(tmp_path / "work", tmp_path / "logs")


def python(code: str) -> list[str]:
    return [sys.executable, "-c", code]


def test_a_command_s_elapsed_and_processor_seconds_are_taken(clone):
    found = clone.time(python("import os; print(os.environ['JOBS'])"), "7", JOBS="7")
    assert found.wall > 0
    assert found.cpu is not None
    assert found.cpu > 0


def test_a_command_hears_no_wish_that_was_meant_for_the_bench(clone, monkeypatch):
    monkeypatch.setenv("RUNS", "3")
    monkeypatch.setenv("SITE_URL", "https://example.org/")
    code = "import os; print({'RUNS', 'SITE_URL'} & os.environ.keys())"
    clone.time(python(code), "set()")


@pytest.mark.parametrize("how", ["time", "peak_memory"])
def test_a_command_that_fails_is_an_error_with_its_last_words(clone, how):
    code = "import sys; print('last words'); sys.exit(3)"
    with pytest.raises(BenchError, match=r"(?s)ended with status 3: .*last words\nLog: "):
        getattr(clone, how)(python(code))


def test_a_command_that_did_something_else_is_an_error(clone):
    with pytest.raises(BenchError, match="did not say 'Nothing changed'"):
        clone.time(python("print('built')"), "Nothing changed")


def test_the_memory_of_a_command_and_of_what_it_starts_is_added_up(clone):
    held = "x = bytearray(60_000_000); import time; time.sleep(2)"
    code = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {held!r}]); {held}"
    assert 60e6 < clone.peak_memory(python(code)) < 200e6


def test_arrays_that_depend_on_jobs_are_an_error(clone, monkeypatch):
    found = iter([{"a": "1", "b": "2"}, {"a": "1", "b": "3"}])
    monkeypatch.setattr(bench_rows, "array_digests", lambda outputs: next(found))
    monkeypatch.setattr(Clone, "time", lambda *words, **wishes: Sample(1.0))
    with pytest.raises(BenchError, match=r"differ between JOBS=2 and JOBS=1: b\."):
        list(bench_rows.jobs(clone, 1))


def test_the_rows_are_those_that_were_promised(clone):
    limits = {row.name: row.limit for row in bench_rows.rows(clone)}
    assert limits == {
        "unchanged": 1.5,
        "prose": 1.3,
        "lab": 1.25,
        "jobs": 0.65,
        "verify": 3.0,
        "compare": 3.0,
        "recording": 1.5,
    } | dict.fromkeys(LESSONS)


def test_kernels_are_put_aside_for_a_cold_run_and_back_after_it(clone, monkeypatch):
    compiled = clone.root / ".cache" / "engine" / "one"
    compiled.mkdir(parents=True)
    (compiled / "kernel").write_text("compiled")
    monkeypatch.setattr(bench_rows.project, "engine_cache_folder", lambda root: compiled)
    monkeypatch.setattr(bench_rows, "find_pages", lambda book: find_pages(BOOK))
    found = []

    class executing:  # noqa: N801
        def __init__(self, clone, *pages, **wishes):
            self.pages = pages

        def __call__(self):
            found.append((self.pages, (compiled / "kernel").exists()))
            compiled.mkdir(exist_ok=True)
            (compiled / "kernel").write_text("anew")
            return Sample(1.0)

    monkeypatch.setattr(bench_rows, "executing", executing)
    assert len(list(bench_rows.cold_and_warm(clone, "l02", 1))) == 1
    pages = ("lessons/l02-life-cycle/lecture", "lessons/l02-life-cycle/lab")
    assert found == [(pages, False), (pages, True)]
    assert (compiled / "kernel").read_text() == "compiled"


def test_a_change_of_prose_finds_its_place_in_the_lab():
    (lab,) = (page for page in find_pages(BOOK) if page.docname == bench_rows.LAB)
    assert "\n## 2. " in lab.path.read_text()


ADDED = re.compile(r"add_(?:directive|role)\(\s*\"([\w-]+)\"")


def test_the_bare_book_names_the_directives_and_roles_of_the_course_that_pages_use():
    pages = [path for path in BOOK.rglob("*.md") if path.relative_to(BOOK).parts[0][0] != "_"]
    text = "".join(path.read_text() for path in pages)
    sources = "".join(path.read_text() for path in (ROOT / "robo_genesis").glob("sphinx_*.py"))
    used = {name for name in ADDED.findall(sources) if f"{{{name}}}" in text}
    assert len(used) > 10
    assert {*bench_bare.DIRECTIVES, *bench_bare.ROLES} == used
