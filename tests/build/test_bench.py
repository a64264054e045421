"""The rows and the table of `make bench`; no test here looks at a clock."""

import runpy
from types import SimpleNamespace

import pytest

from robo_genesis.core.project import ROOT

bench = SimpleNamespace(**runpy.run_path(str(ROOT / "build_scripts" / "bench.py")))


def test_the_table_has_least_median_and_most_of_both_sides_and_the_ratio_of_medians():
    *_, course, bare = bench.table({"verify": [(3, 2), (9, 1), (4, 4)]}).splitlines()
    assert course.split(" | ")[2:] == ["3", "4", "9", "2.00 |"]
    assert bare.split(" | ")[2:] == ["1", "2", "4", " |"]
    assert course.startswith("| verify | make verify | ")


@pytest.mark.parametrize(
    ("asked", "names"), [("", list(bench.ROWS)), ("prose, verify", ["prose", "verify"])]
)
def test_rows_are_chosen_by_name(asked, names):
    assert bench.chosen(asked) == names


def test_an_unknown_row_is_refused_with_those_that_are_known():
    with pytest.raises(bench.BenchError, match=r"ROWS names c\. Choices: unchanged, prose, "):
        bench.chosen("verify c")


@pytest.mark.parametrize("runs", ["0", "-1", "many"])
def test_a_number_of_runs_that_is_not_positive_is_refused(monkeypatch, runs):
    monkeypatch.setenv("RUNS", runs)
    monkeypatch.setenv("ROWS", "")
    with pytest.raises(bench.BenchError, match=f"RUNS='{runs}' is not valid"):
        bench.measure()
