import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from robo_genesis.core.project import ROOT
from robo_genesis.evidence import bundle, report
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.evidence.compare import compare, specification
from robo_genesis.evidence.findings import SEVERITY
from robo_genesis.lessons.l04 import spec as l04
from robo_genesis.lessons.l04.metrics import StepMetrics
from robo_genesis.lessons.l04.study import READING_UNITS

SPEC = specification("l04")


@pytest.fixture
def other(folder, tmp_path) -> Path:
    """A second bundle with the same content."""
    return Path(shutil.copytree(folder, tmp_path / "other" / "cpu"))


def edit(folder, name, change):
    """Change one JSON file, then list every file with its digest again."""
    path = folder / name
    value = json.loads(path.read_text("utf8"))
    change(value)
    path.write_text(json.dumps(value), "utf8")
    seal(folder)


def seal(folder):
    path = folder / "manifest.json"
    manifest = json.loads(path.read_text("utf8"))
    for subject in manifest["subject"]:
        subject["digest"]["sha256"] = bundle.sha256(folder / subject["name"])
    path.write_text(json.dumps(manifest), "utf8")


def predicate(folder, **values):
    edit(folder, "manifest.json", lambda m: m["predicate"].update(values))


def part(folder, name, **values):
    edit(folder, "manifest.json", lambda m: m["predicate"][name].update(values))


def value(folder, case, metric, new):
    """Put a metric at a new value, or move it by a function of the old one."""

    def change(metrics):
        record = metrics[case][metric]
        record["value"] = new(record["value"]) if callable(new) else new

    edit(folder, "metrics.json", change)


def rows(comparison, title):
    (section,) = (s for s in comparison.sections if s.title == title)
    return section.findings


def states(comparison):
    return {section.title: section.state for section in comparison.sections}


def test_equal_bundles_are_a_repeat(folder, other):
    comparison = compare(folder, other, SPEC)
    assert comparison.state == "equal"
    assert comparison.axis == "repeat"
    assert set(states(comparison).values()) == {"equal"}
    assert "Both have one run id: one is a copy of the other, or was edited." in comparison.notes
    assert len(rows(comparison, "Values")) == 4 * 9
    assert len(rows(comparison, "Arrays")) == 4 * 11


def test_an_engine_version_is_one_axis(folder, other, engine):
    part(other, "engine", version="9.9.9")
    comparison = compare(folder, other, SPEC)
    assert comparison.state == "equal"
    assert comparison.axis.startswith("engine version ")
    assert f"→ 9.9.9 (quadrants {engine.quadrants_version})" in comparison.axis


def test_a_backend_is_one_axis(folder, other):
    part(other, "backend", actual="cuda", actual_at_end="cuda")
    assert compare(folder, other, SPEC).axis == "backend cpu → cuda"


def test_other_switches_are_noted_and_no_difference(folder, other):
    predicate(other, environment={"QD_DEBUG": "1", "GS_ENABLE_ZEROCOPY": "0"})
    comparison = compare(folder, other, SPEC)
    said = "The engine's switches are not the same: none; QD_DEBUG=1, GS_ENABLE_ZEROCOPY=0."
    assert said in comparison.notes
    assert comparison.state == "equal"


def test_a_joint_that_owns_another_dof_is_a_difference(folder, other):
    edit(other, "arrays.json", lambda a: a["joints"][3].update(dof_idx_local=4, lower=None))
    (row,) = (f for f in rows(compare(folder, other, SPEC), "Coverage") if f.state == "differs")
    assert row.what == "joint joint4"
    assert row.old == "REVOLUTE, DOF 3, qpos 3, -3.0718 rad to -0.0698 rad"
    assert row.new == "REVOLUTE, DOF 4, qpos 3, no limit to -0.0698 rad"


def test_limits_that_differ_in_the_last_digits_do_not(folder, other):
    edit(other, "arrays.json", lambda a: a["joints"][3].update(lower=-3.07180000001))
    assert compare(folder, other, SPEC).state == "equal"


