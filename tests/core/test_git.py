"""A checkout whose repository git does not read is refused; one without a repository is not."""

import pytest
from tiny_book import commit

from robo_genesis.core.git import require_history
from robo_genesis.core.project import ProjectError


def test_only_a_repository_that_cannot_be_read_is_refused(tmp_path):
    (below := tmp_path / "checkout").mkdir()
    require_history(below)
    (below / "file").touch()
    commit(tmp_path)
    require_history(below)
    (tmp_path / ".git" / "HEAD").write_text(
        "no reference"
    )  # as unreadable as another user's
    with pytest.raises(
        ProjectError, match=r"rev-parse failed[\s\S]*a copy without \.git"
    ):
        require_history(below)
