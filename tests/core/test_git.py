"""A checkout whose repository git does not read is refused; one without a repository is not."""

import pytest
from tiny_book import commit

from robo_genesis.core.git import require_history
from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.recording.labs import Recording, record
from robo_genesis.pipeline.stages import Build, execute_one


def test_only_a_repository_that_cannot_be_read_is_refused(tmp_path):
    (below := tmp_path / "checkout").mkdir()
    require_history(below)
    (below / "file").touch()
    commit(tmp_path)
    require_history(below)
    (tmp_path / ".git" / "HEAD").write_text(
        "no reference"
    )  # as unreadable as another user's
    settings = {"root": below, "cache": tmp_path / "cache"}
    for command in (
        lambda: execute_one("l04/lab", Build(**settings)),
        lambda: record(Recording(to=tmp_path, **settings)),
    ):
        with pytest.raises(
            ProjectError, match=r"rev-parse failed[\s\S]*a copy without \.git"
        ):
            command()
