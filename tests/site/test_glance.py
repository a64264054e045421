"""The run that the page on evidence shows at a glance."""

import pytest

from robo_genesis.pipeline.bundles.status import Status
from robo_genesis.pipeline.pages.built import LAST_OUTPUTS, page_outputs
from robo_genesis.site.evidence.course_runs import shown_predicate
from robo_genesis.site.evidence.ledger_data import PageRun, provenance


@pytest.mark.parametrize(
    ("code", "last_outputs", "is_shown"),
    [("stale", True, True), ("stale", False, False), ("digest", True, False)],
)
def test_a_stale_run_is_shown_with_the_outputs_of_last_runs_alone(
    outputs, monkeypatch, code, last_outputs, is_shown
):
    if last_outputs:
        monkeypatch.setenv(LAST_OUTPUTS, "1")
    status = Status(code, "cpu", "a reason", None, code)
    run = PageRun("l04/lab", page_outputs("l04/lab") / "cpu", status)
    assert (shown_predicate(run) is not None) == is_shown
    assert provenance("figure", [run]) == f"No accepted evidence: cpu-{code}."