def test_two_axes_are_refused_and_both_named(folder, other):
    part(other, "backend", actual="cuda", actual_at_end="cuda")
    part(other, "engine", version="9.9.9")
    comparison = compare(folder, other, SPEC)
    assert comparison.state == "not comparable"
    assert comparison.sections == ()
    (obstacle,) = comparison.obstacles
    assert re.search(r"Two axes differ: engine version .* and backend cpu → cuda", obstacle)


@pytest.mark.parametrize(
    ("spoil", "named"),
    [
        (lambda f: part(f, "parameters", stepped_joint="joint2"), "parameters.stepped_joint"),
        (lambda f: part(f, "parameters", more=1), "parameters.more differs: absent and 1"),
        (lambda f: predicate(f, seed=1), "The seed differs: 0 and 1"),
        (lambda f: predicate(f, page="lecture"), "The page differs: 'lab' and 'lecture'"),
        (lambda f: predicate(f, lesson="l05"), "The new bundle is of 'l05', not of 'l04'"),
        (lambda f: part(f, "engine", precision="64"), "The precision differs: '32' and '64'"),
        (lambda f: part(f, "backend", actual_at_end="cuda"), "cpu at first and cuda at the end"),
    ],
)
def test_another_question_is_not_comparable(folder, other, spoil, named):
    spoil(other)
    comparison = compare(folder, other, SPEC)
    assert comparison.state == "not comparable"
    assert named in " ".join(comparison.obstacles)
    assert named in report.summary(comparison)


def test_other_code_is_named(folder, other):
    modules = bundle.read_manifest(other).predicate.source.modules | {"metrics": "0" * 64}
    part(other, "source", modules=modules)
    comparison = compare(folder, other, SPEC)
    assert comparison.axis == "same engine and backend, other code"
    assert "may be the cause: metrics." in " ".join(comparison.notes)


def test_warnings_gained_and_lost_are_named(folder, other):
    predicate(other, warnings=["New one."])
    notes = compare(folder, other, SPEC).notes
    assert "Engine warning gained: New one." in notes
    assert "Engine warning lost: Approximating tendon." in notes


def test_a_value_within_its_tolerance(folder, other):
    value(other, "G1", "peak_speed", lambda v: v * 1.001)
    comparison = compare(folder, other, SPEC)
    assert comparison.state == "within tolerance"
    row = rows(comparison, "Values")[0]
    assert (row.what, row.state) == ("G1.peak_speed", "within tolerance")
    assert row.delta.endswith(" rad/s")
    assert 0 < row.weight < 1


@pytest.mark.parametrize("share", [0.99, 1.01])
def test_the_tolerance_is_atol_and_rtol(folder, other, share):
    atol, rtol = l04.TOLERANCES["rad/s"]
    value(folder, "G1", "peak_speed", 3.0)
    value(other, "G1", "peak_speed", 3.0 - share * (atol + rtol * 3.0))
    row = rows(compare(folder, other, SPEC), "Values")[0]
    assert row.state == ("within tolerance" if share < 1 else "differs")
    assert row.allowed == "0.004 rad/s"


def test_a_metric_s_own_tolerance_goes_first(folder, other):
    value(other, "G1", "initial_error", lambda v: v + 5e-6)
    assert rows(compare(folder, other, SPEC), "Values")[0].what == "G1.initial_error"
    assert compare(folder, other, SPEC).state == "differs"


def test_a_value_outside_its_tolerance(folder, other):
    value(other, "G1", "final_error", lambda v: v + 0.001)
    comparison = compare(folder, other, SPEC)
    assert comparison.state == "differs"
    assert rows(comparison, "Values")[0].what == "G1.final_error"


@pytest.mark.parametrize("side", ["folder", "other"])
def test_not_observed_on_one_side_differs(folder, other, side):
    value({"folder": folder, "other": other}[side], "G1", "settling_time", None)
    comparison = compare(folder, other, SPEC)
    assert comparison.state == "differs"
    row = rows(comparison, "Values")[0]
    assert row.what == "G1.settling_time"
    assert "not observed" in (row.old, row.new)


def test_not_observed_on_both_sides_is_equal(folder, other):
    for side in (folder, other):
        value(side, "G1", "settling_time", None)
    assert compare(folder, other, SPEC).state == "equal"


