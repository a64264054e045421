"""Maps of postures choose a recorded answer by pointer and keys, from disk."""

from collections.abc import Iterator
from types import SimpleNamespace

import numpy as np
import pygltflib
import pytest
import trimesh
from browsers import SOFTWARE, launched
from docutils import nodes
from playwright.sync_api import Browser, Page
from test_body_replay import HEIGHT, falling
from watching import errors, violations
from without_sphinx import Panel, page_of

from robo_genesis.core.channels import ReplayView
from robo_genesis.core.trace import Trace
from robo_genesis.sim import visual_shape
from robo_genesis.site import posture_map

KEY, NAME = "l99/answers/cpu", "postures-l99-answers-cpu-reach"
TARGETS = np.array([[0.1 * k, 0.0, 0.5] for k in range(40)])


def record(k: int) -> dict[str, str]:
    return {"answer": str(k), "accepted": "no" if k == 1 else "yes", "left [mm]": f"{10 * k}",
            "margin [rad]": f"{1 / k:.3f}"}  # fmt: skip


def answers(name: str, cells: list[list[int]]) -> dict:
    rows = [{"label": f"{k}", "cells": row} for k, row in enumerate(cells)]
    return {
        "run": name, "targets": TARGETS, "caption": f"Plane {name}. x to the right.",
        "axes": ("z", "x"), "rows": rows, "columns": ["0.1", "0.2", "0.3"],
        "measures": ("left [mm]", "margin [rad]"),
        "records": [record(k) for row in cells for k in row],
    }  # fmt: skip


def assigned(height: float) -> Trace:
    """Return the places of a falling box as assigned postures of a robot with one joint."""
    body = falling(height)
    q, one, step = np.zeros((41, 1)), np.zeros(1), np.zeros((40, 1))
    rest = dict.fromkeys(("qd", "target", "control_force", "internal_force"), step)
    start = dict.fromkeys(("start_control_force", "start_qd", "effort_limit"), one)
    return Trace(t=body.t, q=q, link_pos=body.link_pos, link_quat=body.link_quat, **rest, **start)


@pytest.fixture
def block(folder, tmp_path) -> nodes.Node:
    box = trimesh.creation.box((0.2, 0.2, 0.2))
    visual_shape.write_shape(
        tmp_path, [visual_shape.Part("box", (200, 80, 0), box.vertices, box.faces)]
    )
    traces = {"upright": assigned(2.0), "level": assigned(1.0)}
    maps = [answers("upright", [[1, 2, 3], [4, 5]]), answers("level", [[7, 8, 9]])]
    return posture_map.posture_block(
        Panel(tmp_path / "book"), KEY, "reach", folder,
        SimpleNamespace(traces=traces, links=["box"]), maps,
        tmp_path / visual_shape.FILE, ReplayView("box", "A box."),
    )  # fmt: skip


def test_every_answer_is_in_a_table_and_in_the_model_with_its_target(block, tmp_path):
    assert block["evidence_runs"] == (KEY,)
    rows = [[cell.astext() for cell in row] for row in block.findall(nodes.row)]
    assert rows[2] == ["2", "yes", "20", "0.500"]
    assert len(rows) == 2 + 5 + 3
    model = pygltflib.GLTF2.load_binary(
        tmp_path / "book" / "_build" / "html" / "replay" / f"{NAME}.glb"
    )
    assert [animation.name for animation in model.animations] == ["upright", "level"]
    assert {"box", posture_map.CROSS} <= {node.name for node in model.nodes}
    assert np.vstack([TARGETS[:1], TARGETS]).astype(np.float32).tobytes() in model.binary_blob()


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with launched(*SOFTWARE) as browser:
        yield browser


@pytest.fixture
def page(block, tmp_path, browser) -> Iterator[Page]:
    scripts, sheets = ("cell-map", "stage", "posture-map"), ("course", "replay")
    page = browser.new_page(viewport={"width": 390, "height": 844}, has_touch=True)
    problems = errors(page)
    page.goto(page_of(block, tmp_path, scripts, sheets).as_uri())
    yield page
    assert problems == []
    page.close()


def shown(page) -> tuple[str, dict[str, str]]:
    terms, values = (page.locator(f".posture-map {tag}").all_inner_texts() for tag in ("dt", "dd"))
    found = dict(zip(terms, values, strict=True))
    return page.locator(".posture-map output").inner_text(), found


@pytest.mark.browser
def test_pointer_touch_and_keys_choose_an_answer(page):
    assert shown(page)[0] == "Answer 2, accepted."  # the first that is
    page.locator(".posture-map [aria-selected=true]").focus()
    for key in ("ArrowDown", "ArrowRight", "ArrowUp", "ArrowLeft", "ArrowLeft", "ArrowDown"):
        page.keyboard.press(key)  # right of 5 and left of 1 is no cell
    assert shown(page) == (
        "Answer 4, accepted.",
        {"accepted": "yes", "left [mm]": "40", "margin [rad]": "0.250"},
    )
    assert page.evaluate("document.activeElement.ariaSelected") == "true"
    page.get_by_role("gridcell", name="× 10 left [mm]: z 0, x 0.1, refused").tap()
    assert shown(page)[0] == "Answer 1, refused."
    page.get_by_label("Cells show").select_option("margin [rad]")
    page.get_by_role("gridcell", name=".2 margin [rad]: z 1, x 0.2, accepted").click()
    assert shown(page)[0] == "Answer 5, accepted."
    page.get_by_label("Map").select_option("Plane level")
    assert shown(page)[0] == "Answer 7, accepted."
    assert page.locator(".posture-map [role=gridcell]").count() == 3
    assert page.locator(".posture-map .map [tabindex='0']").count() == 1


@pytest.mark.browser
def test_the_chosen_posture_is_shown_in_3d(page):
    page.get_by_role("button", name="Show in 3D").click()
    page.get_by_text("Turn the view").wait_for(timeout=120_000)
    page.get_by_role("gridcell", name="50 left [mm]: z 1, x 0.2, accepted").tap()
    page.wait_for_function("document.querySelector('model-viewer').currentTime > 0.049")
    trace = falling(2.0)
    assert page.evaluate(HEIGHT) == pytest.approx(trace.link_pos[5, 0, 2], abs=1e-5)
    assert page.locator(".shown").inner_text() == "answer 5, accepted"
    assert violations(page, ".posture-map", preload=False) == []
