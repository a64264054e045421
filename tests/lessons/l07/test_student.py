"""What the lab says about a scene is complete for each outcome."""

from types import SimpleNamespace

import pytest

from robo_genesis.lessons.l07 import rungs, spec, student

GOOD = {"margin": (0.1, 0.005, 1)}


def by_margin(results):
    return next(
        (rung for rung, of in results.items() if of["margin"] != GOOD["margin"]), None
    )


@pytest.mark.parametrize(
    ("failed", "mine", "ladder", "said"),
    [
        ([], {}, by_margin, ["ladder: none", "passes all five"]),
        (["seen"], {"seen": {"margin": 0}}, by_margin, ["ladder: seen", "fails seen."]),
        (
            ["seen", "built"],
            {},
            by_margin,
            ["built      passes   FAILS", "fails built and seen."],
        ),
    ],
)
def test_each_outcome_has_words(failed, mine, ladder, said):
    values = {rung: {"margin": 0.0 if rung in failed else 0.1} for rung in spec.RUNGS}
    results = dict.fromkeys(spec.RUNGS, GOOD) | mine
    found = student.compared(ladder, results, SimpleNamespace(values=values))
    assert all(words in found for words in said), found


def test_an_attempt_prints_each_verdict(capsys):
    assert student.attempt(lambda facts: {"drift": (2e-3, 0, 1e-3)}, None)
    assert "2.00 mm   FAILS" in capsys.readouterr().out


def test_a_ladder_that_empties_its_argument_changes_no_results():
    results = {rung: GOOD | {} for rung in spec.RUNGS}
    values = {rung: {"margin": 0.1} for rung in spec.RUNGS}

    def greedy(results):
        return [of.popitem() for of in results.values()] and None

    assert "yours" in student.compared(greedy, results, SimpleNamespace(values=values))
    assert results == dict.fromkeys(spec.RUNGS, GOOD)


def test_the_generated_text_names_a_failed_rung(scenes, monkeypatch):
    assert "passes all five rungs" in student.conclusions(scenes)
    monkeypatch.setattr(rungs, "failed", lambda run, scene: ["seen"])
    assert "The scene fails seen." in student.conclusions(scenes)


def test_a_rung_without_results_is_named():
    facts = SimpleNamespace(values=dict.fromkeys(spec.RUNGS))
    with pytest.raises(NotImplementedError, match=f"no results of {spec.RUNGS[-1]}"):
        student.compared(by_margin, dict.fromkeys(spec.RUNGS[:-1]), facts)
