"""The refresh report on bundles: metrics, relations, warnings and what became stale."""

import shutil
from pathlib import Path

import pytest
from spoilers import facts, metrics, part, seal
from tiny_book import lab, make_book

from robo_genesis.core import project
from robo_genesis.maintain import report as refresh
from robo_genesis.maintain.report import (
    EngineBuild,
    changed_sentences,
    compare_builds,
    read_build,
)
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.pipeline.pages.page_folder import write_page
from robo_genesis.site.evidence.provenance import LEDGER


@pytest.fixture
def builds(pristine, tmp_path) -> tuple[EngineBuild, EngineBuild]:
    """Two builds with one lab each, and a site of one sentence."""
    both = []
    for version in ("1.0", "9.9.9"):
        site, bundle = tmp_path / version / "html", tmp_path / version / "cpu"
        shutil.copytree(pristine, bundle)
        site.mkdir()
        (site / "index.html").write_text("<p>Same.</p>")
        both.append(EngineBuild(version, {"l04/lab/cpu": bundle}, site))
    part("engine", version="9.9.9")(both[1].bundles["l04/lab/cpu"])
    return both[0], both[1]


def test_equal_metrics_are_reported_as_such(builds):
    found = compare_builds(*builds)
    assert (found.state, found.changed) == ("equal", ())
    text = refresh.document(found).markdown()
    assert text.startswith("# Engine 1.0 → 9.9.9\n\n**Equal; changed sentences: 0.")
    assert "| l04 lab | equal | Equal. Rows: " in text


def test_a_bundle_that_one_build_lacks_or_that_is_damaged_is_not_comparable(builds):
    builds[0].bundles["l04/lecture/cpu"] = builds[0].bundles["l04/lab/cpu"]
    found = compare_builds(*builds)
    assert (len(found.comparisons), found.state) == (1, "not comparable")
    text = refresh.document(found).markdown()
    assert "| l04/lecture/cpu | not comparable | In one build only. |" in text
    (builds[1].bundles["l04/lab/cpu"] / "metrics.json").write_text("{}")
    found = compare_builds(*builds)
    assert found.comparisons == ()
    assert found.missing["l04/lab/cpu"].startswith("digest: ")


def test_a_refused_build_has_the_bundles_of_its_executed_pages(
    builds, courses_pages, tmp_path
):
    root, left = tmp_path / "root", tmp_path / "left"
    book = make_book(root, lab=lab("cpu"), other=lab("cpu").replace("l04", "l02"))
    shutil.copy(project.ROOT / "pyproject.toml", root)
    shutil.copytree(builds[1].bundles["l04/lab/cpu"], left / "cpu")
    [page] = [page for page in find_pages(book) if page.docname == "lab"]
    place = root / ".cache" / "pages" / "lab" / "0123"
    write_page(place, page, page.notebook, left, 1.0, [1.0])
    pin = project.engine_pin()
    found = read_build(root, pin, tmp_path / "no site")
    assert found.bundles == {"l04/lab/cpu": place / "outputs" / "cpu"}
    assert read_build(root, "9.9.9", tmp_path / "no site").bundles == {}
    assert compare_builds(builds[0], found).changed == ()


def test_a_metric_beyond_tolerance_a_warning_and_a_flipped_relation_are_named(builds):
    folder = builds[1].bundles["l04/lab/cpu"]
    metrics(lambda m: m["G3"]["overshoot"].update(value=1.0))(folder)
    facts(warnings=["Something new."])(folder)
    seal(folder)
    found = compare_builds(*builds)
    assert found.state == "differs"
    text = refresh.document(found).markdown()
    assert "- Engine warning gained: Something new." in text
    assert "broken: " in text
    assert "| differs | G3.overshoot |" in text
    assert "## L04 lab: engine version" in text
    below = text.split("## L04 lab: ")[1].split("## ")[0]
    assert "| equal |" not in below


PAGE = """<nav><p>Menu 1.</p></nav><article>
<h1>Lesson</h1>
<p>It rose in <span class="measured">{time} s</span>. Then it
stayed, run {run}, {date}.</p><p>Measured with Genesis {version}.</p>
<ul><li>one <ul><li>inner</li></ul></li></ul>
<div class="cell_input"><pre>x = {source}</pre></div>
<table><tr><th>case</th><th>value</th></tr><tr><td>G1</td><td><p>{cell}</p></td></tr></table>
<pre>line one
[Genesis] [04:28:32] [INFO] Built in {source} s. Box {source}. It has a name.
[W 11/21/26 04:41:27.754 12581] [frontend.cpp:b@1] {source}
counted {line}</pre>
<table><tr><td>run</td><td>{run}</td></tr><tr><td>sha256</td><td>{digest}</td></tr></table>
<script>var n = {source};</script>
</article>"""
SAME = {
    "time": "0.31",
    "source": "1",
    "cell": "7.5",
    "line": "12345678",
    "date": "2026-11-21",
    "run": "7c694fce",
    "digest": "0123456789abcdef" * 4,
    "version": "1.0",
}


@pytest.mark.parametrize(
    ("change", "moved"),
    [
        (
            {"source": "2", "run": "12345678", "digest": "f" * 64, "version": "9.9.9"},
            [],
        ),
        ({"date": "2027-01-02T05:11:12.25Z"}, []),
        (
            {"version": "9.9"},
            [("Measured with Genesis 1.0.", "Measured with Genesis 9.9.")],
        ),
        ({"time": "0.32"}, [("It rose in 0.31 s.", "It rose in 0.32 s.")]),
        ({"cell": "7.6"}, [("G1 | 7.5 |", "G1 | 7.6 |")]),
        ({"line": "87654321"}, [("counted 12345678", "counted 87654321")]),
        ({"line": "12345678\nmore"}, [("", "more")]),
    ],
)
def test_a_changed_sentence_is_listed_and_what_all_runs_differ_in_is_not(
    tmp_path, change, moved
):
    for name, values in (("old", SAME), ("new", SAME | change)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "lab.html").write_text(PAGE.format_map(values))
    found = list(
        changed_sentences(tmp_path / "old", tmp_path / "new", ("1.0", "9.9.9"))
    )
    assert found == [("lab", *pair) for pair in moved]


def test_a_page_of_one_build_alone_is_listed_and_what_each_build_changes_never(
    tmp_path,
):
    assert Path(f"{LEDGER}.html") in refresh.LEFT_OUT
    assert all(
        (project.BOOK / path.with_suffix(".md")).is_file() for path in refresh.LEFT_OUT
    )
    for name in (*refresh.LEFT_OUT, "more.html"):
        page = tmp_path / "new" / name
        page.parent.mkdir(parents=True, exist_ok=True)
        page.write_text("<p>New.</p>")
    found = list(
        changed_sentences(tmp_path / "old", tmp_path / "new", ("1.0", "9.9.9"))
    )
    assert found == [("more", "", "New.")]
