"""The picture of a replay shows its model from the camera of the replay."""

from io import BytesIO

import numpy as np
import pytest
from falling import falling
from PIL import Image
from without_sphinx import box

from robo_genesis.site.replay import model, poster
from robo_genesis.site.replay.scenery import Camera, Scenery

RED, BLUE, GREY = (255, 0, 0), (0, 0, 255), (200, 200, 200)
GROUND = np.array([170, 180, 192])  # what is behind the picture
WIDTH, HEIGHT = poster.WIDTH // poster.FINER, poster.HEIGHT // poster.FINER
CAMERA = Camera(np.array([0.0, 0.5, 0.0]), 3.0)


def drawn(*parts, target=None, camera=CAMERA):
    """Return the picture of two links, at the origin and half a metre above, as (h, w, 3)."""
    scenery = Scenery(
        parts, camera, target=target or {}, ground=-9.0
    )  # no shadow is in sight
    glb = model.glb(scenery, ("stand", "box"), {"run": falling(0.5)})
    with Image.open(BytesIO(poster.picture(glb, camera))) as image:
        assert (image.format, image.mode) == ("WEBP", "RGBA")
        behind = Image.new("RGBA", image.size, (*GROUND.tolist(), 255))
        return np.asarray(Image.alpha_composite(behind, image).convert("RGB")).astype(
            int
        )


def middle(image):
    return image[image.shape[0] // 2, image.shape[1] // 2]


def test_a_link_is_drawn_where_the_camera_sees_it():
    image = drawn(box("box", rgb=RED))
    assert image.shape == (HEIGHT, WIDTH, 3)
    red, green, blue = middle(image)
    assert red > 100 > max(green, blue)
    assert image[0, 0].tolist() == pytest.approx(GROUND, abs=2)
    rows, columns = np.nonzero(np.abs(image - GROUND).max(axis=2) > 40)
    centre = rows.min() + rows.max(), columns.min() + columns.max()
    assert centre == pytest.approx((HEIGHT, WIDTH), abs=12)
    height = HEIGHT / (2 * 3.0 * np.tan(np.radians(15)))  # pixels of a metre
    assert np.ptp(rows) == pytest.approx(0.25 * height, rel=0.1)


@pytest.mark.parametrize("order", [1, -1])
def test_the_nearer_part_hides_the_other_one(order):
    nearer = box("box", rgb=BLUE, at=0.5 * CAMERA.axes[2][[0, 2, 1]] * [1, -1, 1])
    red, _, blue = middle(drawn(*[box("box", rgb=RED), nearer][::order]))
    assert blue > red


def test_the_copy_at_the_target_is_translucent():
    alone = drawn(box("box", rgb=GREY))
    beside = np.eye(4)
    beside[:3, 3] = [0, 0, 0.9]
    above = drawn(box("box", rgb=GREY), target={"box": beside})
    assert middle(above).tolist() == pytest.approx(middle(alone).tolist(), abs=6)
    rows = np.nonzero(np.abs(above - alone).max(axis=2) > 40)[0]
    shade = above[(rows.min() + rows.max()) // 2, WIDTH // 2]
    colour, opacity = 0.92 * np.array(model.GHOST[:3]), model.GHOST[3]
    assert shade.tolist() == pytest.approx(
        opacity * colour + (1 - opacity) * GROUND, abs=10
    )
