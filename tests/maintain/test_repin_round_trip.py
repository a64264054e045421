"""The real change of the pin, in a clone."""

import json
import re
import shutil
import sys
from pathlib import Path

import pytest
from checkout import make, run_in
from tiny_book import git

from robo_genesis.core import project
from robo_genesis.core.project import ROOT
from robo_genesis.evidence import report as pages
from robo_genesis.evidence.compare import compare
from robo_genesis.evidence.rows import DIFFERS, EQUAL, NOT_COMPARABLE, WITHIN
from robo_genesis.pipeline.pages.book import find_pages

pytestmark = [pytest.mark.engine, pytest.mark.slow]

PIN = project.engine_pin()
OTHER = "1.4.5" if PIN != "1.4.5" else "1.3.3"
BASE = f"BASE_PYTHON={sys.executable}"


@pytest.fixture(scope="module")
def clone(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("repin") / "course"
    git(ROOT, "clone", "--quiet", str(ROOT), str(folder))
    return folder


def changed(clone: Path) -> list[str]:
    return git(clone, "status", "--porcelain").split()


def facts(bundle: Path) -> dict:
    return json.loads((bundle / "manifest.json").read_text())


def keep(clone: Path, name: str) -> Path:
    """Copy the built bundle to where no later build removes it; its folder names the backend."""
    built = clone / "book" / "_build" / "evidence" / "l04" / "cpu"
    return shutil.copytree(built, clone.parent / name / "cpu")


def test_another_version_is_pinned_with_its_evidence(clone):
    refused = make(clone, "repin", "GENESIS=9.9.9", fails=True)
    assert "genesis-world==9.9.9" in refused
    assert changed(clone) == []

    make(clone, "book")
    first = keep(clone, "first")
    make(clone, "repin", f"GENESIS={OTHER}")
    assert changed(clone) == ["M", "pyproject.toml", "M", "requirements.lock"]
    assert project.engine_pin(clone) == OTHER
    reports = clone / ".cache/reports" / f"repin-{PIN}-{OTHER}"
    report = (reports / "report.md").read_text()
    states = dict(re.findall(r"^\| (l\d+ \w+) \| ([a-z ]+) \|", report, re.MULTILINE))
    measuring = [page for page in find_pages(clone / "book") if page.declares_bundle]
    assert states.keys() == {f"{page.lesson} {page.page}" for page in measuring}
    assert NOT_COMPARABLE not in states.values()
    # Cubes of L03 that tumble over an edge differ between versions.
    assert DIFFERS not in [states[f"{lesson} lab"] for lesson in ("l04", "l05", "l06")]

    run_in(clone, "make", "book", BASE)  # in the environment of the new lock
    second = keep(clone, "second")
    comparison = compare(first, second)
    assert comparison.state in (EQUAL, WITHIN), pages.summary(comparison)
    assert facts(second)["engine"]["version"] == OTHER
    assert facts(second)["evidence_key"] != facts(first)["evidence_key"]
    for page in (clone / "book/_build/html").rglob("*.html"):
        assert f"Genesis {PIN}" not in page.read_text("utf8"), page
