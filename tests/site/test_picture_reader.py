"""The picture reader shows the recorded depth and its closed form at each pixel, from disk."""

from collections.abc import Iterator

import numpy as np
import pytest
from browsers import SOFTWARE, launched
from closed_views import plane_depth, sphere_depth
from playwright.sync_api import Browser, Page
from watching import errors, violations
from without_sphinx import Panel, page_of

from robo_genesis.core.scene import CAMERA_RES
from robo_genesis.evidence.picture_file import write_picture
from robo_genesis.sim.camera import record as view_record
from robo_genesis.sim.camera.geometry import intrinsics, rays
from robo_genesis.sim.camera.views import View
from robo_genesis.site.picture_reader import reader_block

WIDTH, HEIGHT = CAMERA_RES
K = intrinsics(42.0, CAMERA_RES)
TRANSFORM = np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 2], [0, 0, 0, 1]])
BALL = (0.2, 0.1, 0.3, 0.1)
"""Centre and radius of a sphere below a camera that looks straight down from z = 2 [m]."""


@pytest.fixture(scope="module")
def page(tmp_path_factory) -> Iterator[Page]:
    """A page with one picture whose floor has a hole and whose sphere is 1 mm too deep."""
    folder = tmp_path_factory.mktemp("reader")
    start, directions = rays(K, TRANSFORM, CAMERA_RES)
    ball = sphere_depth(start, directions, np.array(BALL[:3]), BALL[3])
    hit = np.isfinite(ball)
    depth = np.where(hit, ball + 1e-3, plane_depth(start, directions))
    depth[:20, :20] = 20.0
    depth[-20:, :20] += 4e-5  # a height that rounds to zero from below
    numbers = np.where(hit, 2, 1) * (depth < 20)
    numbers[-20:, -20:] = 3
    rgb = np.repeat(80 * numbers[..., None], 3, axis=-1).astype(np.uint8)
    view = View(K, TRANSFORM, CAMERA_RES, (0.1, 20.0), rgb, depth, numbers)
    for name, frame in view_record.frames("world", view).items():
        write_picture(folder / f"{name}.png", frame, "run")
    about = {
        "size": CAMERA_RES, "K": K.tolist(), "unit": view_record.DEPTH_UNIT,
        "pose": (TRANSFORM @ np.diag([1.0, -1, -1, 1]))[:3].tolist(),
        "names": {0: "nothing", 1: "plane", 2: "ball", 3: "hand"},
        "planes": {1: 0.0}, "spheres": {2: BALL}, "alt": "A ball.", "caption": "A picture.",
    }  # fmt: skip
    block = reader_block(Panel(folder / "book"), "l99/cameras/cpu", "world", folder, about)
    with launched(*SOFTWARE) as browser:
        opened = open_page(browser, page_of(block, folder, ("picture-reader",), ("replay",)))
        problems = errors(opened)
        yield opened
        assert problems == []


def open_page(browser: Browser, file) -> Page:
    page = browser.new_page(viewport={"width": 390, "height": 844}, has_touch=True)
    page.goto(file.as_uri())
    page.locator(".picture-reader .panel").wait_for()
    return page


def shown(page) -> list[str]:
    return page.locator(".picture-reader dd").all_inner_texts()


def choose(page, column: int, row: int) -> list[str]:
    for name, value in (("Column", column), ("Row", row)):
        page.get_by_label(name).fill(str(value))
    return shown(page)


@pytest.mark.browser
def test_a_pixel_has_its_recorded_depth_point_and_closed_form(page):
    u, v = (int(value) for value in (K @ [0.2 / 1.7, -0.1 / 1.7, 1])[:2])
    pixel, name, depth, point, expected, apart = choose(page, u, v)
    assert (pixel, name, apart) == (f"column {u}, row {v}", "ball", "1.00 mm")
    start, directions = rays(K, TRANSFORM, CAMERA_RES)
    closed = sphere_depth(start, directions, np.array(BALL[:3]), BALL[3])[v, u]
    assert float(expected.split()[0]) == pytest.approx(closed, abs=6e-5)
    assert float(depth.split()[0]) == pytest.approx(closed + 1e-3, abs=7e-5)
    there = start + (closed + 1e-3) * directions[v, u]
    found = [float(part) for part in point.replace("−", "-").removesuffix(" m").split(", ")]
    assert found == pytest.approx(there, abs=6e-5)


@pytest.mark.browser
@pytest.mark.parametrize(
    ("at", "says"),
    [
        ((100, 400), ["plane", "2.0000 m", "2.0000 m", "0.00 mm"]),
        ((5, HEIGHT - 5), ["plane", "2.0000 m", "2.0000 m", "0.04 mm"]),
        ((5, 5), ["nothing", "20.000 m: no surface", "–", "–"]),
        ((WIDTH - 5, HEIGHT - 5), ["hand", "2.0000 m", "none for this shape", "–"]),
    ],
)
def test_each_kind_of_pixel_says_what_is_known(page, at, says):
    found = choose(page, *at)
    assert [found[k] for k in (1, 2, 4, 5)] == says
    assert "−0.0000" not in found[3]


@pytest.mark.browser
def test_pointer_and_keys_choose_a_pixel(page):
    box = page.locator(".stage").bounding_box()
    page.mouse.click(box["x"] + box["width"] / 4, box["y"] + box["height"] / 2)
    column, row = (int(part.split()[-1]) for part in shown(page)[0].split(","))
    assert (column, row) == (pytest.approx(WIDTH / 4, abs=3), pytest.approx(HEIGHT / 2, abs=3))
    page.get_by_label("Column").press("ArrowRight")
    assert shown(page)[0] == f"column {column + 1}, row {row}"
    spoken = page.get_by_label("Column").get_attribute("aria-valuetext")
    assert spoken == f"column {column + 1}, row {row}: plane, depth 2.0000 m"
    assert violations(page, ".picture-reader", preload=False) == []
