"""The replay in a real browser: it shows the record, by keyboard and from disk.

A page with two falling boxes shows what every replay does; the built lecture has a
robot."""

import base64
import gzip
import re
import shutil
import sys
from types import SimpleNamespace

import numpy as np
import pygltflib
import pytest
from browsers import chromium
from docutils import nodes
from falling import LINKS, G, falling
from playwright.sync_api import Page
from watching import call, choose, readout, show_model, violations
from without_sphinx import Panel, box, rows_of

from robo_genesis import lessons as registry
from robo_genesis.core.channels import Replay
from robo_genesis.core.declaration import Lesson
from robo_genesis.evidence import bundle
from robo_genesis.evidence.trace_files import read_any_trace, write_traces
from robo_genesis.sim import visual_shape
from robo_genesis.site.replay import viewer
from robo_genesis.site.replay.directive import replay_block

LESSON, KEY = "l99", "l99/lecture/cpu"
NAME = "replay-l99-lecture-cpu"
DROPPED = Replay(("high", "low"), "box", "box")
STEPS = 40


@pytest.fixture
def dropped(folder, monkeypatch, tmp_path, built):
    """A bundle of two falls, of a lesson that declares them and wrote its shape."""
    shutil.rmtree(folder / "arrays")
    traces = {"high": falling(2.0, STEPS), "low": falling(1.0, STEPS)}
    write_traces(folder, traces, None, LINKS)
    spec = registry.find_lesson("l04").spec
    lesson = Lesson(spec, {}, {}, {"drops": DROPPED})
    monkeypatch.setattr(registry, "LESSONS", (*registry.LESSONS, LESSON))
    monkeypatch.setitem(
        sys.modules,
        f"{registry.__name__}.{LESSON}.pages",
        SimpleNamespace(LESSON=lesson),
    )
    built({f"{LESSON}/lecture": tmp_path / LESSON / "lecture"})
    visual_shape.write_shape(
        tmp_path / LESSON / "lecture" / "cpu", [box("box"), visual_shape.floor(1.0)]
    )
    return folder


@pytest.fixture
def block(dropped, tmp_path) -> nodes.Node:
    return replay_block(Panel(tmp_path / "book"), KEY, dropped)


def test_the_block_plays_the_record_and_names_no_other_s_model(
    block, dropped, tmp_path
):
    assert block["evidence_runs"] == (KEY,)
    rows = rows_of([block])
    heads = ["z [m]", "ż [m/s]"]
    assert rows[0] == [
        "t [s]",
        *(f"{case} {head}" for case in ("high", "low") for head in heads),
    ]
    assert len(rows) == 1 + STEPS + 1
    assert rows[21] == [
        "0.2",
        "1.8",
        "−2",
        "0.8",
        "−2",
    ]  # height and velocity: high, low
    text = block.astext()
    assert "the box starts at a height of 2.0000 m" in text
    written = tmp_path / "book" / "_build" / "html" / "replay"
    model = pygltflib.GLTF2.load_binary(written / f"{NAME}.glb")
    assert [animation.name for animation in model.animations] == ["high", "low"]
    recorded = read_any_trace(dropped, bundle.read_arrays(dropped), "low")
    assert recorded.link_pos[:, 1].tobytes() in model.binary_blob()
    assert model.asset.copyright is None
    assert "Franka" not in text
    assert ">licence</a>" in text  # the viewer's
    script = (written / f"{NAME}.js").read_bytes()
    packed = re.search(rb'"\] = "(.*)";', script)
    assert base64.b64decode(packed[1]) == (written / f"{NAME}.glb").read_bytes()
    weight = len(gzip.compress(script)) + len(gzip.compress(viewer.viewer()))
    assert f"Play or the time loads the 3D model: {round(weight / 1000)} kB." in text


