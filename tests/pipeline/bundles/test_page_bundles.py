"""The verification stage: the contract of a page, and one comparison with its bundle."""

import os
from types import SimpleNamespace
from unittest.mock import Mock

import pytest
from nbformat.v4 import new_notebook

from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.pipeline.bundles import page_bundles
from robo_genesis.pipeline.bundles.page_bundles import (
    outputs_compared,
    require_contract,
)
from robo_genesis.pipeline.pages import outputs
from robo_genesis.pipeline.pages.page_folder import RECORD
from robo_genesis.pipeline.pages.results import PageResult


def test_an_accepted_page_is_compared_again_when_its_record_changed(
    tmp_path, monkeypatch
):
    (tmp_path / RECORD).write_text(os.urandom(16).hex())
    monkeypatch.setattr(page_bundles, "executed_cells", lambda folder: None)
    page = SimpleNamespace(notebook=new_notebook())
    bundle = tmp_path / "outputs/cpu"
    result = PageResult(page, "reused", tmp_path)
    compare = Mock(side_effect=[7, BundleRefused("shown", "other"), 8])
    monkeypatch.setattr(outputs, "require_shown", compare)
    assert [outputs_compared(result, bundle) for _ in range(2)] == [7, 7]
    (tmp_path / RECORD).write_text(os.urandom(16).hex())
    with pytest.raises(BundleRefused, match="other"):  # a refusal is not kept
        outputs_compared(result, bundle)
    assert outputs_compared(result, bundle) == 8


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
