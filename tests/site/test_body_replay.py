"""Free bodies are drawn and played from a bundle without joints, up to a page in the browser."""

import shutil
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pygltflib
import pytest
import trimesh
from browsers import SOFTWARE, launched
from docutils import nodes
from docutils.parsers.rst import DirectiveError
from playwright.sync_api import Browser, Page
from watching import errors, violations
from without_sphinx import Panel, page_of

from robo_genesis import lessons as registry
from robo_genesis.core.declaration import Filmed, Lesson, Moving
from robo_genesis.core.trace import BodyTrace
from robo_genesis.evidence import bundle
from robo_genesis.evidence.replay_data import read_runs
from robo_genesis.evidence.strict_json import write_json
from robo_genesis.evidence.trace_files import read_any_trace, write_traces
from robo_genesis.sim import visual_shape
from robo_genesis.site.evidence import glance as sphinx_glance
from robo_genesis.site.evidence.panel import response
from robo_genesis.site.replay.directive import replay_block

LESSON, KEY = "l99", "l99/lecture/cpu"
NAME = "replay-l99-lecture-cpu"
DROPPED = Moving(("high", "low"), link="box", thing="box")
STEPS, DT, G = 40, 0.01, 10.0
HEIGHT = """() => {
  const viewer = document.querySelector("model-viewer");
  const symbols = Object.getOwnPropertySymbols(viewer);
  const scene = viewer[symbols.find(symbol => symbol.description === "scene")];
  let box;
  scene.traverse(node => { if (node.name === "box") box ??= node; });
  return box.position.z;
}"""


def falling(height: float) -> BodyTrace:
    """A box that falls from a height [m] and turns about x while it does."""
    t = np.arange(STEPS + 1) * DT
    pos, vel, spin = np.zeros((3, STEPS + 1, 1, 3), np.float32)
    pos[:, 0, 2], vel[:, 0, 2], spin[..., 0] = height - G * t**2 / 2, -G * t, 1.0
    quat = np.zeros((STEPS + 1, 1, 4), np.float32)
    quat[:, 0, 0], quat[:, 0, 1] = np.cos(t / 2), np.sin(t / 2)
    return BodyTrace(t=t, link_pos=pos, link_quat=quat, link_vel=vel, link_ang=spin)


@pytest.fixture
def dropped(folder, monkeypatch, tmp_path, built):
    """A bundle of two falls, of a lesson that declares them and wrote its shape."""
    shutil.rmtree(folder / "arrays")
    traces = {"high": falling(2.0), "low": falling(1.0)}
    arrays = write_traces(folder, traces, None, ["box"])
    write_json(folder / "arrays.json", arrays.model_dump(by_alias=True))
    spec = registry.LESSONS["l04"].spec
    lesson = Lesson(spec, {}, {}, Filmed("the box"), DROPPED)
    monkeypatch.setitem(registry.LESSONS.found, LESSON, lesson)
    built({f"{LESSON}/lecture": tmp_path / LESSON / "lecture"})
    box = trimesh.creation.box((0.2, 0.2, 0.2))
    part = visual_shape.Part("box", (200, 80, 0), box.vertices.astype(np.float32), box.faces)
    visual_shape.write_shape(tmp_path / LESSON / "lecture", [part, visual_shape.floor(1.0)])
    return folder


@pytest.fixture
def block(dropped, tmp_path) -> nodes.Node:
    return replay_block(Panel(tmp_path / "book"), KEY, dropped)


def test_runs_of_joints_are_not_read_as_bodies_nor_the_other_way(dropped, pristine):
    with pytest.raises(bundle.BundleRefused, match="joints of free bodies"):
        read_runs(pristine, Moving(("G1",), link="hand", thing="hand"))
    with pytest.raises(bundle.BundleRefused):
        read_runs(dropped, replace(registry.LESSONS["l04"].compared, cases=("high", "low")))


def test_pictures_draw_what_the_bundle_holds(dropped):
    glance, panel = sphinx_glance.response(dropped, DROPPED), response(dropped, DROPPED, "cpu")
    assert glance.alt == "Height of the box over time: high and low."
    assert glance.caption == "Height of the box, from get_links_pos."
    both = "Height and vertical velocity of the box over time on cpu"
    assert panel.alt == f"{both}, with the cases high and low drawn over each other."
    other = Moving(("low", "high"), link="box", thing="box")
    assert sphinx_glance.response(dropped, other).content != glance.content