def test_counts_are_exact(folder, other):
    value(other, "baseline", "saturation_samples", lambda v: v + 1)
    comparison = compare(folder, other, SPEC)
    assert states(comparison)["Exact counts"] == "differs"
    assert rows(comparison, "Exact counts")[0].delta == "1"


def relation(comparison, metric):
    (row,) = (r for r in rows(comparison, "Relations") if r.what.startswith(f"{metric}: G2 "))
    return row


@pytest.mark.parametrize(
    ("old", "new", "state", "verdict"),
    [
        ((1.0, 2.0), (1.0, 2.0), "equal", "held in both"),
        ((1.0, 2.0), (2.0, 1.0), "differs", "flipped"),
        ((2.0, 1.0), (1.0, 2.0), "differs", "flipped"),
        ((2.0, 1.0), (2.0, 1.0), "differs", "broken in both"),
        ((1.0, 2.0), (1.0, 1.04), "inconclusive", "inconclusive"),
        ((1.0, 2.0), (1.0, 0.96), "inconclusive", "inconclusive"),
        ((2.0, 1.0), (1.0, 1.04), "differs", "broken in one, undecided in the other"),
        ((1.0, 2.0), (None, 1.0), "differs", "flipped"),
        ((1.0, 2.0), (1.0, None), "equal", "held in both"),
        ((1.0, 2.0), (None, None), "inconclusive", "inconclusive"),
    ],
)
def test_claimed_orderings(folder, other, old, new, state, verdict):
    for side, speeds in ((folder, old), (other, new)):
        for case, speed in zip(("G1", "G2"), speeds, strict=True):
            value(side, case, "peak_speed", speed)
    row = relation(compare(folder, other, SPEC), "peak_speed")
    assert (row.state, row.what.split(", ")[1:]) == (state, verdict.split(", "))


@pytest.mark.parametrize(
    ("rise", "state"), [(0.10, "equal"), (0.11, "equal"), (0.12, "inconclusive"), (0.13, "differs")]
)
def test_no_later_allows_the_same_sample(folder, other, rise, state):
    for side in (folder, other):
        value(side, "G1", "rise_time", 0.11)
        value(side, "G2", "rise_time", rise)
    assert relation(compare(folder, other, SPEC), "rise_time").state == state


def test_an_undecided_ordering_alone_is_inconclusive(folder):
    for case in ("G1", "G2"):
        value(folder, case, "peak_speed", 3.0)
    assert compare(folder, folder, SPEC).state == "inconclusive"


def test_a_missing_case_differs(folder, other):
    edit(other, "arrays.json", lambda a: a["cases"].pop("G3"))
    edit(other, "metrics.json", lambda m: m.pop("G3"))
    comparison = compare(folder, other, SPEC)
    assert states(comparison)["Coverage"] == "differs"
    found = {row.what: (row.old, row.new) for row in rows(comparison, "Coverage")}
    assert found["case G3"] == found["metric G3.overshoot"] == ("present", "missing")


def test_what_both_lack_is_missing(folder):
    edit(folder, "arrays.json", lambda a: a["cases"].clear())
    edit(folder, "metrics.json", lambda m: m.clear())
    predicate(folder, checks=[])
    comparison = compare(folder, folder, SPEC)
    assert comparison.state == "differs"
    found = {row.what: (row.old, row.new) for row in rows(comparison, "Coverage")}
    assert found["case G1"] == ("missing", "missing")
    assert found["checks"] == ("none", "none")


def test_a_missing_check_or_another_unit_differs(folder, other):
    edit(other, "manifest.json", lambda m: m["predicate"]["checks"].pop())
    edit(other, "metrics.json", lambda m: m["G1"]["overshoot"].update(unit="degree"))
    coverage = rows(compare(folder, other, SPEC), "Coverage")
    found = {row.what for row in coverage if row.state == "differs"}
    assert found == {"check posture", "unit and class of G1.overshoot"}


def test_a_failed_check_differs_even_on_both_sides(folder):
    edit(folder, "manifest.json", lambda m: m["predicate"]["checks"][3].update(passed=False))
    comparison = compare(folder, folder, SPEC)
    assert states(comparison)["Invariants"] == comparison.state == "differs"
    assert rows(comparison, "Invariants")[0].old == "FAILED"


