import re
import shutil
import subprocess
import sys
from pathlib import Path
from textwrap import dedent

import numpy as np
import pytest
from bundles import QUADRANTS
from lessons.changed_runs import shift
from spoilers import (
    CHECKS,
    METRICS,
    both,
    check,
    drop_case,
    facts,
    joint,
    modules,
    part,
    pop,
    put,
    rewrite,
    seal,
    write,
)

from robo_genesis.__main__ import main
from robo_genesis.core.project import ROOT
from robo_genesis.evidence import report
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.evidence.compare import compare
from robo_genesis.evidence.rows import SEVERITY
from robo_genesis.lessons.l04 import spec as l04


@pytest.fixture
def other(folder, tmp_path) -> Path:
    """A second bundle with the same content."""
    return Path(shutil.copytree(folder, tmp_path / "other" / "cpu"))


same = facts()  # A change of nothing


@pytest.fixture
def compared(folder, other):
    """Compare the two after changes of the second and of the first, sealed again."""

    def run(*changes, first=same, swap=False):
        both(first, seal)(folder)
        both(*changes, seal)(other)
        return compare(*((other, folder) if swap else (folder, other)))

    return run


def value(case, metric, new):
    """Put a metric at a new value, or move it by a function of the old one."""
    return put(METRICS, case, metric, value=new)


def rows(comparison, title):
    (section,) = (part for part in comparison.sections if part.title == title)
    return section.rows


ACCELERATED = part("backend", actual="cuda", actual_at_end="cuda")
UPGRADED = part("engine", version="9.9.9")


@pytest.mark.parametrize(
    ("spoiler", "axis", "note"),
    [
        (same, "repeat", "Both have the same run id"),
        (UPGRADED, rf"engine version .* → 9\.9\.9 \(quadrants {QUADRANTS}\)", ""),
        (ACCELERATED, "backend cpu → cuda", ""),
        (
            modules(metrics="0" * 64),
            "same engine and backend, other code",
            "may be the cause: metrics.",
        ),
        (facts(warnings=["New one."]), "repeat", "Engine warning gained: New one."),
        (facts(warnings=[]), "repeat", "Engine warning lost: Approximating tendon."),
    ],
)
def test_axis_and_notes_name_what_differs(compared, spoiler, axis, note):
    comparison = compared(spoiler)
    assert re.fullmatch(axis, comparison.axis)
    assert note in " ".join(comparison.notes)
    assert {part.state for part in comparison.sections} == {"equal"}
    assert len(rows(comparison, "Values")) == 4 * 9
    assert len(rows(comparison, "Arrays")) == 4 * 11


@pytest.mark.parametrize(
    ("spoiler", "obstacle"),
    [
        (part("parameters", stepped_joint="joint2"), "parameters.stepped_joint"),
        (facts(seed=1), "The seed differs: 0 and 1"),
        (part("engine", precision="64"), "The precision differs: 32 and 64"),
        (both(ACCELERATED, UPGRADED), ") and backend cpu → cuda"),
    ],
)
def test_another_question_or_a_second_axis_is_not_comparable(
    compared, spoiler, obstacle
):
    comparison = compared(spoiler)
    assert (comparison.state, comparison.sections) == ("not comparable", ())
    assert obstacle in report.summary(comparison)


def limit(speed):
    atol, rtol = l04.TOLERANCES["rad/s"]
    return atol + rtol * speed


@pytest.mark.parametrize(
    ("case", "metric", "new", "state"),
    [
        ("G1", "initial_error", lambda v: v + 5e-6, "differs"),  # its own tolerance
        ("G1", "peak_speed", lambda v: v - 0.99 * limit(v), "within tolerance"),
        ("G1", "peak_speed", lambda v: v - 1.01 * limit(v), "differs"),
        ("G1", "settling_time", None, "differs"),
        ("baseline", "saturation_samples", lambda v: v + 1, "differs"),
    ],
)
@pytest.mark.parametrize("swap", [False, True])
def test_values_agree_within_their_tolerance(compared, case, metric, new, state, swap):
    comparison = compared(value(case, metric, new), swap=swap)
    title = "Exact counts" if metric.endswith("samples") else "Values"
    row = rows(comparison, title)[0]
    assert (comparison.state, row.state) == (state, state)
    assert row.what == f"{case}.{metric}"
    assert ("not observed" in (row.old, row.new)) == (new is None)


