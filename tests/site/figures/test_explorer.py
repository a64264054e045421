"""The explorer in a browser, from disk: cells with curves or postures, and pixels of a picture."""

from types import SimpleNamespace

import numpy as np
import pygltflib
import pytest
from closed_views import plane_depth, sphere_depth
from docutils import nodes
from falling import LINKS, falling
from watching import call, violations
from without_sphinx import Panel, box, rows_of

from robo_genesis.core.channels import Replay
from robo_genesis.core.scene import CAMERA_RES
from robo_genesis.evidence.reader import write_frame
from robo_genesis.sim import visual_shape
from robo_genesis.sim.camera import record as view_record
from robo_genesis.sim.camera.geometry import intrinsics, rays
from robo_genesis.sim.camera.views import View
from robo_genesis.site.figures import explorer
from robo_genesis.site.figures.explorer import CROSS

KEY, NAME = "l99/answers/cpu", "postures-l99-answers-cpu-reach"
TARGETS = np.array([[0.1 * k, 0.0, 0.5] for k in range(40)])
K = intrinsics(42.0, CAMERA_RES)
TRANSFORM = np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 2], [0, 0, 0, 1]])
BALL = (0.2, 0.1, 0.3, 0.1)
"""Centre and radius of a sphere below a camera that looks straight down from z = 2 [m]."""

PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True}


def block_of(tmp_path, folder, data, name, **experiment) -> nodes.Node:
    directive, run = Panel(tmp_path / "book"), SimpleNamespace(**experiment)
    file = f"l99-answers-cpu-{name}"
    return explorer.explorer_block(directive, KEY, file, folder, run, data)


def texts(page, selector: str) -> list[str]:
    return page.locator(f".explorer {selector}").all_inner_texts()


def cell(k: int, place: str) -> dict:
    state = "refused" if k == 1 else "accepted"
    return {
        "answer": k,
        "name": f"{place}, {state}",
        "state": state,
        "tag": "×" * (k == 1),
        "opens": k != 1,
        "sentence": f"Answer {k}, {state}.",
        "numbers": [10.0 * k, 1 / k],
        "values": [f"{10 * k}", f"{1 / k:.3f}"],
        "texts": [f"{10 * k}", f"{1 / k:.2f}"],
    }


def map_of(run: str, answers: list[list[int]]) -> dict:
    rows = [
        {
            "label": f"{z}",
            "cells": [cell(k, f"z {z}, x 0.{x + 1}") for x, k in enumerate(row)],
        }
        for z, row in enumerate(answers)
    ]
    return {
        "run": run,
        "label": f"Plane {run}",
        "caption": f"Plane {run}. x to the right.",
        "rows": rows,
        "columns": ["0.1", "0.2", "0.3"],
    }


def maps() -> dict:
    return {
        "columns": ["left [mm]", "margin [rad]"],
        "dt": 0.01,
        "maps": [map_of("upright", [[1, 2, 3], [4, 5]]), map_of("level", [[7, 8, 9]])],
        "measures": [{"label": "left [mm]"}, {"label": "margin [rad]"}],
        "notes": {"×": "×: refused."},
    }


@pytest.fixture
def postures(folder, tmp_path, monkeypatch) -> nodes.Node:
    visual_shape.write_shape(tmp_path, [box("box")])
    monkeypatch.setattr(
        explorer, "find_replay", lambda lesson: Replay((), "box", "box")
    )
    monkeypatch.setattr(
        explorer.replays, "shape_file", lambda *_: tmp_path / visual_shape.FILE
    )
    rows = {
        run: [{"answer": f"{k}", "left [mm]": f"{10 * k}"} for k in of]
        for run, of in (("upright", range(1, 6)), ("level", range(7, 10)))
    }
    data = maps() | {"postures": {"upright": TARGETS, "level": TARGETS}, "tables": rows}
    traces = {"upright": falling(2.0, 40), "level": falling(1.0, 40)}
    return block_of(tmp_path, folder, data, "reach", traces=traces, links=LINKS)


