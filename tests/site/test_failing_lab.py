"""A lab whose check fails stops the build by the check's name, and the old site still stands."""

import os
import shutil
import subprocess
import sys

import pytest

from robo_genesis.core.project import BOOK, CACHE, ROOT

pytestmark = pytest.mark.engine
LAB = "lessons/l02-life-cycle/lab"
SOUND = 'page.readings["model"] = l02.read_model(scene, box)\n'
SPOILED = 'page.readings["model"] = l02.read_model(scene, box) | {"links": 2}\n'


def test_a_failing_check_is_named_and_nothing_is_published(tmp_path):
    book, cache = tmp_path / "book", tmp_path / "cache"
    shutil.copytree(BOOK, book, ignore=shutil.ignore_patterns("_build*"))
    (book / "_toc.yml").write_text(f"format: jb-book\nroot: {LAB}\n")
    lab = book / f"{LAB}.md"
    text = lab.read_text()
    assert SOUND in text
    lab.write_text(text.replace(SOUND, SPOILED))
    (book / "_build" / "html").mkdir(parents=True)
    (book / "_build" / "html" / "index.html").write_text("the site that stood before")
    (CACHE / "engine").mkdir(parents=True, exist_ok=True)
    cache.mkdir()
    (cache / "engine").symlink_to(CACHE / "engine")  # compiled kernels, no executed page

    command = [sys.executable, str(ROOT / "build_scripts" / "book.py")]
    done = subprocess.run(
        [*command, "--book", str(book), "--cache", str(cache)],
        env=os.environ | {"RENDER": "0", "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )

    assert done.returncode == 1
    assert "CheckFailed" in done.stderr
    assert "[structure] links is 2, expected 1" in done.stderr
    assert LAB in done.stderr
    assert (book / "_build" / "html" / "index.html").read_text() == "the site that stood before"