@pytest.mark.parametrize(
    ("old", "new", "state"),
    [
        ((1.0, 2.0), (1.0, 2.0), "equal"),
        ((2.0, 1.0), (1.0, 2.0), "differs"),
        ((2.0, 1.0), (2.0, 1.0), "differs"),
        ((1.0, 2.0), (1.0, 1.04), "inconclusive"),
        ((2.0, 1.0), (1.0, 1.04), "differs"),
        ((1.0, 2.0), (None, 1.0), "differs"),
        ((1.0, 2.0), (None, None), "inconclusive"),
    ],
)
def test_claimed_orderings(compared, old, new, state):
    first, second = (
        both(value("G1", "peak_speed", a), value("G2", "peak_speed", b))
        for a, b in (old, new)
    )
    found = rows(compared(second, first=first), "Relations")
    [row] = [row for row in found if row.what.startswith("peak_speed: G2 ")]
    assert row.state == state


without_g3 = both(drop_case, pop(METRICS, "G3"))
failed = check(3, passed=False)


@pytest.mark.parametrize(
    ("first", "second", "title", "what"),
    [
        (same, without_g3, "Coverage", "metric.G3.overshoot"),
        (same, pop("manifest.json", "checks", -1), "Coverage", "check.functions"),
        (
            same,
            put(METRICS, "G1", "overshoot", unit="degree"),
            "Coverage",
            "metric.G1.overshoot",
        ),
        (same, joint(3, lower=None), "Coverage", "joint.joint4.lower"),
        (failed, failed, "Invariants", CHECKS[3]),
        (
            same,
            part("engine", files_match_wheel=False),
            "Invariants",
            "engine files match the wheel",
        ),
    ],
)
def test_what_one_or_both_sides_lack_differs(compared, first, second, title, what):
    comparison = compared(second, first=first)
    assert comparison.state == "differs"
    differing = [row for row in rows(comparison, title) if row.state == "differs"]
    assert what in [row.what for row in differing]


@pytest.mark.parametrize(
    ("amount", "state"), [(0.5, "differs"), (5e-4, "within tolerance")]
)
@pytest.mark.parametrize(("dof", "unit"), [(3, "rad/s"), (8, "m/s")])
def test_arrays_agree_within_their_tolerance(compared, amount, state, dof, unit):
    comparison = compared(rewrite(qd=shift((7, dof), amount)))
    row = rows(comparison, "Arrays")[0]
    assert (comparison.state, row.state) == (state, state)
    assert row.what == f"G1 qd_rad_s_or_m_s[7, {dof}]"
    assert row.delta.endswith(f" {unit}")
    assert (row.what in report.summary(comparison)) == (state == "differs")


def test_an_array_without_a_tolerance_is_equal_and_a_case_may_have_no_bound(
    compared, monkeypatch
):
    spoiler = rewrite(q=shift((7, 3), 1e-6), qd=shift((7, 3), 0.5))
    monkeypatch.setattr(l04, "TOLERANCES", {"rad/s": (1.0, 0.0)})
    first, second, *others = rows(compared(spoiler), "Arrays")
    assert (first.state, first.allowed) == ("differs", "0 rad")
    assert (second.state, second.allowed) == ("within tolerance", "1 rad/s")
    assert {row.state for row in others} == {"equal"}
    monkeypatch.setattr(l04, "TOLERANCES", {"G1": (np.inf, 0.0)})
    assert compared().state == "within tolerance"


def test_performance_is_shown_and_decides_nothing(compared):
    record = {"unit": "steps/s", "class": "performance", "from": ["clock"]}
    slow, fast = (
        put(METRICS, "G1", speed=record | {"value": steps}) for steps in (10.0, 100.0)
    )
    comparison = compared(slow, first=fast)
    (row,) = rows(comparison, "Performance")
    assert (row.old, row.new, row.state) == ("100 steps/s", "10 steps/s", "shown")
    assert comparison.state == "equal"