def test_a_lesson_without_a_shape_gets_the_call_that_writes_one(dropped, tmp_path):
    (tmp_path / LESSON / "lecture" / "cpu" / visual_shape.FILE).unlink()
    with pytest.raises(ValueError, match="l99 wrote no shape of its box") as caught:
        replay_block(Panel(tmp_path / "book"), KEY, dropped)
    assert "page.write_shape(l99.read_shape(entity)) after scene.build()" in str(
        caught.value
    )


@pytest.fixture
def page(block, open_block) -> Page:
    return open_block(block)


@pytest.mark.browser
def test_keys_read_the_record_out_and_the_plots_draw_it(page):
    assert (
        readout(page, ".replay")["time"] == "0.00 s, before the first step"
    )  # not played
    slider = choose(page, "low", 19)
    slider.press("ArrowRight")
    fallen = {
        "time": "0.20 s",
        "height": "0.8000 m",
        "vertical velocity": "−2.0000 m/s",
    }
    assert readout(page, ".replay") == fallen
    spoken = "low: time 0.20 s; height 0.8000 m; vertical velocity −2.0000 m/s"
    assert slider.get_attribute("aria-valuetext") == spoken
    chosen = (
        page.locator(".replay .plot svg")
        .first.locator(".chosen")
        .get_attribute("points")
    )
    heights = [float(pair.split(",")[1]) for pair in chosen.split()]
    fallen = (np.array(heights) - heights[0]) / (heights[-1] - heights[0])
    assert fallen == pytest.approx(np.linspace(0, 1, STEPS + 1) ** 2, abs=0.01)
    assert page.locator(".replay .dot.case-g2").count() == 2
    assert page.locator(".plot text").all_text_contents()[1:4] == [
        "0.0 s",
        "0.1",
        "0.2",
    ]
    cursor = page.locator(".replay .cursor").first
    places = [
        slider.press(key) or cursor.get_attribute("x1") for key in ("End", "Home")
    ]
    assert float(places[0]) > float(places[1])
    page.locator("input[value=low]").press("ArrowUp")
    assert page.locator(".chosen").first.get_attribute("class").split()[1] == "case-g1"


@pytest.mark.browser
def test_the_box_falls_in_3d_in_the_place_of_its_picture(page):
    stage, picture = page.locator(".stage"), page.locator(".still")
    page.wait_for_function("document.querySelector('.still').naturalWidth > 0")
    place = stage.bounding_box()
    assert page.asked.count(f"{NAME}.js") == 0
    assert page.locator(".shown").inner_text() == "at the start"
    show_model(page)
    assert {viewer.VIEWER, f"{NAME}.js"} <= {*page.asked}
    assert not picture.is_visible()
    assert stage.bounding_box() == place
    model = page.locator("model-viewer")
    assert model.get_attribute("alt").startswith("The box in 3D at the sample")
    choose(page, "high", 30)
    assert page.locator(".shown").inner_text() == "high"
    page.wait_for_function("document.querySelector('model-viewer').currentTime > 0.29")
    _, _, height = call(page, "poses")["box"]["position"]
    assert height == pytest.approx(2.0 - G * 0.3**2 / 2, abs=1e-5)
    assert violations(page, ".replay", preload=False) == []


@pytest.mark.browser
def test_the_first_move_of_the_time_slider_moves_the_picture(page):
    page.locator("input[type=range]").press("End")
    page.get_by_text("Turn the view").wait_for(timeout=120_000)
    page.wait_for_function("document.querySelector('model-viewer').currentTime > 0.39")
    _, _, height = call(page, "poses")["box"]["position"]
    assert height == pytest.approx(2.0 - G * 0.4**2 / 2, abs=1e-4)


VIEW = """() => {
  const viewer = document.querySelector("model-viewer");
  return [viewer.animationName, viewer.getCameraTarget().y, viewer.getFieldOfView()];
}"""


