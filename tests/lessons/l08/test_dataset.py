"""The rows of the dataset are those of the recorded episodes."""

from dataclasses import replace

import numpy as np
from lessons.changed_runs import put, trace

from robo_genesis.lessons.l08 import checks, dataset, spec
from robo_genesis.sim.camera import film


def test_a_row_has_a_sample_and_the_command_after_it(lab):
    found, run = dataset.columns(lab), lab.traces["exact"]
    k, row = 37, 5
    expected = {
        "observation.state": run.q[k, row],
        "observation.environment_state": [*run.object_pos[k, row], 1, 0, 0, 0],
        "finger_force": run.force[k, row],
        "action": run.target[k, row],
        "phase": run.phase[k + 1, row],
    }
    for name, right in expected.items():
        values, _ = found[name]
        assert values.shape[:2] == (64, 130)
        assert np.array_equal(values[row, k], right), name


def test_success_and_end_are_in_the_last_row_alone(lab):
    found = dataset.columns(trace("exact", touches=put((-1, 0), 1))(lab))
    done, success = (found[f"next.{name}"][0] for name in ("done", "success"))
    assert success[:, -1].tolist() == [False, *[True] * 63]
    assert (done.sum(axis=1) == 1).all()
    assert done[:, -1].all()
    assert success.sum() == 63


def test_pictures_are_of_the_first_episodes_and_absent_without_a_camera(lab):
    assert dataset.recorded(lab)["pictures"] is None
    levels = np.arange(len(spec.FILMS))[:, None] * 50 + np.arange(131)
    pictures = [
        np.full((131, *film.PICTURE), of[:, None, None, None], np.uint8)
        for of in levels
    ]
    frames = {}
    for name, of in zip(spec.FILMS, pictures, strict=True):
        frames |= film.sheets(name, of)
    run = replace(lab, rendered=True, frames=frames)
    shown = dataset.recorded(run)["pictures"]
    assert shown.shape == (3, 130, *film.PICTURE)
    assert shown[2, 7, 0, 0].tolist() == [107] * 3
    outcomes = checks.pictures_show_the_states(run)
    assert [one.passed for one in outcomes] == [True, False, True]  # it has no end


def test_a_film_ends_with_the_picture_that_was_taken_at_the_end(lab):
    pictures = (
        np.zeros((132, *film.PICTURE), np.uint8) + np.arange(132)[:, None, None, None]
    )
    for end, passed in ((130, True), (131, False)):
        pictures[-1] = end
        frames = film.sheets("film_0", pictures.astype(np.uint8))
        run = replace(lab, rendered=True, frames=frames)
        outcomes = checks.pictures_show_the_states(run)
        assert [one.passed for one in outcomes] == [True, passed, True]