def test_the_block_plays_the_record_and_names_no_other_s_model(block, dropped, tmp_path):
    assert block["evidence_runs"] == (KEY,)
    rows = [[cell.astext() for cell in row] for row in block.findall(nodes.row)]
    assert len(rows) == 1 + STEPS + 1
    assert rows[21] == ["0.2", "1.8", "−2", "0.8", "−2"]  # height and velocity: high, low
    text = block.astext()
    assert "the box starts at a height of 2.0000 m" in text
    written = tmp_path / "book" / "_build" / "html" / "replay"
    model = pygltflib.GLTF2.load_binary(written / f"{NAME}.glb")
    assert [animation.name for animation in model.animations] == ["high", "low"]
    recorded = read_any_trace(dropped, bundle.read_arrays(dropped), "low")
    assert recorded.link_pos[:, 0].tobytes() in model.binary_blob()
    assert model.asset.copyright is None
    assert "Franka" not in text
    assert ">licence</a>" in text  # the viewer's


def test_a_brief_replay_has_the_same_model_one_channel_and_no_sentences(dropped, tmp_path):
    written = tmp_path / "book" / "_build" / "html" / "replay" / f"{NAME}.glb"
    replay_block(Panel(tmp_path / "book"), KEY, dropped)
    model = written.read_bytes()
    block = replay_block(Panel(tmp_path / "book"), KEY, dropped, brief=True)
    assert written.read_bytes() == model
    rows = [[cell.astext() for cell in row] for row in block.findall(nodes.row)]
    assert rows[21] == ["0.2", "1.8", "0.8"]  # heights: high, low
    assert not list(block.findall(nodes.list_item))
    opening = next(iter(block.findall(nodes.raw))).astext()
    assert "height" in opening
    assert "velocity" not in opening


def test_a_lesson_without_a_shape_gets_the_call_that_writes_one(dropped, tmp_path):
    (tmp_path / LESSON / "lecture" / visual_shape.FILE).unlink()
    with pytest.raises(DirectiveError) as caught:
        replay_block(Panel(tmp_path / "book"), KEY, dropped)
    assert "l99 wrote no shape of its box" in caught.value.msg
    assert "page.write_shape(l99.read_shape(entity)) after scene.build()" in caught.value.msg


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with launched(*SOFTWARE) as browser:
        yield browser


@pytest.fixture
def page(block, tmp_path, browser) -> Iterator[Page]:
    """A page that holds the replay alone, opened from disk."""
    file = page_of(block, tmp_path, ("plot", "stage", "replay"), ("plot", "replay"))
    page = browser.new_page(viewport={"width": 480, "height": 700})
    problems = errors(page)
    page.goto(file.as_uri())
    yield page
    assert problems == []
    page.close()


@pytest.mark.browser
def test_keys_read_the_record_out_and_the_plots_draw_it(page):
    slider = page.locator("input[type=range]")
    page.locator("input[value=low]").check()
    slider.fill("20")
    terms, values = (page.locator(f".replay {tag}").all_inner_texts() for tag in ("dt", "dd"))
    assert dict(zip(terms, values, strict=True)) == {
        "time": "0.20 s", "height": "0.8000 m", "vertical velocity": "−2.0000 m/s",
    }  # fmt: skip
    spoken = "low: time 0.20 s; height 0.8000 m; vertical velocity −2.0000 m/s"
    assert slider.get_attribute("aria-valuetext") == spoken
    labels = page.locator(".replay svg").evaluate_all("all => all.map(e => e.ariaLabel)")
    assert labels == [
        "Height [m] of the box over time; low is drawn bold.",
        "Vertical velocity [m/s] of the box over time; low is drawn bold.",
    ]
    chosen = page.locator(".replay svg").first.locator(".chosen").get_attribute("points")
    heights = [float(pair.split(",")[1]) for pair in chosen.split()]
    fallen = (np.array(heights) - heights[0]) / (heights[-1] - heights[0])
    assert fallen == pytest.approx(np.linspace(0, 1, STEPS + 1) ** 2, abs=0.01)
    assert page.locator(".replay .dot.case-g2").count() == 2


@pytest.mark.browser
def test_the_box_falls_in_3d_in_the_place_of_its_picture(page):
    stage, picture = page.locator(".stage"), page.locator(".still")
    page.wait_for_function("document.querySelector('.still').naturalWidth > 0")
    place = stage.bounding_box()
    page.locator(".play").click()
    page.get_by_text("Turn the view").wait_for(timeout=120_000)
    assert not picture.is_visible()
    assert stage.bounding_box() == place
    model = page.locator("model-viewer")
    assert model.get_attribute("alt").startswith("The box in 3D, where it is")
    page.locator("input[value=high]").check()
    page.locator("input[type=range]").fill("30")
    page.wait_for_function("document.querySelector('model-viewer').currentTime > 0.29")
    height = page.evaluate(HEIGHT)
    assert height == pytest.approx(2.0 - G * 0.3**2 / 2, abs=1e-5)
    assert violations(page, ".replay", preload=False) == []
