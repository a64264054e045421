"""Outputs of a build, for what reads measured values."""

from pathlib import Path

import pytest
from bundles import RENDERER
from small_book import render_small_book

from robo_genesis.pipeline.pages.built import BuiltPages


@pytest.fixture
def built(tmp_path, monkeypatch):
    """Return what lets folders be the outputs of this build, by `lesson/page`."""

    def tell(outputs):
        (tmp_path / "told").mkdir()
        for name, value in BuiltPages(outputs=outputs).write(tmp_path / "told/pages").items():
            monkeypatch.setenv(name, value)

    return tell


@pytest.fixture
def outputs(recorder, experiment, built):
    """Let the synthetic run of L04's lab be the outputs of this build."""
    recorder.write(experiment, RENDERER)
    built({"l04/lab": recorder.contract.outputs / "l04" / "lab"})


@pytest.fixture(scope="session")
def small_site(tmp_path_factory) -> Path:
    """The site of `small_book.py`."""
    return render_small_book(tmp_path_factory.mktemp("small"))
