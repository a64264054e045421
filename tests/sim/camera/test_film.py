"""Small pictures in frames of the usual size."""

import numpy as np

from robo_genesis.core.scene import FRAME_SHAPE
from robo_genesis.sim.camera import film


def test_sheets_give_their_pictures_back():
    pictures = (
        np.random.default_rng(1).integers(0, 255, (27, *film.PICTURE)).astype(np.uint8)
    )
    frames = film.sheets("film", pictures)
    assert [*frames] == ["film_sheet_0", "film_sheet_1"]
    assert {frame.shape for frame in frames.values()} == {FRAME_SHAPE}
    assert (film.pictures_of(frames, "film", 27) == pictures).all()
    height, width = film.PICTURE[:2]
    assert (
        frames["film_sheet_0"][height : 2 * height, width : 2 * width] == pictures[6]
    ).all()