@pytest.mark.parametrize(
    ("spoiler", "said"),
    [
        (write(METRICS, "{}"), "digest: {}: metrics.json: sha256 is"),
        (both(facts(lesson="l99"), seal), "lesson: Lesson 'l99' does not exist."),
    ],
)
def test_bundles_are_whole_and_of_one_page(folder, other, spoiler, said):
    spoiler(other)
    with pytest.raises(BundleRefused, match=said.format(other)):
        compare(folder, other)


def test_the_report_is_worst_first_and_keeps_words_as_words(compared):
    unlike = compared(
        UPGRADED,
        facts(warnings=["<b>1 | 2</b>\n# see https://example.org"]),
        value("G1", "final_error", lambda v: v + 0.0002),
        value("G2", "final_error", lambda v: v + 0.02),
        value("G1", "overshoot", 0.0),
        value("G2", "overshoot", 0.0),
    )
    order = [SEVERITY.index(section.state) for section in unlike.sections]
    assert len(set(order)) > 2
    ranks = [
        [(SEVERITY.index(row.state), row.weight) for row in part.rows]
        for part in unlike.sections
    ]
    assert all(of == sorted(of, reverse=True) for of in [order, *ranks])
    text = report.summary(unlike)
    assert "G2.final_error: " in text
    page = report.document(unlike).markdown()
    assert "- Engine warning gained: \\<b\\>1 \\| 2\\</b\\> \\# see https" in page
    table = [line for line in page.splitlines() if line.startswith("|")]
    assert {len(re.findall(r"(?<!\\)\|", line)) for line in table} <= {4, 5, 6, 7}


alike = both(value("G1", "peak_speed", 3.0), value("G2", "peak_speed", 3.0))
faster = value("G3", "peak_speed", lambda speed: speed + 0.1)


@pytest.mark.parametrize(
    ("old", "new", "status", "said"),
    [
        (same, same, 0, "same run id"),
        (same, faster, 1, "a changed cell of the notebook"),
        (alike, alike, 1, "is undecided: see the inconclusive lines"),
        (same, facts(seed=1), 2, "The seed differs: 0 and 1"),
        (same, facts(page="lecture"), 2, "Give two bundles of the same page"),
    ],
)
def test_the_command_compares_with_an_archive_and_writes_a_report(
    folder, other, tmp_path, capsys, old, new, status, said
):
    both(old, seal)(folder)
    both(new, seal)(other)
    archive = shutil.make_archive(str(tmp_path / "site"), "zip", folder)
    written = tmp_path / "a report"
    assert main(["compare", archive, str(other), "--report", str(written)]) == status
    assert said in "".join(capsys.readouterr())
    assert (written / "report.md").is_file() == (said[:8] != "Give two")


def test_what_is_no_bundle_is_refused_with_what_is_valid(other, tmp_path, capsys):
    (tmp_path / "notes.txt").write_text("no bundle")
    for given in ("nowhere", str(tmp_path / "notes.txt")):
        assert main(["compare", given, str(other)]) == 2
        assert "neither a folder nor a zip archive" in capsys.readouterr().err


def test_the_commands_for_teachers_grade_each_student_and_leave_the_bundles(
    folder, tmp_path
):
    """The block of ADOPTING.md, run twice: its output must not become a part of a bundle."""
    text = (ROOT / "ADOPTING.md").read_text()
    [block] = re.findall(r"(?m)^    mkdir -p compared\n(?:    .*\n)+", text)
    work = tmp_path / "course"
    for place in ("submitted/ada", "submitted/bob lee", "book/_build/evidence/l04/cpu"):
        shutil.copytree(folder, work / place)
    (work / "submitted/bob lee/notes.txt").write_text("not listed")
    python = work / ".venv/bin/python"
    python.parent.mkdir(parents=True)
    python.write_text(
        f"#!/bin/sh\nPYTHONPATH='{ROOT}' exec '{sys.executable}' \"$@\"\n"
    )
    python.chmod(0o755)
    for _ in range(2):
        command = ["bash", "-c", dedent(block)]
        done = subprocess.run(
            command, cwd=work, capture_output=True, text=True, check=True
        )
        assert done.stdout.splitlines() == ["ada 0", "bob lee 2"]
    assert "The runs agree" in (work / "compared/ada.txt").read_text()
    assert "notes.txt" in (work / "compared/bob lee.txt").read_text()