def test_an_engine_with_changed_files_differs(folder, other):
    part(other, "engine", files_match_wheel=False)
    row = rows(compare(folder, other, SPEC), "Invariants")[0]
    assert (row.what, row.new) == ("engine files match the wheel", "FAILED")


def rewrite(folder, name, change):
    path = folder / "arrays" / "G1.npz"
    with np.load(path) as archive:
        kept = {**archive}
    kept[name] = change(kept[name])
    np.savez_compressed(path, **kept)
    seal(folder)


def test_the_largest_distance_of_arrays_is_shown_and_decides_nothing(folder, other):
    def change(array):
        array[7, 3] += 0.5
        return array

    rewrite(other, "qd_rad_s_or_m_s", change)
    comparison = compare(folder, other, SPEC)
    row = rows(comparison, "Arrays")[0]
    assert (row.what, row.state) == ("G1 qd_rad_s_or_m_s", "shown")
    assert row.delta == "0.5 rad/s or m/s"
    assert comparison.state == "within tolerance"


def test_performance_is_shown_and_decides_nothing(folder, other):
    speed = {"unit": "steps/s", "class": "performance", "from": ["clock"]}
    for side, steps in ((folder, 100.0), (other, 10.0)):
        edit(side, "metrics.json", lambda m, v=steps: m["G1"].update(speed=speed | {"value": v}))
    comparison = compare(folder, other, SPEC)
    (row,) = rows(comparison, "Performance")
    assert (row.old, row.new, row.state) == ("100 steps/s", "10 steps/s", "shown")
    assert comparison.state == "equal"


@pytest.mark.parametrize("name", ["metrics.json", "arrays.json", "arrays/G1.npz"])
def test_a_file_that_is_not_the_listed_one_is_refused(folder, other, name):
    (other / name).write_bytes((other / name).read_bytes() + b" ")
    with pytest.raises(BundleRefused, match=r"^digest: .*is not what its manifest lists"):
        compare(folder, other, SPEC)


def test_a_file_that_is_missing_is_refused(folder, other):
    (other / "arrays" / "G1.npz").unlink()
    with pytest.raises(BundleRefused, match=r"^files: arrays/G1.npz must stand in"):
        compare(folder, other, SPEC)


def test_numbers_beyond_measure_and_arrays_of_words_are_refused(folder, other):
    value(other, "G1", "overshoot", 10**400)
    with pytest.raises(BundleRefused, match=r"^bad-schema: G1.overshoot"):
        compare(folder, other, SPEC)
    name = "start_qd_rad_s_or_m_s"
    rewrite(folder, name, lambda a: a.astype("U5"))
    edit(folder, "arrays.json", lambda a: a["cases"]["G1"]["variables"][name].update(dtype="<U5"))
    with pytest.raises(BundleRefused, match=r"^labels: .* dtype is '<U5'"):
        compare(folder, folder, SPEC)


def test_an_unknown_lesson_is_refused():
    with pytest.raises(
        BundleRefused, match=r"^lesson: Lesson 'l99' does not exist. Choices: l02, .*l04\."
    ):
        specification("l99")


def test_the_lesson_declares_every_unit_and_margins_above_the_noise():
    by_name = StepMetrics.about("unit")
    units = set(by_name.values()) | set(READING_UNITS.values())
    assert units - {"1"} <= set(l04.TOLERANCES)
    assert set(l04.TOLERANCES) <= units | set(by_name)
    assert len(l04.RELATIONS) == sum(map(len, l04.PREDICTIONS.values()))
    for pair, metric, order, margin in l04.RELATIONS:
        assert (metric, order) in l04.PREDICTIONS[pair]
        assert margin > l04.RESOLUTION[by_name[metric]]


@pytest.fixture
def unlike(folder, other):
    """A comparison with something of every state."""
    part(other, "engine", version="9.9.9")
    predicate(other, warnings=["<b>1 | 2</b>\n# see https://example.org"])
    value(other, "G1", "final_error", lambda v: v + 0.0002)
    value(other, "G2", "final_error", lambda v: v + 0.02)
    value(other, "G3", "peak_speed", lambda v: v + 0.0001)
    value(other, "G1", "overshoot", 0.0)
    value(other, "G2", "overshoot", 0.0)
    return compare(folder, other, SPEC)


