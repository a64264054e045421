"""The verification stage compares the outputs of each executed page once."""

import pytest

from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.pipeline.bundles.of_build import outputs_compared
from robo_genesis.pipeline.pages import bound as shown
from robo_genesis.pipeline.pages.folder import RECORD
from robo_genesis.pipeline.pages.results import PageResult


@pytest.fixture
def result(tmp_path, monkeypatch):
    """A page in a store, whose notebook is not read."""
    folder = tmp_path / "cache" / "pages" / "page" / "fingerprint"
    folder.mkdir(parents=True)
    (folder / RECORD).write_text("its digests")
    monkeypatch.setattr(
        "robo_genesis.pipeline.bundles.of_build.stored_notebook", lambda result: None
    )
    return PageResult(None, "reused", 0.0, "run", folder / "outputs" / "cpu", folder=folder)


def test_a_page_is_compared_again_when_its_record_changed(result, monkeypatch):
    calls = []
    monkeypatch.setattr(shown, "require_shown", lambda *given: calls.append(given) or 7)
    assert [outputs_compared(result, None) for _ in range(2)] == ["7", "7"]
    assert len(calls) == 1
    (result.folder / RECORD).write_text("the digests of an edited notebook")
    outputs_compared(result, None)
    assert len(calls) == 2


def test_a_refused_page_is_refused_each_time(result, monkeypatch):
    def refuse(*given):
        raise BundleRefused("shown", "another table")

    monkeypatch.setattr(shown, "require_shown", refuse)
    for _ in range(2):
        with pytest.raises(BundleRefused, match="another table"):
            outputs_compared(result, None)
