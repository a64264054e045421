"""Bundles of a lesson's `experiments`, which its own conftest declares by page."""

import shutil
from pathlib import Path

import pytest
from bundles import written

from robo_genesis.pipeline.bundles.verify import verify_bundle


@pytest.fixture(scope="module")
def sound(request, tmp_path_factory, engine, experiments) -> dict[str, Path]:
    """A sound bundle of each page, written without a real engine and accepted."""
    outputs, lesson = tmp_path_factory.mktemp("outputs"), request.path.parent.name
    folders = {
        page: written(engine, outputs, lesson, page, r)
        for page, r in experiments.items()
    }
    for page, folder in folders.items():
        checks = {check.name: check.passed for check in verify_bundle(folder).checks}
        assert checks == {
            check.__name__: True for check in experiments[page].page.checks
        }
    return folders


@pytest.fixture
def copy(sound, tmp_path):
    """Return a function that copies the bundle of a page, to spoil it."""
    return lambda page: Path(
        shutil.copytree(sound[page], tmp_path / Path(*sound[page].parts[-3:]))
    )
