"""The refresh report on bundles: metrics, relations, warnings and what became stale."""

import shutil
from pathlib import Path

import pytest
from spoilers import metrics, part, predicate, seal

from robo_genesis.core import project
from robo_genesis.evidence import bundle
from robo_genesis.maintain import report as refresh
from robo_genesis.maintain.report import LEFT_OUT, changed_sentences, compare_builds, recorded
from robo_genesis.pipeline.bundles import status
from robo_genesis.pipeline.bundles.status import Status
from robo_genesis.site.evidence.ledger import LEDGER


@pytest.fixture
def builds(pristine, tmp_path) -> tuple[Path, Path]:
    """Two builds with one lab each, and a site of one sentence."""
    both = tmp_path / "old", tmp_path / "new"
    for build in both:
        shutil.copytree(pristine, build / "evidence" / "l04" / "cpu")
        (build / "html").mkdir()
        (build / "html" / "index.html").write_text("<p>Same.</p>")
    part("engine", version="9.9.9")(both[1] / "evidence" / "l04" / "cpu")
    return both


def compared(builds: tuple[Path, Path], **records) -> refresh.Refresh:
    before, after = records.get("recorded", ({}, {}))
    return compare_builds(("1.0", "9.9.9"), builds, (before, after), ("a==1\n", "a==1\nb==2\n"))


def test_equal_metrics_are_reported_as_such(builds):
    found = compared(builds)
    assert (found.state, found.packages, found.changed) == ("equal", {"b": ("", "2")}, ())
    text = refresh.document(found).markdown()
    assert text.startswith(
        "# Engine 1.0 → 9.9.9\n\n**Equal; changed packages: 1, changed sentences: 0, "
    )
    assert "| l04 lab | equal | Equal. Rows: " in text
    assert "\n| equal | " not in text
    assert "No bundle is recorded." in text
    assert "No sentence of the site changed." in text


def test_a_bundle_that_one_build_lacks_makes_the_builds_not_comparable(builds):
    for build in builds:
        shutil.copytree(build / "evidence/l04/cpu", build / "pages/l04/lecture/cpu")
    assert len(compared(builds).comparisons) == 2
    (builds[1] / "pages").rename(builds[1] / "gone")
    found = compared(builds)
    assert (len(found.comparisons), found.missing) == (1, ("l04/lecture/cpu",))
    shutil.rmtree(builds[1] / "evidence" / "l04")
    found = compared(builds)
    assert (found.state, found.missing) == ("not comparable", ("l04/cpu", "l04/lecture/cpu"))
    assert "| l04/cpu | not comparable | In one build only. |" in refresh.document(found).markdown()


def test_a_metric_beyond_tolerance_a_warning_and_a_flipped_relation_are_named(builds):
    folder = builds[1] / "evidence" / "l04" / "cpu"
    metrics(lambda m: m["G3"]["overshoot"].update(value=1.0))(folder)
    predicate(warnings=["Something new."])(folder)
    seal(folder)
    found = compared(builds)
    assert found.state == "differs"
    text, page = refresh.document(found).markdown(), refresh.document(found).html()
    assert "- Engine warning gained: Something new." in text
    assert "- Engine warning lost: Approximating tendon." in text
    assert "flipped" in text
    assert "| differs | G3.overshoot |" in text
    assert page.count("<h1>") == 1
    assert "<h2>L04 lab: engine version" in page
    assert "flipped" in page
    assert "http" not in page
    (row,) = [line for line in text.splitlines() if line.startswith("| l04 lab |")]
    assert row.startswith("| l04 lab | differs | Differs. Rows: ")
    below = text.split("## L04 lab: ")[1].split("## ")[0]
    states = [line.split(" | ")[0] for line in below.splitlines() if line.startswith("| ")][2:]
    assert states[0] == "| differs"
    assert set(states) <= {"| differs", "| inconclusive", "| within tolerance", "| shown"}


def test_a_bundle_that_a_new_pin_makes_stale_is_named_with_both_states(builds):
    def state(name: str, reason: str) -> dict[str, Status]:
        return {"l04/amdgpu": Status(name, "amdgpu", reason, None)}

    found = compared(builds, recorded=(state("verified", ""), state("stale", "older")))
    assert found.stale == ["l04/amdgpu"]
    assert "| l04/amdgpu | verified | stale | older |" in refresh.document(found).markdown()
    assert compared(builds, recorded=(state("stale", "a"), state("stale", "b"))).stale == []


