"""Mistakes with bodies: measured symptoms, shown without the name of the mistake."""

from types import SimpleNamespace

import numpy as np
import pytest

from robo_genesis.lessons.l02 import mistakes, spec

CASE = spec.BASELINE
FALL = CASE.height - 4.905 * (np.arange(61) * CASE.dt) ** 2
LANDS = np.maximum(FALL, CASE.size / 2)


def body(dofs=6, geoms=1):
    return SimpleNamespace(n_dofs=dofs, geoms=[None] * geoms, vgeoms=[None])


@pytest.fixture
def falls(monkeypatch):
    """Return a function that gives bodies their heights without an engine."""

    def give(**heights):
        monkeypatch.setattr(mistakes, "heights", lambda scene, bodies, steps: heights)

    return give


def hovers(falls, moves):
    short = FALL[:21]
    falls(fixed=short if moves else np.full(21, CASE.height), free=short)
    return mistakes.fixed_body(None, body(dofs=0), body(), CASE)


def falls_through(falls, lands):
    falls(ghost=LANDS if lands else FALL, solid=LANDS)
    return mistakes.no_collision(None, body(geoms=0), body(), CASE)


@pytest.mark.parametrize("made", [hovers, falls_through])
def test_a_symptom_is_shown_only_where_it_appeared(falls, made):
    assert made(falls, False).shown
    assert not made(falls, True).shown


@pytest.mark.parametrize("made", [hovers, falls_through])
def test_evidence_and_labels_do_not_name_the_mistake(falls, made):
    failure = made(falls, False)
    text = " ".join([failure.evidence, *failure.curves])
    assert not {"fixed", "collision", "ghost"} & {*text.split()}
    assert "this box" in failure.curves


def test_the_numbers_of_a_fall_through_the_ground_are_measured(falls):
    evidence = falls_through(falls, False).evidence
    assert f"{FALL[-1]:.3f} m" in evidence
    assert "0.050 m" in evidence
