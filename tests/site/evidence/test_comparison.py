"""The comparison of this build's run with a recorded one, as a panel shows it."""

import shutil

import pytest
from spoilers import metrics, on, part, seal
from without_sphinx import Panel, rows_of

from robo_genesis.core.text import six_digits
from robo_genesis.evidence import bundle
from robo_genesis.evidence.compare import compare
from robo_genesis.lessons.l04 import spec as l04


@pytest.fixture
def there(folder, tmp_path):
    """A bundle of an accelerator, otherwise the same."""
    return on("amdgpu")(shutil.copytree(folder, tmp_path / "there" / "cpu"))


def moved(folder, case, metric, by):
    """Move one metric, as another machine might have measured it."""
    metrics(lambda m: m[case][metric].update(value=m[case][metric]["value"] + by))(
        folder
    )
    seal(folder)


def compared(folder, there):
    """The text on two bundles of L04, and the cells of every row of its tables."""
    both = compare(folder, there)
    found = Panel(folder).filled("comparison.md", compared=both)
    return "\n".join(node.astext() for node in found), rows_of(found)


def test_values_and_orderings_of_both_runs_are_side_by_side(folder, there):
    text, rows = compared(folder, there)
    assert text.startswith("Compared with this build's run on cpu: equal.")
    both = ["cpu, this build", "amdgpu, recorded"]
    assert rows[0] == ["metric", *both, "difference", "allowed", "verdict"]
    assert sum("held: " in row[1] for row in rows) == len(l04.RELATIONS)
    moved(there, "G1", "overshoot", 1.0)
    text, rows = compared(folder, there)
    assert ": differs. The lesson's" in text
    cells = {row[0]: row[1:] for row in rows}
    *_, difference, allowed, verdict = cells["G1.overshoot"]
    atol, rtol = l04.TOLERANCES["rad"]
    value = bundle.read_metrics(there)["G1"]["overshoot"].value
    assert (difference, verdict) == (six_digits(1.0, "rad"), "differs")
    assert allowed == six_digits(atol + rtol * value, "rad")
    ours, theirs, *_ = cells["overshoot: G2 higher than G1"]
    assert (ours[:6], theirs[:8]) == ("held: ", "broken: ")


def test_runs_that_cannot_be_compared_have_the_reason(folder, there):
    part("parameters", rise_fraction=0.5)(there)
    text, rows = compared(folder, there)
    assert text.startswith("Not comparable with this build's run on cpu.")
    assert "parameters.rise_fraction differs: 0.9 and 0.5." in text
    assert rows == []
