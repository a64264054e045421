"""The rows and the table of `make bench`; no test here looks at a clock."""

import runpy
import subprocess
import sys
from types import SimpleNamespace

import pytest

from robo_genesis.core.project import ROOT

bench = SimpleNamespace(**runpy.run_path(str(ROOT / "build_scripts" / "bench.py")))


def test_the_table_has_least_median_and_most_of_both_sides_and_the_ratio_of_medians():
    *_, course, bare = bench.table({"lab": [(3, 2), (9, 1), (4, 4)]}).splitlines()
    assert course.split(" | ")[2:] == ["3", "4", "9", "2.00", "1.2 |"]
    assert bare.split(" | ")[2:] == ["1", "2", "4", "", " |"]
    assert course.startswith("| lab | make execute, ")


PRINTED = """\
[    1.0 s] execute  6 pages
[    1.5 s] execute  lessons/l04/lab  reused
[    2.0 s] render   all pages
[    6.0 s] check    links (3)  passed
[    6.5 s] publish  html
"""


@pytest.mark.parametrize(
    ("name", "pairs", "notes"),
    [
        ("prose", [(9, 6), (1, 9), (20, 1)], []),
        ("verify", [(9, 1)], []),
        (
            "prose",
            [(9.1, 6), (8.5, 1)],
            ["prose: the ratio is 2.51, the limit 1.5. The time goes into: execute 1.0 s, render "
             "4.0 s, check 0.5 s."],
        ),
    ],
)  # fmt: skip
def test_a_row_above_its_limit_says_where_the_time_goes(name, pairs, notes):
    assert bench.over_limit(name, pairs, PRINTED) == notes


@pytest.mark.parametrize(
    ("asked", "names"), [("", list(bench.ROWS)), ("prose, verify", ["prose", "verify"])]
)
def test_rows_are_chosen_by_name(asked, names):
    assert bench.chosen(asked) == names


@pytest.mark.parametrize(
    ("rows", "runs", "said"),
    [
        ("verify c", "3", r"ROWS names c\. Choices: unchanged, prose, "),
        *(("", runs, f"RUNS='{runs}' is not valid") for runs in ("0", "-1", "many")),
    ],
)
def test_unknown_rows_and_numbers_that_are_not_positive_are_refused(monkeypatch, rows, runs, said):
    monkeypatch.setenv("ROWS", rows)
    monkeypatch.setenv("RUNS", runs)
    with pytest.raises(bench.BenchError, match=said):
        bench.measure()


def server(code: str) -> subprocess.Popen[str]:
    return subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)


def test_the_address_of_a_server_is_the_one_that_it_prints():
    with server("print('Rendering.\\nhttp://localhost:1/ Ctrl-C ends it.')") as ready:
        assert bench.served_at(ready) == "http://localhost:1/"


def test_a_server_that_ends_before_it_serves_is_refused():
    with (
        server("print('Rendering.'); exit(3)") as ended,
        pytest.raises(bench.BenchError, match="ended with status 3, expected an address"),
    ):
        bench.served_at(ended)
