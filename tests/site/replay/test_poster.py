"""The picture of a replay shows its model from the camera of the replay."""

from io import BytesIO

import numpy as np
import pytest
from falling import falling
from PIL import Image
from without_sphinx import box

from robo_genesis.site.replay import model, poster
from robo_genesis.site.replay.scenery import FIELD, Camera, Scenery

CAMERA = Camera(np.array([0.0, 0.5, 0.0]), 3.0)


def drawn(**around) -> np.ndarray:
    """Return the picture of a red link half a metre above the origin, as (h, w, 4)."""
    scenery = Scenery([box("box", rgb=(255, 0, 0))], CAMERA, ground=-9.0, **around)
    glb = model.glb(scenery, ("stand", "box"), {"run": falling(0.5)})
    with Image.open(BytesIO(poster.picture(glb, CAMERA))) as image:
        assert (image.format, image.size) == ("WEBP", poster.SIZE)
        return np.asarray(image.convert("RGBA")).astype(int)


def test_a_link_is_drawn_where_the_camera_sees_it():
    image = drawn()
    red, green, blue, opacity = image[poster.HEIGHT // 2, poster.WIDTH // 2]
    assert (red > 100 > max(green, blue), opacity) == (True, 255)
    rows, columns = np.nonzero(image[..., 3])
    centre = rows.min() + rows.max(), columns.min() + columns.max()
    assert centre == pytest.approx((poster.HEIGHT, poster.WIDTH), abs=12)
    height = poster.HEIGHT / (2 * 3.0 * np.tan(FIELD / 2))  # pixels of a metre
    assert np.ptp(rows) == pytest.approx(0.25 * height, rel=0.1)


def test_the_copy_at_the_target_is_translucent():
    above = np.eye(4)
    above[2, 3] = 0.9
    image = drawn(target={"box": above})
    copy = image[(image[..., 3] > 0) & (image[..., 3] < 255)]
    red, _, blue, opacity = np.median(copy, axis=0)
    assert blue > 2 * red
    assert opacity / 255 == pytest.approx(model.GHOST[3], abs=0.01)
