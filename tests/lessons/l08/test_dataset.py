"""The rows of the dataset are those of the recorded episodes."""

from dataclasses import replace

import numpy as np
import pytest
from lessons.changed_runs import put, trace

from robo_genesis.lessons.l08 import checks, dataset, spec
from robo_genesis.sim.camera import film


def test_a_row_has_a_sample_and_the_command_after_it(lab):
    found = {name: values for name, (values, _) in dataset.columns(lab).items()}
    run, k, row = lab.traces["exact"], 37, 5
    assert {values.shape[:2] for values in found.values()} == {(64, 130)}
    assert (found["observation.state"][row, k] == run.q[k, row]).all()
    assert (
        found["observation.environment_state"][row, k, :3] == run.object_pos[k, row]
    ).all()
    assert (
        found["observation.environment_state"][row, k, 3:] == run.object_quat[k, row]
    ).all()
    assert (found["finger_force"][row, k] == run.force[k, row]).all()
    assert (found["action"][row, k] == run.target[k, row]).all()
    assert found["phase"][row, k] == run.phase[k + 1, row]


def test_success_and_end_are_in_the_last_row_alone(lab):
    found = dataset.columns(trace("exact", touches=put((-1, 0), 1))(lab))
    done, success = (found[f"next.{name}"][0] for name in ("done", "success"))
    assert done[:, -1].all()
    assert success[:, -1].tolist() == [False, *[True] * 63]
    assert not done[:, :-1].any()
    assert not success[:, :-1].any()


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
    last = np.full((540, 720, 3), 130, np.uint8)
    outcomes = checks.pictures_show_the_states(
        replace(run, frames=frames | {"final": last})
    )
    assert all(one.passed for one in outcomes)
    outcomes = checks.pictures_show_the_states(
        replace(run, frames=frames | {"final": last + 9})
    )
    assert [one.passed for one in outcomes] == [True, False, True]


def test_fingers_that_never_close_are_refused(lab):
    target = np.ones_like(lab.traces["exact"].target)
    with pytest.raises(ValueError, match="never closed"):
        dataset.finger_motion(trace("exact", target=target)(lab))