def test_every_answer_is_in_a_table_and_in_the_model_with_its_target(
    postures, tmp_path
):
    assert postures["evidence_runs"] == (KEY,)
    rows = rows_of([postures])
    assert (rows[2], len(rows)) == (["2", "20"], 2 + 5 + 3)
    file = tmp_path / "book" / "_build" / "html" / "replay" / f"{NAME}.glb"
    model = pygltflib.GLTF2.load_binary(file)
    assert [animation.name for animation in model.animations] == ["upright", "level"]
    assert {"box", CROSS} <= {node.name for node in model.nodes}
    assert (
        np.vstack([TARGETS[:1], TARGETS]).astype(np.float32).tobytes()
        in model.binary_blob()
    )


@pytest.mark.browser
def test_pointer_touch_and_keys_choose_a_cell_and_its_posture_is_shown(
    postures, open_block
):
    page = open_block(postures, **PHONE)
    assert texts(page, "output") == ["Answer 2, accepted."]  # the first that is
    page.locator("[aria-selected=true]").focus()
    for way in ("Down", "Right", "Up", "Left", "Left", "Down"):
        page.keyboard.press(f"Arrow{way}")  # right of 5 and left of 1 is no cell
    assert (texts(page, "output"), texts(page, "dd")) == (
        ["Answer 4, accepted."],
        ["40", "0.250"],
    )
    assert page.evaluate("document.activeElement.ariaSelected") == "true"
    assert page.locator(".map [tabindex='0']").count() == 1
    page.get_by_role("gridcell", name="× 10 left [mm]: z 0, x 0.1, refused").tap()
    assert texts(page, "output") == ["Answer 1, refused."]
    page.get_by_label("Cells show").select_option("margin [rad]")
    assert page.get_by_role("grid").get_attribute("aria-label") is None
    (caption,) = texts(page, "caption")
    assert (
        caption == "Plane upright. x to the right. Numbers: margin [rad]. ×: refused."
    )
    page.get_by_label("Map").select_option("Plane level")
    assert texts(page, "output") == ["Answer 7, accepted."]  # the same place
    assert page.locator("[role=gridcell]").count() == 3
    page.get_by_label("Map").select_option("Plane upright")
    page.get_by_role("button", name="Show in 3D").click()
    page.get_by_text("Turn the view").wait_for(timeout=120_000)
    page.get_by_role("gridcell", name="0.20 margin [rad]: z 1, x 0.2, accepted").tap()
    page.wait_for_function("document.querySelector('model-viewer').currentTime > 0.049")
    place = call(page, "poses")["box"]["position"]
    assert place == pytest.approx(falling(2.0).link_pos[5, 1], abs=1e-5)
    assert texts(page, ".shown") == ["Answer 5, accepted."]
    assert violations(page, ".explorer", preload=False) == []


@pytest.fixture
def curves(folder, tmp_path) -> nodes.Node:
    """Two runs at different heights."""
    cells = [
        {"name": f"run at {z} m", "sentence": "A run.", "opens": z == 0, "z": [z] * 60}
        | {"numbers": [z], "values": [f"{z}"], "texts": [f"{z} m"]}
        for z in (0, 1)
    ]
    axis = {"low": -1, "high": 2, "levels": [], "ticks": [{"value": 0, "label": "0"}]}
    grid = {"label": "Grid", "caption": "Two runs.", "columns": ["a", "b"]}
    grid |= {"setting": "still", "axes": {"z": axis}}
    drawn = {"key": "z", "name": "Height", "title": "Height [m]", "first": 0}
    drawn |= {"unit": 1, "zero": 0}
    data = {
        "columns": ["height [m]"],
        "maps": [grid | {"rows": [{"label": "z", "cells": cells}]}],
        "measures": [{"label": "height [m]"}],
        "notes": {},
        "curves": {"of": "box", "dt": 0.01, "until": 0.6, "drawn": [drawn]},
    }
    return block_of(tmp_path, folder, data, "grid")


BESIDE = """svg => {
  const of = kind => svg.querySelector(kind).getBoundingClientRect();
  const name = of(".name");
  const apart = ({ top, bottom }) => Math.abs(top + bottom - name.top - name.bottom) / 2;
  const over = [...svg.querySelectorAll("text:not(.name)")].filter(text => {
    const { left, right, top, bottom } = text.getBoundingClientRect();
    return left < name.right && name.left < right && top < name.bottom && name.top < bottom;
  });
  return [apart(of(".curve.ghost")), apart(of(".curve.chosen")), over.length];
}"""
"""From the name to the last and to the chosen run [px], and how many texts it covers."""