def test_worst_first(unlike):
    order = [SEVERITY.index(section.state) for section in unlike.sections]
    assert order == sorted(order, reverse=True)
    assert len(set(order)) > 2
    for section in unlike.sections:
        ranks = [(SEVERITY.index(f.state), f.weight) for f in section.findings]
        assert ranks == sorted(ranks, reverse=True)
    values = [row.what for row in rows(unlike, "Values")]
    assert values.index("G2.final_error") < values.index("G1.final_error")
    for page in (report.markdown(unlike), report.html(unlike)):
        assert page.index("Values") < page.index("Relations") < page.index("Invariants")


def test_the_summary_names_what_is_not_well(unlike):
    text = report.summary(unlike)
    assert text.splitlines()[1].startswith("Differs. Rows: ")
    assert "G2.final_error: " in text
    assert "overshoot: G2 higher than G1, inconclusive" in text
    assert "No performance is recorded yet." in text


def test_the_page_fetches_nothing_and_keeps_words_as_words(unlike):
    page = report.html(unlike)
    assert not re.search(r"<(script|link|img|iframe|a)\b|\b(src|href)=|@import|url\(", page)
    assert "&lt;b&gt;1 | 2&lt;/b&gt;" in page
    assert "prefers-color-scheme: dark" in page
    assert page.count("<table>") == page.count('<div class="box" role="region"') == 7
    assert page.count("<h1>") == 1


def test_the_markdown_keeps_words_as_words(unlike):
    page = report.markdown(unlike)
    assert "- Engine warning gained: \\<b\\>1 \\| 2\\</b\\> \\# see https" in page
    for line in page.splitlines():
        if line.startswith("|"):
            assert len(re.findall(r"(?<!\\)\|", line)) in (4, 5, 6, 7)


def run(*arguments):
    """Run the command; what the package prints must be no traceback."""
    done = subprocess.run(
        [sys.executable, str(ROOT / "build_scripts" / "compare.py"), *map(str, arguments)],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert "Traceback" not in done.stderr
    return done


@pytest.mark.parametrize(
    ("spoil", "status"),
    [
        (lambda f: None, 0),
        (lambda f: value(f, "G3", "peak_speed", lambda v: v + 0.0001), 0),
        (lambda f: value(f, "G3", "peak_speed", lambda v: v + 0.1), 1),
        (lambda f: predicate(f, seed=1), 2),
    ],
    ids=["equal", "within tolerance", "differs", "not comparable"],
)
def test_the_exit_status(folder, other, tmp_path, spoil, status):
    spoil(other)
    done = run("--report", tmp_path / "a report", folder, other)
    assert done.returncode == status, done.stderr
    assert sorted(p.name for p in (tmp_path / "a report").iterdir()) == ["report.html", "report.md"]
    assert f"Report: {tmp_path / 'a report' / 'report.html'}" in done.stdout


def test_an_inconclusive_comparison_exits_1(folder, tmp_path):
    for case in ("G1", "G2"):
        value(folder, case, "peak_speed", 3.0)
    assert run("--report", tmp_path / "report", folder, folder).returncode == 1


def test_a_refused_bundle_exits_2_and_writes_nothing(folder, other, tmp_path):
    (other / "metrics.json").write_text("{}")
    done = run("--report", tmp_path / "report", folder, other)
    assert done.returncode == 2
    assert done.stderr.startswith("Refused: digest: metrics.json")
    assert not (tmp_path / "report").exists()


@pytest.mark.parametrize("missing", [0, 1])
def test_a_folder_that_is_missing_exits_2_with_the_usage(folder, missing):
    folders = [folder, folder]
    folders[missing] = ""
    done = run("--report", "", *folders)
    assert done.returncode == 2
    assert done.stderr.startswith(f"{('OLD', 'NEW')[missing]}='' is no folder. Usage: make compare")


def test_a_report_that_cannot_be_written_exits_2(folder, tmp_path):
    (tmp_path / "file").touch()
    done = run("--report", tmp_path / "file", folder, folder)
    assert done.returncode == 2
    assert "Give another folder." in done.stderr