@pytest.mark.browser
def test_the_asked_case_is_first_and_a_close_up_follows_it(
    dropped, open_block, tmp_path
):
    more = {"blind": True, "first": "low", "close_up": 0.5}
    asking = replay_block(Panel(tmp_path / "book"), KEY, dropped, **more)
    asking["classes"].remove("veiled")
    page = open_block(asking)
    assert page.locator("input[type=radio]").first.is_checked()
    page.locator("input[type=range]").press("End")
    page.get_by_text("Turn the view").wait_for(timeout=120_000)
    shown = page.evaluate(VIEW)
    close = page.get_by_role("button", name="Close-up")
    close.click()
    page.wait_for_function(f"({VIEW})()[0] === 'low, close-up'")
    _, height, angle = page.evaluate(VIEW)
    assert (height, angle < shown[2]) == (0, True)  # the box is at the origin
    close.click()
    page.wait_for_function(f"({VIEW})()[0] === 'low'")
    assert page.evaluate(VIEW) == pytest.approx(shown)
    page.get_by_role("button", name="Zoom in").click()
    page.wait_for_function(f"({VIEW})()[2] < {0.8 * shown[2]}")
    page.locator(".replay-block").evaluate("block => block.classList.add('veiled')")
    veil, stage = (page.locator(one).bounding_box() for one in (".veil", ".stage"))
    assert veil["y"] >= stage["y"] + stage["height"]


@pytest.mark.browser
def test_the_table_of_samples_is_in_the_page_when_its_fold_opens(page):
    cells = page.locator("td")
    assert cells.count() == 0
    page.locator("summary").click()
    cells.last.wait_for()
    assert cells.count() == (STEPS + 1) * 5
    assert violations(page, "details", preload=False) == []


@pytest.mark.browser
def test_play_runs_to_the_end_and_pauses_on_a_sample(page):
    show_model(page)
    slider = choose(page, "low", 0)
    speed, play = page.locator("select"), page.locator(".play")
    speed.select_option("0.1")  # slow enough to be paused before the end
    play.press("Space")
    page.wait_for_function("document.querySelector('input[type=range]').value > 2")
    play.press("Space")
    paused = slider.input_value()
    assert play.inner_text() == "Play"
    assert call(page, "frames_asked") == 0  # it does not play on
    assert slider.input_value() == paused
    press_often = "for (const press of ['play', 'pause', 'play']) play.click();"
    play.evaluate(f"play => {{ {press_often} }}")
    assert (
        0 < call(page, "frames_asked") <= 11
    )  # two loops would ask twice in each of ten frames
    speed.select_option("1")
    page.wait_for_function("document.querySelector('input[type=range]').value === '40'")
    page.wait_for_function("document.querySelector('.play').innerText === 'Play'")


@pytest.mark.browser
def test_reduced_motion_goes_by_steps(block, open_block):
    page = open_block(block, reduced_motion="reduce")
    play = page.locator(".play")
    assert play.inner_text() == "Next 0.05 s"
    play.click()
    page.get_by_text("Turn the view").wait_for(timeout=120_000)
    assert call(page, "frames_asked") == 0  # it stands still
    assert readout(page, ".replay")["time"] == "0.05 s"


@pytest.mark.browser
def test_without_3d_or_file_the_plots_play_and_it_is_said(
    block, open_block, browser_3d, tmp_path
):
    arguments = ["--no-sandbox", "--disable-3d-apis"]
    blind = browser_3d.browser_type.launch(executable_path=chromium(), args=arguments)
    page = open_block(block, blind)
    page.locator(".play").click()
    page.get_by_text("This browser draws no 3D").wait_for()
    page.wait_for_function("document.querySelector('input[type=range]').value > 0")
    assert f"{NAME}.js" not in page.asked
    assert page.locator(".still").is_visible()
    blind.close()
    (tmp_path / "book" / "_build" / "html" / "replay" / f"{NAME}.js").unlink()
    page = open_block(block)
    page.locator(".play").click()
    page.get_by_text("cannot be shown").wait_for()
    assert page.locator("model-viewer").count() == 0
    assert page.locator(".play").inner_text() == "Pause"
    page.problems.clear()  # the browser names the missing file
