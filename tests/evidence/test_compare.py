import re
import runpy
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from bundles import QUADRANTS
from spoilers import (
    METRICS,
    both,
    changed_at,
    check,
    drop_case,
    facts,
    joint,
    manifest,
    modules,
    part,
    pop,
    put,
    rewrite,
    seal,
    write,
)

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
    """Compare the two after the given changes of the second and of the first, sealed again."""

    def run(*changes, first=same, swap=False):
        both(first, seal)(folder)
        both(*changes, seal)(other)
        return compare(*((other, folder) if swap else (folder, other)))

    return run


def value(case, metric, new):
    """Put a metric at a new value, or move it by a function of the old one."""
    return put(METRICS, case, metric, value=new)


def rows(comparison, title):
    (section,) = (s for s in comparison.sections if s.title == title)
    return section.rows


ACCELERATED = part("backend", actual="cuda", actual_at_end="cuda")
UPGRADED = part("engine", version="9.9.9")


@pytest.mark.parametrize(
    ("spoiler", "axis"),
    [
        (same, "repeat"),
        (UPGRADED, rf"engine version .* → 9\.9\.9 \(quadrants {QUADRANTS}\)"),
        (ACCELERATED, "backend cpu → cuda"),
        (
            part("source", modules={"metrics": "0" * 64}),
            "same engine and backend, other code",
        ),
        (joint(3, lower=-3.07180000001), "repeat"),  # equal but for the last digits
    ],
)
def test_the_axis_names_what_differs(compared, spoiler, axis):
    comparison = compared(spoiler)
    assert re.fullmatch(axis, comparison.axis)
    assert (
        {section.state for section in comparison.sections}
        == {comparison.state}
        == {"equal"}
    )
    assert len(rows(comparison, "Values")) == 4 * 9
    assert len(rows(comparison, "Arrays")) == 4 * 11


@pytest.mark.parametrize(
    ("spoiler", "note"),
    [
        (same, "Both have the same run id. One is a copy of the other, or was edited."),
        (
            facts(environment={"QD_DEBUG": "1", "GS_ENABLE_ZEROCOPY": "0"}),
            "The switches of the engine differ: none; QD_DEBUG=1, GS_ENABLE_ZEROCOPY=0.",
        ),
        (modules(metrics="0" * 64), "The code differs and may be the cause: metrics."),
        (facts(warnings=["New one."]), "Engine warning gained: New one."),
        (
            facts(warnings=["New one."]),
            "Engine warning lost: Approximating tendon.",
        ),
        (part("backend", device_name="another CPU"), "The devices differ."),
        (facts(git=None), "The new bundle was not recorded from a clean checkout."),
    ],
)
def test_circumstances_are_noted_and_are_not_a_difference(compared, spoiler, note):
    comparison = compared(spoiler)
    assert note in comparison.notes
    assert comparison.state == "equal"


@pytest.mark.parametrize(
    ("spoiler", "obstacle"),
    [
        (part("parameters", stepped_joint="joint2"), "parameters.stepped_joint"),
        (facts(seed=1), "The seed differs: 0 and 1"),
        (part("engine", precision="64"), "The precision differs: 32 and 64"),
        (
            part("backend", actual_at_end="cuda"),
            "changed during the run, from cpu to cuda",
        ),
        (
            both(ACCELERATED, UPGRADED),
            "9.9.9 (quadrants " + QUADRANTS + ") and backend cpu → cuda",
        ),
    ],
)
def test_another_question_or_a_second_axis_is_not_comparable(
    compared, spoiler, obstacle
):
    comparison = compared(spoiler)
    assert (comparison.state, comparison.sections) == ("not comparable", ())
    assert obstacle in " ".join(comparison.obstacles)
    assert obstacle in report.summary(comparison)


def limit(speed):
    atol, rtol = l04.TOLERANCES["rad/s"]
    return atol + rtol * speed


