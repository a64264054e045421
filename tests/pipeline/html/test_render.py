import signal
import subprocess
import sys
import time

import psutil
import pytest
from built_site import parsed
from small_book import draft_of, executed
from tiny_book import WRITE_BUNDLE, cell, make_book, notebook

from robo_genesis.core.project import ProjectError
from robo_genesis.pipeline.html.sphinx_process import SphinxProcess
from robo_genesis.pipeline.pages.book import find_pages

CLAIMS = "status: amdgpu-verified\nbadge: cpu-verified\n"
LAB = "robo_genesis: {lesson: l04, page: lab}\n"
BADGES = "\n```{lesson-status} l04\n```\n"
TEXT = f"---\n{CLAIMS}---\n# Text\n{BADGES}"


@pytest.fixture(scope="module")
def html(tmp_path_factory):
    """A rendered book, with a page that got a tag after it was executed.

    The lab's bundle is a manifest that says it was verified, and nothing more.
    """
    folder = tmp_path_factory.mktemp("render")
    said = WRITE_BUNDLE.replace('{"run_id"', '{"state": "verified", "run_id"')
    page, lab = (
        cell("print('measured ' + '7')"),
        notebook(cell(said), front=CLAIMS + LAB),
    )
    book = make_book(folder, text=TEXT, page=notebook(page), lab=lab + BADGES)
    results = executed(find_pages(book), folder)
    text = (book / "page.md").read_text()
    (book / "page.md").write_text(text.replace("cell}", "cell}\n:tags: [hide-input]"))
    (folder / "staging").mkdir()
    (folder / "staging" / "stale").touch()
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("SITE_URL", raising=False)
        html = draft_of(book, folder, results).html
    assert not (folder / "staging" / "stale").exists()
    return html


def test_metadata_come_from_the_page_and_outputs_from_the_store(html):
    shown = (html / "page.html").read_text()
    assert "tag_hide-input" in shown
    assert "measured 7" in shown


@pytest.mark.parametrize("name", ["text", "lab"])
def test_no_front_matter_or_bundle_s_word_can_set_a_badge(html, name):
    badges = [
        badge.get_text() for badge in parsed(html, name).select(".evidence-badge")
    ]
    assert badges == ["cpu-refused", "amdgpu-missing"]


def test_without_an_address_nothing_claims_one(html):
    assert not (html / "sitemap.xml").exists()
    claims = 'link[rel="canonical"], meta[property^="og:"]'
    assert parsed(html, "page").select(claims) == []


def test_sphinx_executes_nothing_and_names_the_page(tmp_path):
    """A page that the execution stage has not seen would leave a file behind if it were run."""
    trace, front = tmp_path / "was executed", "mystnb: {execution_mode: force}\n"
    book = make_book(
        tmp_path, page=notebook(cell(f"open({str(trace)!r}, 'w')"), front=front)
    )
    with pytest.raises(
        ProjectError, match=r"page\.md is not executed, and Sphinx executes"
    ):
        draft_of(book, tmp_path, [])
    assert not trace.exists()


FORKS = "import os, time; os.fork() or time.sleep(60); time.sleep(60)"


def test_a_child_of_sphinx_does_not_outlive_it(tmp_path):
    """A child keeps the pipe open, for which an interrupted build would wait."""
    sphinx = SphinxProcess.__new__(SphinxProcess)
    how = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    sphinx.process = subprocess.Popen(
        [sys.executable, "-c", FORKS], start_new_session=True, **how
    )
    with sphinx:
        while not (below := psutil.Process(sphinx.process.pid).children()):
            time.sleep(0.05)
    assert sphinx.process.returncode == -signal.SIGKILL
    assert psutil.wait_procs(below, timeout=30)[1] == []