@pytest.mark.browser
def test_the_curve_of_the_last_run_has_its_name_beside_it(curves, open_block):
    page = open_block(curves, **PHONE)
    name = page.locator(".time-plot .name")
    assert name.count() == 0  # there is one run
    page.get_by_role("gridcell", name="1 m height").tap()
    assert name.text_content() == "last run"
    last, chosen, covered = page.locator(".time-plot").evaluate(BESIDE)
    assert last < 15 < chosen
    assert covered == 0


@pytest.fixture
def picture(tmp_path, folder) -> nodes.Node:
    """A picture whose floor has a hole and whose sphere is 1 mm too deep."""
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
    (tmp_path / "frames").mkdir()
    for name, frame in view_record.frames("world", view).items():
        write_frame(tmp_path / "frames" / f"{name}.png", frame)
    data = {
        "size": CAMERA_RES,
        "K": K.tolist(),
        "unit": view_record.DEPTH_UNIT,
        "pose": (TRANSFORM @ np.diag([1.0, -1, -1, 1]))[:3].tolist(),
        "names": {0: "nothing", 1: "plane", 2: "ball", 3: "hand"},
        "planes": {1: 0.0},
        "spheres": {2: BALL},
        "columns": ["read"] * 6,
        "picture": {"name": "world", "alt": "A ball.", "caption": "A picture."},
    }
    return block_of(tmp_path, tmp_path, data, "world")


@pytest.mark.browser
def test_a_pixel_has_its_recorded_depth_point_and_closed_form(picture, open_block):
    page = open_block(picture, **PHONE)
    width, height = CAMERA_RES

    def choose(column: int, row: int) -> list[str]:
        for name, value in (("Column", column), ("Row", row)):
            page.get_by_label(name).fill(str(value))
        return texts(page, "dd")

    u, v = (int(value) for value in (K @ [0.2 / 1.7, -0.1 / 1.7, 1])[:2])
    pixel, name, depth, point, expected, apart = choose(u, v)
    assert (pixel, name, apart) == (f"column {u}, row {v}", "ball", "1.00 mm")
    start, directions = rays(K, TRANSFORM, CAMERA_RES)
    closed = sphere_depth(start, directions, np.array(BALL[:3]), BALL[3])[v, u]
    assert float(expected.split()[0]) == pytest.approx(closed, abs=6e-5)
    assert float(depth.split()[0]) == pytest.approx(closed + 1e-3, abs=7e-5)
    found = [
        float(part) for part in point.replace("−", "-").removesuffix(" m").split(", ")
    ]
    assert found == pytest.approx(start + (closed + 1e-3) * directions[v, u], abs=6e-5)
    for at, says in (
        ((100, 400), ["plane", "2.0000 m", "2.0000 m", "0.00 mm"]),
        ((5, height - 5), ["plane", "2.0000 m", "2.0000 m", "0.04 mm"]),
        ((5, 5), ["nothing", "20.000 m: no surface", "–", "–"]),
        ((width - 5, height - 5), ["hand", "2.0000 m", "none for this shape", "–"]),
    ):
        read = choose(*at)
        assert [read[k] for k in (1, 2, 4, 5)] == says
        assert "−0.0000" not in read[3]
    stage = page.locator(".stage").bounding_box()
    page.mouse.click(stage["x"] + stage["width"] / 4, stage["y"] + stage["height"] / 2)
    column, row = (int(part.split()[-1]) for part in texts(page, "dd")[0].split(","))
    assert (column, row) == (
        pytest.approx(width / 4, abs=3),
        pytest.approx(height / 2, abs=3),
    )
    page.get_by_label("Column").press("ArrowRight")
    spoken = page.get_by_label("Column").get_attribute("aria-valuetext")
    assert spoken == f"column {column + 1}, row {row}: plane, depth 2.0000 m"
    assert violations(page, ".explorer", preload=False) == []