@pytest.mark.parametrize(
    ("case", "metric", "new", "state"),
    [
        (
            "G1",
            "initial_error",
            lambda v: v + 5e-6,
            "differs",
        ),  # by the metric's own tolerance
        ("G1", "peak_speed", lambda v: v - 0.99 * limit(v), "within tolerance"),
        ("G1", "peak_speed", lambda v: v - 1.01 * limit(v), "differs"),
        ("G1", "settling_time", None, "differs"),
        ("baseline", "saturation_samples", lambda v: v + 1, "differs"),
    ],
)
@pytest.mark.parametrize("swap", [False, True])
def test_values_agree_within_their_tolerance(compared, case, metric, new, state, swap):
    comparison = compared(value(case, metric, new), swap=swap)
    assert comparison.state == state
    row = rows(comparison, "Exact counts" if metric.endswith("samples") else "Values")[
        0
    ]
    assert (row.what, row.state) == (f"{case}.{metric}", state)
    assert ("not observed" in (row.old, row.new)) == (new is None)
    assert (row.weight < 1) == (state == "within tolerance" or new is None)


@pytest.mark.parametrize(
    ("metric", "old", "new", "state", "verdict"),
    [
        ("peak_speed", (1.0, 2.0), (1.0, 2.0), "equal", "held in both"),
        ("peak_speed", (2.0, 1.0), (1.0, 2.0), "differs", "flipped"),
        ("peak_speed", (2.0, 1.0), (2.0, 1.0), "differs", "broken in both"),
        ("peak_speed", (1.0, 2.0), (1.0, 1.04), "inconclusive", "inconclusive"),
        ("peak_speed", (1.0, 0.96), (1.0, 1.04), "inconclusive", "inconclusive"),
        (
            "peak_speed",
            (2.0, 1.0),
            (1.0, 1.04),
            "differs",
            "broken in one, undecided in the other",
        ),
        ("peak_speed", (1.0, 2.0), (None, 1.0), "differs", "flipped"),
        ("peak_speed", (1.0, 2.0), (1.0, None), "equal", "held in both"),
        ("peak_speed", (1.0, 2.0), (None, None), "inconclusive", "inconclusive"),
        # "no later" allows the same sample.
        ("rise_time", (0.11, 0.11), (0.11, 0.10), "equal", "held in both"),
        ("rise_time", (0.11, 0.11), (0.11, 0.12), "inconclusive", "inconclusive"),
    ],
)
def test_claimed_orderings(compared, metric, old, new, state, verdict):
    first, second = (
        both(value("G1", metric, a), value("G2", metric, b)) for a, b in (old, new)
    )
    found = rows(compared(second, first=first), "Relations")
    [row] = [row for row in found if row.what.startswith(f"{metric}: G2 ")]
    assert (row.state, row.what.partition(", ")[2]) == (state, verdict)


without_g3 = both(drop_case, pop(METRICS, "G3"))
LACKING = ("present", "missing")


@pytest.mark.parametrize(
    ("first", "second", "title", "found"),
    [
        (
            same,
            without_g3,
            "Coverage",
            {"case G3": LACKING, "metric G3.overshoot": ("rad, value", "missing")},
        ),
        (without_g3, without_g3, "Coverage", {"case G3": ("missing", "missing")}),
        (
            same,
            pop("manifest.json", "checks", -1),
            "Coverage",
            {"check functions": LACKING},
        ),
        (
            same,
            put(METRICS, "G1", "overshoot", unit="degree"),
            "Coverage",
            {"metric G1.overshoot": ("rad, value", "degree, value")},
        ),
        (
            same,
            joint(3, dof_idx_local=4, lower=None),
            "Coverage",
            {
                "joint joint4": (
                    "REVOLUTE, DOF 3, qpos 3, -3.0718 rad to -0.0698 rad",
                    "REVOLUTE, DOF 4, qpos 3, no limit to -0.0698 rad",
                )
            },
        ),
        (
            check(3, passed=False),
            check(3, passed=False),
            "Invariants",
            {"baseline_approaches": ("FAILED", "FAILED")},
        ),
        (
            same,
            part("engine", files_match_wheel=False),
            "Invariants",
            {"engine files match the wheel": ("passed", "FAILED")},
        ),
    ],
)
def test_what_one_or_both_sides_lack_differs(compared, first, second, title, found):
    comparison = compared(second, first=first)
    assert comparison.state == "differs"
    differing = {
        f.what: (f.old, f.new) for f in rows(comparison, title) if f.state == "differs"
    }
    assert found.items() <= differing.items()