@pytest.fixture
def copy(folder, tmp_path, courses_pages) -> Path:
    """A checkout of its own pin with a recorded bundle."""
    root = tmp_path / "copy"
    shutil.copytree(folder, root / "book" / "evidence" / "l04" / "cpu")
    shutil.copytree(project.ROOT / "robo_genesis", root / "robo_genesis")
    for name in ("pyproject.toml", "requirements.lock"):
        shutil.copy(project.ROOT / name, root)
    return root


def test_recorded_bundles_are_verified_with_the_pin_of_their_own_checkout(copy):
    assert {name: found.state for name, found in recorded(copy).items()} == {"l04/cpu": "verified"}
    pin = copy / "pyproject.toml"
    pin.write_text(pin.read_text().replace(f"=={project.engine_pin()}", "==9.9.9"))
    found = recorded(copy)["l04/cpu"]
    assert found.state == "stale"
    assert "engine.version is" in found.reason
    assert "9.9.9" in found.reason
    assert found.summary.endswith(f"Genesis {project.engine_pin()}; this site uses 9.9.9.")
    absent = status.recorded_status(copy / "book", "l04", "cuda", root=copy)
    assert absent.reason == "No run on this backend is recorded for Genesis 9.9.9."
    (copy / "book/evidence/l04/cpu/manifest.json").write_text("{}")
    assert recorded(copy)["l04/cpu"].state == "refused"


def test_a_built_bundle_that_cannot_be_read_is_an_error(builds):
    (builds[1] / "evidence" / "l04" / "cpu" / "metrics.json").write_text("{}")
    with pytest.raises(bundle.BundleRefused):
        compared(builds)


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
    "time": "0.31", "source": "1", "cell": "7.5", "line": "12345678", "date": "2026-11-21",
    "run": "7c694fce", "digest": "0123456789abcdef" * 4, "version": "1.0",
}  # fmt: skip


@pytest.mark.parametrize(
    ("change", "moved"),
    [
        ({}, []),
        ({"source": "2"}, []),
        ({"run": "12345678"}, []),
        ({"digest": "f" * 64}, []),
        ({"date": "2027-01-02T05:11:12.25Z"}, []),
        ({"version": "9.9.9"}, []),
        ({"version": "9.9"}, [("Measured with Genesis 1.0.", "Measured with Genesis 9.9.")]),
        ({"time": "0.32"}, [("It rose in 0.31 s.", "It rose in 0.32 s.")]),
        ({"cell": "7.6"}, [("G1 | 7.5 |", "G1 | 7.6 |")]),
        ({"line": "87654321"}, [("counted 12345678", "counted 87654321")]),
        ({"line": "12345678\nmore"}, [("", "more")]),
        ({"date": "5"}, [("Then it stayed, run 7c694fce, 2026-11-21.",
                          "Then it stayed, run 7c694fce, 5.")]),
    ],
)  # fmt: skip
def test_a_sentence_that_changed_is_listed_and_what_any_two_runs_differ_in_is_not(
    tmp_path, change, moved
):
    for name, values in (("old", SAME), ("new", SAME | change)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "lab.html").write_text(PAGE.format_map(values))
    found = list(changed_sentences(tmp_path / "old", tmp_path / "new", ("1.0", "9.9.9")))
    assert found == [("lab", *pair) for pair in moved]


def test_a_page_of_one_build_alone_is_listed_and_what_each_build_changes_never(tmp_path):
    assert Path(f"{LEDGER}.html") in LEFT_OUT
    assert all((project.BOOK / path.with_suffix(".md")).is_file() for path in LEFT_OUT)
    for name in (*LEFT_OUT, "more.html"):
        page = tmp_path / "new" / name
        page.parent.mkdir(parents=True, exist_ok=True)
        page.write_text("<p>New.</p>")
    found = list(changed_sentences(tmp_path / "old", tmp_path / "new", ("1.0", "9.9.9")))
    assert found == [("more", "", "New.")]
