"""The result of `make bench`, and the selection of its rows; no test here looks at a clock."""

import runpy
from types import SimpleNamespace

import pytest

from robo_genesis.core.project import ROOT, ProjectError

bench = SimpleNamespace(**runpy.run_path(str(ROOT / "build_scripts" / "bench.py")))


@pytest.mark.parametrize(
    ("pairs", "said"),
    [
        (
            [(3, 2), (9, 7), (4, 4)],
            "1.00, limit 1.5; course 3.00 4.00 9.00 s, bare 2.00 4.00 7",
        ),
        ([(3, 2), (9, 1), (4, 4)], "2.00, ABOVE its limit 1.5; course "),
    ],
)
def test_a_row_has_the_times_of_both_sides_and_the_ratio_of_their_medians(pairs, said):
    assert bench.result("prose", pairs).startswith(f"prose: ratio {said}")


@pytest.mark.parametrize(
    ("rows", "runs", "said"),
    [
        ("lab c", "3", r"ROWS names \['c'\]\. Choices: unchanged, prose, live, lab\."),
        *(("", runs, f"RUNS='{runs}' is not valid") for runs in ("0", "-1", "many")),
    ],
)
def test_unknown_rows_and_numbers_that_are_not_positive_are_refused(
    monkeypatch, rows, runs, said
):
    monkeypatch.setenv("ROWS", rows)
    monkeypatch.setenv("RUNS", runs)
    with pytest.raises((ProjectError, SystemExit), match=said):
        bench.measure()
