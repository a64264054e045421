"""How cost grows: copies of a lesson that are lessons, and what is said of the kept figures."""

import os
import subprocess
import sys

import pytest

from robo_genesis import growth, growth_measure, kept, project, sphinx_growth
from robo_genesis.growth import Built, Growth, Verified
from robo_genesis.kept import KeptError
from robo_genesis.pages import code_digest, find_pages
from robo_genesis.workcopy import copy_tree

NAMES = ["l04copy1", "l04copy2"]


def record(**changes):
    return Growth(
        **{
            "engine": project.engine_pin(),
            "lock": project.lock_digest(),
            "date": "2026-01-02",
            "cores": 2,
            "built": tuple(
                Built(lessons=n, executing=10.0 + 60 * n, rendering=8.0 + 2 * n, site=n * 5 * 10**6)
                for n in (1, 2, 4)
            ),
            "verified": tuple(Verified(bundles=n, seconds=1 + 0.05 * n) for n in (1, 100)),
        }
        | changes
    )


@pytest.fixture(scope="module")
def work(tmp_path_factory):
    """A copy of the checkout with two copies of the lesson, the first of them in the contents."""
    folder = tmp_path_factory.mktemp("growth")
    copy_tree(project.ROOT, folder / "work", folder / "cache")
    assert growth_measure.add_copies(folder / "work", 2) == NAMES
    return folder / "work"


def test_the_contents_name_as_many_copies_as_asked_for_and_the_rest_as_before(work):
    before = [p.docname for p in find_pages(project.BOOK)]
    for count in (2, 0, 1):
        growth_measure.list_lessons(work, NAMES[:count])
        found = [p.docname for p in find_pages(work / "book")]
        assert len(found) == len(before) + 2 * count
        assert [name for name in found if "copy" not in name] == before


def test_a_copy_is_a_lesson_of_its_own(work):
    growth_measure.list_lessons(work, NAMES)
    pages = {(p.lesson, p.page): p for p in find_pages(work / "book") if p.declares_bundle}
    for page in ("lab", "lecture"):
        assert len({code_digest(pages[name, page]) for name in ("l04", *NAMES)}) == 3
        text = pages[NAMES[0], page].path.read_text()
        assert "from robo_genesis import" in text
        assert f'"{NAMES[0]}", "{page}"' in text
        assert '"l04"' not in text
        assert "`l04/" not in text
        assert not {"l04", "l04-lab"} & set(growth_measure.LABEL.findall(text))


def test_no_two_lessons_share_a_label(work):
    growth_measure.list_lessons(work, NAMES)
    labels = [
        label
        for page in find_pages(work / "book")
        for label in growth_measure.LABEL.findall(page.path.read_text())
    ]
    assert len(labels) > 6
    assert len(set(labels)) == len(labels)


def test_a_copy_is_known_to_evidence_and_comparison(work):
    code = (
        "from robo_genesis.lessons import LESSONS, find_page\n"
        "from robo_genesis.evidence.verify import JUDGES\n"
        "print(*LESSONS); print(*JUDGES); find_page('l04copy2', 'lecture').parameters()"
    )
    environment = os.environ | {"PYTHONPATH": str(work)}
    command = [sys.executable, "-c", code]
    said = subprocess.check_output(command, cwd=work, env=environment, text=True).splitlines()
    assert said[0] == said[1]
    assert set(NAMES) <= set(said[0].split())


def test_the_lesson_s_module_keeps_its_name():
    text = "from robo_genesis import checks, l04, plots\nx = (l04.BASELINE, l04.parameters())\n"
    assert growth_measure.renamed(text, "other") == text


def test_a_label_without_the_lesson_s_name_gets_one():
    text = "(why-so)=\n## Why so\n\n{ref}`why-so`, [](#why-so), not why-so-ever.\n"
    assert growth_measure.renamed(text, "other") == (
        "(other-why-so)=\n## Why so\n\n{ref}`other-why-so`, [](#other-why-so), not why-so-ever.\n"
    )


def test_sentences_give_the_slopes():
    building, size, verifying = growth.sentences(record())
    assert "From 1 to 4 lessons" in building
    assert "from 70 s to 250 s, about 60 s more for each lesson" in building
    assert "from 10 s to 16 s, about 2.0 s more for each" in building
    assert "from 5 MB to 20 MB, 5.0 MB more" in size
    assert "1 bundle took 1.1 s" in verifying
    assert "100 took 6.0 s: 50 ms more for each" in verifying


def test_a_record_is_kept_and_read_again(tmp_path):
    assert growth.read(tmp_path) is None
    path = kept.keep(tmp_path / growth.FILE, record())
    assert path == tmp_path / "performance" / "growth.json"
    assert growth.read(tmp_path) == record()
    assert [p.name for p in path.parent.iterdir()] == [path.name]


@pytest.mark.parametrize("text", ["", "{}", '{"engine": "1", "lock": "2"}'])
def test_what_is_no_record_is_refused(tmp_path, text):
    kept.keep(tmp_path / growth.FILE, record()).write_text(text)
    with pytest.raises(KeptError, match="make growth"):
        growth.read(tmp_path)


@pytest.mark.parametrize(
    ("changes", "reason"),
    [({"engine": "0.1"}, "measured with Genesis 0.1"), ({"lock": "0" * 64}, "lock"), ({}, None)],
)
def test_a_repin_makes_it_stale(changes, reason):
    found = record(**changes)
    told = kept.stale(found)
    assert told is None if reason is None else reason in told
    text = sphinx_growth.origin_text(found)
    assert text.startswith("**Stale**") == (reason is not None)
    assert found.engine in text
    assert found.lock[:12] in text


def test_plots_show_every_point_from_zero():
    time, size = sphinx_growth.lessons_figure(record()).axes
    assert [list(line.get_ydata()) for line in time.lines] == [[70, 130, 250], [10, 12, 16]]
    assert list(size.lines[0].get_ydata()) == [5, 10, 20]
    (ax,) = sphinx_growth.bundles_figure(record()).axes
    assert list(ax.lines[0].get_xdata()) == [1, 100]
    assert all(axes.get_ylim()[0] == axes.get_xlim()[0] == 0 for axes in (time, size, ax))
