"""The verification stage compares each page with the contract and, once, with its bundle."""

import os
from types import SimpleNamespace
from unittest.mock import Mock

import pytest
from nbformat.v4 import new_notebook

from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.pipeline.bundles.of_build import outputs_compared, require_contract
from robo_genesis.pipeline.pages import outputs
from robo_genesis.pipeline.pages.page_folder import RECORD
from robo_genesis.pipeline.pages.results import PageResult


@pytest.fixture
def result(tmp_path, monkeypatch):
    """A page in a store, whose notebook is not read."""
    folder = tmp_path / "cache" / "pages" / "page" / "fingerprint"
    folder.mkdir(parents=True)
    (folder / RECORD).write_text(os.urandom(16).hex())
    monkeypatch.setattr(
        "robo_genesis.pipeline.bundles.of_build.stored_notebook", lambda of: None
    )
    page = SimpleNamespace(notebook=new_notebook())
    return PageResult(
        page, "reused", 0.0, "run", folder / "outputs" / "cpu", folder=folder
    )


def test_an_accepted_page_is_compared_again_when_its_record_changed(
    result, monkeypatch
):
    calls = []
    monkeypatch.setattr(
        outputs, "require_shown", lambda *given: calls.append(given) or 7
    )
    assert [outputs_compared(result, None) for _ in range(2)] == [7, 7]
    assert len(calls) == 1
    (result.folder / RECORD).write_text(os.urandom(16).hex())
    monkeypatch.setattr(
        outputs, "require_shown", Mock(side_effect=BundleRefused("shown", "other"))
    )
    for _ in range(2):  # a refusal is not kept
        with pytest.raises(BundleRefused, match="other"):
            outputs_compared(result, None)


@pytest.mark.parametrize(("page", "mode"), [("lab", "camera"), ("formula", "skip")])
def test_a_page_must_render_exactly_if_it_declares_a_camera(page, mode):
    contract = {"ROBO_GENESIS_BACKEND": "cpu", "ROBO_GENESIS_RENDER": "1"}
    facts = SimpleNamespace(lesson="l04", page=page, render=SimpleNamespace(mode=mode))
    facts.backend = SimpleNamespace(requested="cpu")
    require_contract(facts, contract)
    with pytest.raises(
        BundleRefused, match=r"backend\.requested is cpu, expected auto"
    ):
        require_contract(facts, contract | {"ROBO_GENESIS_BACKEND": "auto"})
    facts.render.mode = "another"
    with pytest.raises(BundleRefused, match=rf"frames: .* expected {mode}"):
        require_contract(facts, contract)
