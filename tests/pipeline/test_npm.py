"""npm's packages come whole, by lock, or not at all."""

import hashlib
import json
import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest

from robo_genesis.core.project import ROOT, ProjectError
from robo_genesis.pipeline import npm


@pytest.fixture
def checkout(tmp_path) -> Path:
    root = tmp_path / "checkout"
    root.mkdir()
    for name in (*npm.LOCK, npm.SETTINGS):
        shutil.copy(ROOT / name, root)
    return root


def test_each_lock_has_a_folder_of_its_own_and_is_fetched_once(
    checkout, tmp_path, monkeypatch
):
    calls = []
    monkeypatch.setattr(npm, "_install", calls.append)
    found = [npm.packages(checkout, tmp_path), npm.packages(checkout, tmp_path)]
    for name in (*npm.LOCK, npm.SETTINGS):
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


@pytest.fixture
def fetched(checkout, monkeypatch):
    """A lock whose packages are one file; `fetched.content` is what npm delivers."""
    state = SimpleNamespace(content=b"locked", fetches=0)

    def install(folder: Path) -> None:
        state.fetches += 1
        (folder / "node_modules").mkdir()
        (folder / "node_modules" / "a.js").write_bytes(state.content)

    monkeypatch.setattr(npm, "_install", install)
    monkeypatch.setattr(
        npm, "PUBLISHED", {"a.js": hashlib.sha256(b"locked").hexdigest()}
    )
    return state


@pytest.mark.parametrize(
    "spoil", [lambda file: file.write_bytes(b"forged"), Path.unlink]
)
def test_a_changed_file_of_the_cache_is_fetched_anew(
    checkout, tmp_path, fetched, capsys, spoil
):
    cache = tmp_path / "cache"
    assert npm.published("a.js", checkout, cache) == b"locked"
    assert capsys.readouterr().out == ""
    spoil(npm.packages(checkout, cache) / "a.js")
    assert npm.published("a.js", checkout, cache) == b"locked"
    assert fetched.fetches == 2
    (line,) = capsys.readouterr().out.splitlines()
    assert line.endswith("a.js is not the locked file: fetching all packages anew")


def test_a_fetched_file_without_its_digest_is_refused(checkout, tmp_path, fetched):
    fetched.content = b"of another version"
    with pytest.raises(
        ProjectError, match=r"a\.js has the digest .* write its digest into"
    ):
        npm.published("a.js", checkout, tmp_path / "cache")
    assert fetched.fetches == 2