def added(place, amount):
    """Return a function that adds an amount to one value of an array."""
    return lambda array: changed_at(place, array[place] + np.float32(amount))(array)


@pytest.mark.parametrize(
    ("fields", "state", "what", "delta", "allowed"),
    [
        (
            {"qd": added((7, 3), 0.5)},
            "differs",
            "qd_rad_s_or_m_s[7, 3]",
            "0.5 rad/s",
            "rad/s",
        ),
        (
            {"qd": added((7, 8), 0.5)},
            "differs",
            "qd_rad_s_or_m_s[7, 8]",
            "0.5 m/s",
            "m/s",
        ),
        (
            {"qd": added((7, 3), 5e-4)},
            "within tolerance",
            "qd_rad_s_or_m_s[7, 3]",
            "rad/s",
            " ",
        ),
        (
            {"link_quat": np.zeros_like},
            "differs",
            "link_quat_wxyz[0, 0, 0]",
            "-1",
            "0.0001",
        ),
    ],
)
@pytest.mark.parametrize("swap", [False, True])
def test_arrays_agree_within_their_tolerance(
    compared, fields, state, what, delta, allowed, swap
):
    comparison = compared(rewrite(**fields), swap=swap)
    row = rows(comparison, "Arrays")[0]
    assert (comparison.state, row.state, row.what) == (state, state, f"G1 {what}")
    assert delta.removeprefix("-") in row.delta
    assert allowed in row.allowed
    assert (row.what in report.summary(comparison)) == (state == "differs")


def test_arrays_without_a_tolerance_are_equal(compared, monkeypatch):
    monkeypatch.setattr(l04, "TOLERANCES", {"rad/s": (1.0, 0.0)})
    comparison = compared(rewrite(q=added((7, 3), 1e-6), qd=added((7, 3), 0.5)))
    first, second, *others = rows(comparison, "Arrays")
    assert (first.state, first.allowed) == ("differs", "0 rad")
    assert (second.state, second.allowed) == ("within tolerance", "1 rad/s")
    assert {row.state for row in others} == {"equal"}


def test_a_case_may_have_no_bound_and_its_largest_difference_is_named(
    compared, monkeypatch
):
    monkeypatch.setattr(l04, "TOLERANCES", l04.TOLERANCES | {"G1": (np.inf, 0.0)})
    faster = value("G1", "peak_speed", lambda v: v + 2 * limit(v))
    comparison = compared(rewrite(q=added((7, 3), 1)), faster)
    assert comparison.state == "within tolerance"
    assert rows(comparison, "Values")[0].what == "G1.peak_speed"
    assert rows(comparison, "Arrays")[0].what == "G1 q_rad_or_m[7, 3]"


@pytest.mark.parametrize(
    ("spoiler", "said"),
    [
        (write(METRICS, "{}"), "digest: {}: metrics.json: sha256 is"),
        (
            both(facts(lesson="l02"), seal),
            "is of l04/lab, {} of l02/lab. Give two bundles",
        ),
        (
            both(facts(lesson="l99"), seal),
            "lesson: Lesson 'l99' does not exist. Choices: l01",
        ),
    ],
)
def test_bundles_are_bounded_as_for_the_verifier_and_of_one_page(
    folder, other, spoiler, said
):
    spoiler(other)
    with pytest.raises(BundleRefused, match=said.format(other)):
        compare(folder, other)


@pytest.fixture
def command(monkeypatch, capsys):
    """Run the command; return its exit status and what it printed, to both streams."""

    def run(*arguments):
        monkeypatch.setattr(
            sys, "argv", ["compare.py", "--report", *map(str, arguments)]
        )
        with pytest.raises(SystemExit) as ended:
            runpy.run_path(
                str(ROOT / "build_scripts" / "compare.py"), run_name="__main__"
            )
        return ended.value.code, "".join(capsys.readouterr())

    return run


