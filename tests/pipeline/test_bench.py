"""The result of `make bench`, and the selection of its rows; no test here looks at a clock."""

import runpy
from types import SimpleNamespace

import pytest

from robo_genesis.core.project import ROOT, ProjectError

bench = SimpleNamespace(**runpy.run_path(str(ROOT / "build_scripts" / "bench.py")))


@pytest.mark.parametrize(
    ("name", "pairs", "ratio"),
    [
        ("prose", [(3, 2), (9, 7), (4, 4)], "ratio 1.00, limit 1.5"),
        ("verify", [(3, 1), (9, 1), (4, 1)], "ratio 4.00, limit none"),
        ("prose", [(3, 2), (9, 1), (4, 4)], "ratio 2.00, ABOVE its limit 1.5"),
    ],
)
def test_a_row_has_both_sides_and_the_ratio_of_their_medians(name, pairs, ratio):
    head, course, bare = bench.result(name, pairs)
    assert head.startswith(f"{name}: {ratio}; ")
    assert course.split()[:4] == ["3.00", "4.00", "9.00", "make"]
    assert bare.split()[3] in ("bare", "start")


@pytest.mark.parametrize(
    ("rows", "runs", "said"),
    [
        ("verify c", "3", r"ROWS names c\. Choices: unchanged, prose, live, verify, lab, jobs\."),
        *(("", runs, f"RUNS='{runs}' is not valid") for runs in ("0", "-1", "many")),
    ],
)
def test_unknown_rows_and_numbers_that_are_not_positive_are_refused(monkeypatch, rows, runs, said):
    monkeypatch.setenv("ROWS", rows)
    monkeypatch.setenv("RUNS", runs)
    with pytest.raises(ProjectError, match=said):
        bench.measure()
