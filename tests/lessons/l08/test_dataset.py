"""The rows of the dataset are those of the recorded episodes."""

from dataclasses import replace

import numpy as np
from lessons.changed_runs import put, trace

from robo_genesis.lessons.l08 import checks, dataset, spec
from robo_genesis.sim.camera import film
from robo_genesis.sim.camera.geometry import intrinsics, looking, project


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


def painted(places):
    """Return a picture (n, *PICTURE) of each place, with a blue square where it is seen."""
    pictures = np.zeros((len(places), *film.PICTURE), np.uint8)
    camera = intrinsics(42, film.RES), looking(spec.VIEW["pos"], spec.VIEW["lookat"])
    for picture, pixel in zip(pictures, project(places, *camera), strict=True):
        column, row = pixel.round().astype(int)
        picture[row - 4 : row + 4, column - 4 : column + 4, 2] = 200
    return pictures


def test_a_film_shows_its_own_episode_at_its_own_time(lab):
    places = lab.traces["exact"].object_pos[:, :3]
    films = {name: painted(places[:, row]) for row, name in enumerate(spec.FILMS)}

    def wrong(**others):
        frames = {}
        for name, pictures in (films | others).items():
            frames |= film.sheets(name, pictures)
        found = checks.pictures_show_the_states(
            replace(lab, rendered=True, frames=frames)
        )
        return [one.label for one in found if not one.passed]

    assert wrong() == []
    assert wrong(film_1=films["film_2"]) == ["film_1.apart_px"]
    late = np.concatenate([films["film_0"][:1], films["film_0"][:-1]])
    assert wrong(film_0=late) == ["film_0.apart_px"]
    assert wrong(film_2=0 * films["film_2"]) == ["film_2.apart_px"]