ODD = "\x1b[2J\nEqual. Rows: \u202e"


@pytest.mark.parametrize(
    "spoiler",
    [
        manifest(lambda m: m.update({ODD: 1})),
        part("parameters", **{ODD: {ODD: 1}}),
        facts(warnings=["New one.\nEqual. Rows: 9"]),
    ],
)
def test_nothing_of_a_bundle_controls_the_terminal(
    folder, other, command, spoiler, tmp_path
):
    both(spoiler, seal)(other)
    _, printed = command(tmp_path / "report", folder, other)
    assert all(c.isprintable() for c in printed.replace("\n", ""))
    assert "\nEqual. Rows: 9" not in printed
    written = [path.read_text() for path in (tmp_path / "report").glob("*")]
    assert not {*ODD[:1], ODD[-1]} & {*"".join(written)}


def test_performance_is_shown_and_decides_nothing(compared):
    of = {"unit": "steps/s", "class": "performance", "from": ["clock"]}
    slow, fast = (
        put(METRICS, "G1", speed=of | {"value": steps}) for steps in (10.0, 100.0)
    )
    comparison = compared(slow, first=fast)
    (row,) = rows(comparison, "Performance")
    assert (row.old, row.new, row.state) == ("100 steps/s", "10 steps/s", "shown")
    assert comparison.state == "equal"


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
        [(SEVERITY.index(row.state), row.weight) for row in of.rows]
        for of in unlike.sections
    ]
    assert all(of == sorted(of, reverse=True) for of in [order, *ranks])
    text = report.summary(unlike)
    assert text.splitlines()[1].startswith("Differs. Rows: ")
    assert "G2.final_error: " in text
    assert "overshoot: G2 higher than G1, inconclusive" in text
    page = report.document(unlike).markdown()
    assert "- Engine warning gained: \\<b\\>1 \\| 2\\</b\\> \\# see https" in page
    table = [line for line in page.splitlines() if line.startswith("|")]
    assert {len(re.findall(r"(?<!\\)\|", line)) for line in table} <= {4, 5, 6, 7}


def faster(by):
    return value("G3", "peak_speed", lambda speed: speed + by)


alike = both(value("G1", "peak_speed", 3.0), value("G2", "peak_speed", 3.0))


@pytest.mark.parametrize(
    ("old", "new", "status", "said"),
    [
        (same, same, 0, "Equal. Rows: "),
        (same, faster(0.0001), 0, "Within tolerance. Rows: "),
        (same, faster(0.1), 1, "Differs. Rows: "),
        (alike, alike, 1, "Inconclusive. Rows: "),
        (same, facts(seed=1), 2, "Not comparable."),
    ],
)
def test_the_exit_status_and_the_report(
    folder, other, command, tmp_path, old, new, status, said
):
    both(old, seal)(folder)
    both(new, seal)(other)
    code, printed = command(tmp_path / "a report", folder, other)
    assert (code, printed.splitlines()[1][: len(said)]) == (status, said)
    assert sorted(p.name for p in (tmp_path / "a report").iterdir()) == ["report.md"]
    assert f"Report: {tmp_path / 'a report' / 'report.md'}" in printed


def test_what_cannot_be_compared_or_written_exits_2(
    folder, other, command, no_file, tmp_path
):
    (other / "metrics.json").write_text("{}")
    report = tmp_path / "report"
    for arguments, said in (
        ((report, folder, other), f"Refused: digest: {other}: metrics.json"),
        ((report, "", folder), "OLD='' is not a folder. Usage: make compare"),
        (
            (no_file.parent, folder, folder),
            f"REPORT={no_file.parent} cannot be written: ",
        ),
    ):
        code, printed = command(*arguments)
        assert (code, printed[: len(said)]) == (2, said)
    assert not report.exists()
