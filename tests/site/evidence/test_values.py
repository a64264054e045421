"""Numbers that pages insert come from the bundle, and an unknown one stops the build."""

import re
from types import SimpleNamespace

import pytest

from robo_genesis.core import project
from robo_genesis.site.evidence import values
from robo_genesis.site.evidence.values import measured, require_passed

ORIGIN = f"Measured by l04/lab on cpu, Genesis {project.engine_pin()}, run "


@pytest.mark.parametrize(
    ("name", "text", "source"),
    [
        ("G2.overshoot", "{:.4f} rad", "from q_rad_or_m, target_rad_or_m"),
        ("model.links", "11", "from "),
        ("model.links episodes", "11 episodes", "from "),
        ("engine", project.engine_pin(), ""),
        (
            "baseline_approaches:baseline.final_error_rad rad",
            r"\S+ rad",
            "found by the check baseline_approaches",
        ),
    ],
)
def test_a_value_comes_with_unit_and_origin(outputs, experiment, name, text, source):
    found, origin = measured("l04/lab", name)
    assert re.fullmatch(text.format(experiment.metrics["G2"].overshoot), found)
    assert origin.startswith(ORIGIN)
    assert source in origin


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("G2.overshot", r"no metric 'G2.overshot'. Known: .*G2\.overshoot"),
        ("overshoot", "no metric 'overshoot'. Known: "),
        (
            "G2.overshoot episodes",
            "is in rad, so it does not count episodes. Valid: rad",
        ),
        (
            "baseline_approaches:x",
            "no finding 'baseline_approaches:x'. Known: .*baseline_approaches:baseline",
        ),
    ],
)
def test_an_unknown_value_names_those_there_are(outputs, name, said):
    with pytest.raises(LookupError, match=said):
        measured("l04/lab", name)


def test_only_a_check_that_passed_guards_a_sentence(outputs, monkeypatch):
    require_passed("l04/lab", "baseline_approaches")
    with pytest.raises(
        LookupError,
        match=r"no check 'baseline_approached'\. Choices: .*baseline_approaches",
    ):
        require_passed("l04/lab", "baseline_approached")
    failed = SimpleNamespace(name="sag", passed=False, found={"sag_m": 0.1})
    manifest = SimpleNamespace(checks=[failed])
    monkeypatch.setattr(values, "read_manifest", lambda folder: manifest)
    with pytest.raises(ValueError, match=r"the check sag of l04/lab found .*0\.1"):
        require_passed("l04/lab", "sag")


@pytest.mark.parametrize(
    ("page", "choices"),
    [("L04/lab", "l01, l02"), ("l04", "l04/lab, l04/lecture")],
)
def test_a_lesson_or_page_that_does_not_exist_lists_the_choices(outputs, page, choices):
    for look in (measured, require_passed):
        with pytest.raises(LookupError, match=f"Choices: {choices}"):
            look(page, "engine")
