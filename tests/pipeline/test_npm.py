"""npm's packages come whole, by lock, or not at all."""

import json
import shutil
from pathlib import Path

import pytest

from robo_genesis.core.project import ROOT, ProjectError
from robo_genesis.pipeline import npm


@pytest.fixture
def checkout(tmp_path) -> Path:
    root = tmp_path / "checkout"
    root.mkdir()
    for name in npm.FILES:
        shutil.copy(ROOT / name, root)
    return root


def test_each_lock_has_a_folder_of_its_own_and_is_fetched_once(
    checkout, tmp_path, monkeypatch
):
    calls = []
    monkeypatch.setattr(npm, "_install", calls.append)
    found = [npm.packages(checkout, tmp_path), npm.packages(checkout, tmp_path)]
    for name in npm.FILES:
        (checkout / name).write_text("{}")
        found.append(npm.packages(checkout, tmp_path))
    assert len(set(found)) == len(calls) == 4


def test_a_lock_that_does_not_fit_is_refused_and_leaves_nothing(checkout, tmp_path):
    declared = json.loads((checkout / "package.json").read_text("utf8"))
    declared["dependencies"]["left-out-of-the-lock"] = "1.0.0"
    (checkout / "package.json").write_text(json.dumps(declared))
    with pytest.raises(ProjectError, match="npm ci failed"):
        npm.packages(checkout, tmp_path / "cache")
    assert list((tmp_path / "cache" / "npm").iterdir()) == []
    assert "resolved" not in (ROOT / "package-lock.json").read_text(
        "utf8"
    )  # no registry
