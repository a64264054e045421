"""The replay in a real browser: it shows the record, by keyboard and from disk."""

import re
from collections.abc import Iterator
from functools import partial
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from browsers import SOFTWARE, chromium, launched
from built_site import PAGES, parsed
from gltf import report
from PIL import Image
from playwright.sync_api import Browser, Page
from watching import errors, violations

from robo_genesis.core.project import BOOK
from robo_genesis.evidence import bundle
from robo_genesis.evidence.trace_files import read_joints, read_trace
from robo_genesis.lessons import LESSONS
from robo_genesis.lessons.l04.spec import STEPPED_JOINT
from robo_genesis.lessons.l04.study_spec import ASSIGNED
from robo_genesis.site.replay import directive as sphinx_replay
from robo_genesis.site.replay.model import rotations

pytestmark = [pytest.mark.engine, pytest.mark.browser]

LECTURE = "lessons/l04-joint-control/lecture"
MODEL = "replay-l04-lecture-cpu"
REPLAY = f".replay[data-name={MODEL}]"
"""The replay of this build's run; a recorded run has its own on the same page."""

BLOCK = f".replay-block:has({REPLAY})"
POSES = """() => {
  const viewer = document.querySelector("model-viewer");
  const scene = viewer[Object.getOwnPropertySymbols(viewer).find(s => s.description === "scene")];
  scene.updateMatrixWorld(true);
  let world;
  scene.traverse(node => { if (node.name === "world") world = node; });
  const back = world.matrixWorld.clone().invert();
  const ghost = world.children.find(node => node.name === "target");
  return Object.fromEntries([...world.children, ...ghost.children].map(link => {
    const inRecord = back.clone().multiply(link.matrixWorld);
    return [link.name, {
      position: [...link.position.clone().setFromMatrixPosition(inRecord)],
      rotation: [...link.quaternion.clone().setFromRotationMatrix(inRecord)],
    }];
  }));
}"""
"""How the links stand in the running viewer, in the frame of the record: [m] and (x, y, z, w)."""

TURNED = """() => {
  const viewer = document.querySelector("model-viewer");
  const key = viewer && Object.getOwnPropertySymbols(viewer).find(s => s.description === "scene");
  let hand;
  if (key) viewer[key].traverse(node => { if (node.name === "hand") hand ??= node; });
  if (!hand) return false;
  globalThis.first ??= hand.position.z;
  return Math.abs(hand.position.z - globalThis.first) > 1e-4;
}"""
"""Whether the hand has moved since it was first seen."""

POSED = """([name, time]) => {
  const viewer = document.querySelector("model-viewer");
  return viewer.animationName === name && Math.abs(viewer.currentTime - time) < 1e-5;
}"""

FRAMES_ASKED = """async () => {
  const request = requestAnimationFrame.bind(window);
  let asked = 0;
  window.requestAnimationFrame = (todo) => {
    asked += todo.name === "advance"; // the viewer also draws
    return request(todo);
  };
  for (let frame = 0; frame < 10; frame += 1) await new Promise(request);
  window.requestAnimationFrame = request;
  return asked;
}"""
"""How often the replay asks to draw while ten frames pass."""


PLAYING = [name for name in PAGES if "{replay}" in (BOOK / f"{name}.md").read_text()]

BELOW = ("link4", "link5", "link6", "link7", "hand", "left_finger", "right_finger")
"""The links that joint4 turns."""

TOO_WIDE = """() => [...document.querySelectorAll(".replay")].flatMap(root => {
  const edge = root.getBoundingClientRect().right, slider = root.querySelector("input[type=range]");
  const parts = "input, button, select, svg, svg text, dl div, .shown, figcaption, .legend";
  const cut = [...root.querySelectorAll(parts)]
    .filter(e => e.getBoundingClientRect().right > edge).map(e => e.outerHTML);
  for (const run of root.querySelectorAll("input[type=radio]")) {
    run.click();
    for (slider.value = 0; ; slider.stepUp(7)) {
      slider.dispatchEvent(new Event("input"));
      for (const line of root.querySelectorAll("dl div")) {
        const text = document.createRange();
        text.selectNodeContents(line);
        const beyond = text.getBoundingClientRect().right - line.getBoundingClientRect().right;
        if (beyond > 0) cut.push(`${run.value} ${slider.value} ${line.innerText} ${beyond}`);
      }
      if (slider.value === slider.max) break;
    }
  }
  return cut;
})"""
"""What of the replays is cut off, or reaches into the place beside it."""


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with launched(*SOFTWARE) as browser:
        yield browser


@pytest.fixture(scope="module")
def record(site):
    """Traces by case, joint map and link names, of the accepted bundle of the lecture."""
    folder = site.parent / "pages" / "l04" / "lecture" / "cpu"
    arrays = bundle.read_arrays(folder)
    traces = {case: read_trace(folder, arrays, case) for case in LESSONS["l04"].compared.cases}
    return traces, read_joints(arrays), arrays.coords["link"]


@pytest.fixture(scope="module")
def files(site) -> Path:
    return site / sphinx_replay.FOLDER


def give(text, route) -> None:
    kind = "text/html" if route.request.url.endswith(".html") else "text/javascript"
    route.fulfill(body=text, content_type=kind)


def open_lecture(browser, base, requests=None, served=None, **context) -> Page:
    """Open the lecture; what it asks for goes to `requests`, errors to its `problems`.

    `served` is address → text, given in the place of the site's own files.
    """
    page = browser.new_page(**{"viewport": {"width": 480, "height": 700}, **context})
    page.problems = errors(page)
    for pattern, text in (served or {}).items():
        page.route(pattern, partial(give, text))
    if requests is not None:
        page.on("request", lambda request: requests.append(request.url))
    page.goto(f"{base}/{LECTURE}.html")
    return page


@pytest.fixture(scope="module")
def page(browser, address) -> Iterator[Page]:
    page = open_lecture(browser, address, viewport={"width": 320, "height": 800})
    yield page
    assert page.problems == []
    page.close()


@pytest.fixture(scope="module", params=["served", "from disk"])
def shown(request, browser, address, site) -> Iterator[Page]:
    """The lecture with the robot loaded: served in the light, from disk in the dark."""
    base, scheme = {"served": (address, "light"), "from disk": (site.as_uri(), "dark")}[
        request.param
    ]
    asked: list[str] = []
    page = open_lecture(browser, base, asked, color_scheme=scheme)
    assert readout(page)["time"] == "0.00 s, before the first step"  # nothing plays by itself
    assert page.locator(f"{REPLAY} .shown").inner_text() == "at the start"
    page.locator(REPLAY).scroll_into_view_if_needed()
    choose(page, "G2", 30)
    page.wait_for_load_state("networkidle")
    page.base, page.before, page.asked = base, [*asked], asked
    show_robot(page)
    yield page
    assert page.problems == []
    page.close()


def choose(page, case, sample):
    """Bring the replay to a sample, as a reader does: picker, then slider."""
    page.locator(f"{REPLAY} input[value={case}]").check()
    slider = page.locator(f"{REPLAY} input[type=range]")
    slider.fill(str(sample))
    return slider


def readout(page):
    terms, values = (page.locator(f"{REPLAY} {tag}").all_inner_texts() for tag in ("dt", "dd"))
    return dict(zip(terms, values, strict=True))


def number(text):
    return float(re.match(r"−?[\d.]+", text).group().replace("−", "-"))


def show_robot(page, replay=REPLAY):
    """Load the robot with the first Play, and pause if it still plays."""
    play = page.locator(f"{replay} .play")
    play.click()
    page.locator(replay).get_by_text("Turn the view").wait_for(timeout=120_000)
    play.evaluate("play => { if (play.textContent === 'Pause') play.click(); }")
    assert play.inner_text() == "Play"


def test_links_stand_where_the_record_says(shown, record):
    """In each case at several samples, the first and the last among them."""
    page, (traces, _, links) = shown, record
    for case, trace in traces.items():
        for sample in (0, 9, trace.steps):
            choose(page, case, sample)
            page.wait_for_function(POSED, arg=[case, float(trace.t[sample])])
            found = page.evaluate(POSES)
            added = [f"target_{link}" for link in BELOW]
            assert sorted(found) == sorted([*links, *added, "still", "target"])
            places, turns = (
                np.array([found[link][part] for link in links]) for part in ("position", "rotation")
            )
            recorded = rotations(trace.link_quat[sample])
            turns *= np.sign((turns * recorded).sum(axis=1))[:, None]  # q and −q turn alike
            assert places == pytest.approx(trace.link_pos[sample], abs=1e-6), (case, sample)
            assert turns == pytest.approx(recorded, abs=1e-6), (case, sample)
    for moved in (traces["G2"].link_pos, traces["G2"].link_quat):
        assert np.abs(moved[9] - moved[0]).max() > 1e-2


def test_the_copy_stands_where_the_engine_puts_the_links_at_the_target(shown, site):
    """The lecture also assigns the states of a straight line that ends at the target."""
    folder = site.parent / "pages" / "l04" / "lecture" / "cpu"
    arrays = bundle.read_arrays(folder)
    assigned, links = read_trace(folder, arrays, ASSIGNED), arrays.coords["link"]
    found = shown.evaluate(POSES)
    for link in BELOW:
        copy, k = found[f"target_{link}"], links.index(link)
        assert copy["position"] == pytest.approx(assigned.link_pos[-1, k], abs=2e-6), link
        turned = abs(np.dot(copy["rotation"], rotations(assigned.link_quat[-1:, k])[0]))
        assert turned == pytest.approx(1, abs=1e-6), link
        assert np.abs(assigned.link_quat[-1, k] - assigned.link_quat[0, k]).max() > 0.01


def test_one_click_plays_in_the_place_of_the_picture(browser, address):
    page = open_lecture(browser, address, viewport={"width": 1280, "height": 900})
    stage, below = page.locator(f"{REPLAY} .stage"), page.locator(f"{REPLAY} .controls")
    places = stage.bounding_box(), below.bounding_box()
    picture = page.locator(f"{REPLAY} .still")
    loaded = "([selector]) => document.querySelector(selector).naturalWidth > 0"
    page.wait_for_function(loaded, arg=[f"{REPLAY} .still"])
    page.locator(f"{REPLAY} .play").click()
    page.wait_for_function(TURNED, timeout=60_000)  # an idle machine takes less than 3 s
    assert page.locator(f"{REPLAY} .play").inner_text() == "Pause"
    assert not picture.is_visible()
    assert (stage.bounding_box(), below.bounding_box()) == places
    assert page.problems == []
    page.close()


@pytest.mark.parametrize("lecture", [LECTURE, "lessons/l01-ready/lecture"])
@pytest.mark.parametrize("size", [(1280, 900), (390, 844)])
def test_play_is_on_the_first_screen(browser, address, lecture, size):
    page = browser.new_page(viewport=dict(zip(("width", "height"), size, strict=True)))
    page.goto(f"{address}/{lecture}.html")
    play = page.locator(".replay .play").first.bounding_box()
    assert play["y"] + play["height"] < size[1]
    page.close()


def test_the_picture_is_that_of_the_model(shown):
    """Both show the robot in one place: most points of one are in the other."""
    choose(shown, "G1", 0)
    shown.wait_for_function(POSED, arg=["G1", 0.0])
    stage = shown.locator(f"{REPLAY} .stage")
    model = lightness(shown, stage, "model-viewer")
    picture = lightness(shown, stage, ".still")
    above = np.s_[: int(0.7 * len(model))]  # the floor is below; its light differs
    robot, drawn = (np.abs(image - image[20, -20])[above] > 15 for image in (model, picture))
    assert 0.15 < robot.mean() < 0.5
    assert (robot & drawn).sum() / (robot | drawn).sum() > 0.8


def lightness(page, stage, part) -> np.ndarray:
    """Return a screenshot of one part of the stage alone, 0 to 255."""
    only = f".stage > :not({part}) {{ visibility: hidden; }} .stage > {part} {{ display: block; }}"
    style = page.add_style_tag(content=only.replace("}", " }").replace(";", " !important;"))
    with Image.open(BytesIO(stage.screenshot())) as image:
        found = np.asarray(image.convert("L")).astype(int)
    style.evaluate("style => style.remove()")
    return found


def test_sample_0_is_the_state_before_the_first_step(page, record):
    traces, joints, _ = record
    k = joints.entry(STEPPED_JOINT)
    for case, trace in traces.items():
        slider = choose(page, case, 0)
        shown = readout(page)
        assert shown["time"] == "0.00 s, before the first step"
        assert number(shown["position"]) == pytest.approx(trace.q[0, k], abs=6e-5)
        assert number(shown["velocity"]) == pytest.approx(trace.start_qd[k], abs=6e-5)
        start = trace.start_control_force[k]
        assert number(shown["control force"]) == pytest.approx(start, abs=6e-3)
        assert "before the first step" in slider.get_attribute("aria-valuetext")


def test_keys_move_through_time_and_all_follows(shown, record):
    page, (traces, joints, _) = shown, record
    k, trace = joints.entry(STEPPED_JOINT), traces["G2"]
    slider = choose(page, "G2", 0)
    slider.focus()
    for _ in range(9):
        page.keyboard.press("ArrowRight")
    shown = readout(page)
    assert shown["time"] == "0.09 s"
    assert number(shown["velocity"]) == pytest.approx(trace.qd[8, k], abs=6e-5)
    assert number(shown["force limit"][1:]) == trace.effort_limit[k]
    spoken = slider.get_attribute("aria-valuetext")
    assert spoken.startswith("G2: time 0.09 s; position ")
    assert shown["control force"] in spoken
    page.keyboard.press("End")
    assert readout(page)["time"] == "1.20 s"
    before = page.locator(f"{REPLAY} .cursor").first.get_attribute("x1")
    page.keyboard.press("Home")
    assert page.locator(f"{REPLAY} .cursor").first.get_attribute("x1") != before


def test_arrow_keys_pick_a_case_and_its_curve_is_bold(page):
    choose(page, "G1", 20)
    page.locator(f"{REPLAY} input[value=G1]").focus()
    page.keyboard.press("ArrowDown")
    assert page.locator(f"{REPLAY} .chosen").evaluate_all(
        "all => all.map(e => e.classList.item(1))"
    ) == (["case-g2"] * 3)
    names = page.locator(f"{REPLAY} svg").evaluate_all("all => all.map(e => e.ariaLabel)")
    assert all("G2 is drawn bold" in name for name in names)


def test_the_curve_is_drawn_to_scale(page, record):
    traces, joints, _ = record
    k = joints.entry(STEPPED_JOINT)
    drawn = (
        page.locator(f"{REPLAY} svg")
        .nth(2)
        .evaluate("""svg => ({
        y: svg.querySelector(".case-g2").getAttribute("points").split(" ")
          .map(pair => Number(pair.split(",")[1])),
        limits: [...svg.querySelectorAll("line.limit")].map(l => Number(l.getAttribute("y1")))
    })""")
    )
    low, high = drawn["limits"]
    limit = traces["G2"].effort_limit[k]
    force = [(y - low) / (high - low) * 2 * limit - limit for y in drawn["y"]]
    recorded = [traces["G2"].start_control_force[k], *traces["G2"].control_force[:, k]]
    assert force == pytest.approx(recorded, abs=0.2)  # coordinates have one decimal


def test_play_runs_to_the_end_and_pauses_on_a_sample(page):
    show_robot(page)
    choose(page, "G2", 0)
    speed = page.locator(f"{REPLAY} select")
    speed.select_option("0.1")  # slow enough to be paused before the end
    play = page.locator(f"{REPLAY} .play")
    play.focus()
    page.keyboard.press("Space")
    assert play.inner_text() == "Pause"
    page.wait_for_function(f"document.querySelector('{REPLAY} input[type=range]').value > 5")
    page.keyboard.press("Space")
    paused = page.locator(f"{REPLAY} input[type=range]").input_value()
    assert play.inner_text() == "Play"
    assert page.evaluate(FRAMES_ASKED) == 0  # it does not play on
    assert page.locator(f"{REPLAY} input[type=range]").input_value() == paused
    speed.select_option("1")
    play.press("Space")
    page.wait_for_function(f"document.querySelector('{REPLAY} input[type=range]').value === '120'")
    assert play.inner_text() == "Play"


def test_play_after_a_pause_in_one_frame_is_still_one_loop(page):
    choose(page, "G2", 0)
    press_often = "for (const press of ['play', 'pause', 'play']) play.click();"
    page.locator(f"{REPLAY} .play").evaluate(f"play => {{ {press_often} }}")
    assert 0 < page.evaluate(FRAMES_ASKED) <= 11  # two loops would ask twice in each of ten frames
    page.locator(f"{REPLAY} .play").click()


def test_reduced_motion_goes_by_steps(browser, address):
    page = open_lecture(browser, address, reduced_motion="reduce")
    play = page.locator(f"{REPLAY} .play")
    assert play.inner_text() == "Next 0.05 s"
    play.click()
    page.locator(REPLAY).get_by_text("Turn the view").wait_for(timeout=120_000)
    assert readout(page)["time"] == "0.05 s"
    assert page.evaluate(FRAMES_ASKED) == 0  # it stands still
    assert readout(page)["time"] == "0.05 s"
    assert page.problems == []
    page.close()


def of_replay(urls) -> list[str]:
    """Return the names of the files in the replay's folder."""
    found = (re.search(rf"/{sphinx_replay.FOLDER}/([^/]+)$", url) for url in urls)
    return sorted(match[1] for match in found if match)


def test_viewer_and_model_are_asked_for_on_request_alone(shown):
    assert of_replay(shown.before) == []
    assert of_replay(shown.asked) == [sphinx_replay.VIEWER, f"{MODEL}.js"]
    own = (shown.base, "data:", "blob:")
    assert [url for url in shown.asked if not url.startswith(own)] == []


def test_axe_finds_nothing_with_the_robot_shown(shown):
    shown.locator(f"{BLOCK} summary").click()
    assert violations(shown, BLOCK, preload=False) == []


def test_the_case_is_named_beside_the_robot(shown):
    lines = {}
    for case in LESSONS["l04"].compared.cases:
        choose(shown, case, 5)
        assert shown.locator(f"{REPLAY} .shown").inner_text() == case
        line, picked = (
            shown.locator(selector).evaluate("e => getComputedStyle(e, '::before').background")
            for selector in (f"{REPLAY} .shown", f"{REPLAY} label.case-{case.lower()}")
        )
        assert line == picked
        lines[line] = case
    assert list(lines.values()) == list(LESSONS["l04"].compared.cases)


def test_a_browser_without_3d_says_so_and_loads_nothing(browser, address):
    arguments = ["--no-sandbox", "--disable-3d-apis"]
    blind = browser.browser_type.launch(executable_path=chromium(), args=arguments)
    asked: list[str] = []
    page = open_lecture(blind, address, asked)
    page.locator(f"{REPLAY} .play").click()
    page.locator(REPLAY).get_by_text("This browser draws no 3D").wait_for()
    page.wait_for_function(f"document.querySelector('{REPLAY} input[type=range]').value > 0")
    page.wait_for_load_state("networkidle")
    assert of_replay(asked) == []
    assert page.locator("model-viewer").count() == 0
    assert page.locator(f"{REPLAY} .still").is_visible()
    assert page.problems == []
    blind.close()


def test_a_file_that_is_missing_is_said(browser, address):
    page = open_lecture(browser, address)
    page.route(f"**/{MODEL}.js", lambda route: route.abort())
    page.locator(f"{REPLAY} .play").click()
    page.locator(f"{REPLAY} [role=status]").get_by_text("cannot be shown").wait_for()
    assert page.locator("model-viewer").count() == 0
    assert page.locator(f"{REPLAY} .play").inner_text() == "Pause"  # the plots play
    page.close()


def test_two_replays_of_a_page_are_two(browser, address, site, files):
    """A recorded run brings its own: other names, another model, the same viewer."""
    other, html = "replay-l04-lab-other-recorded", (site / f"{LECTURE}.html").read_text()
    block = str(parsed(site, LECTURE).select_one(BLOCK)).replace(MODEL, other)
    block = block.replace(f"{other}.jpg", f"{MODEL}.jpg")
    html = html.replace("</article>", f"{block}</article>", 1)
    script = sphinx_replay.script_of(other, (files / f"{MODEL}.glb").read_bytes())
    served = {f"**/{LECTURE}.html": html, f"**/{other}.js": script}
    page = open_lecture(browser, address, served=served)
    first, second = page.locator(REPLAY), page.locator(f".replay[data-name={other}]")
    second.locator("input[value=G3]").check()
    second.locator("input[type=range]").fill("7")
    assert first.locator("input:checked").input_value() == "G1"
    assert first.locator("input[type=range]").input_value() == "0"
    for replay in (REPLAY, f".replay[data-name={other}]"):
        show_robot(page, replay)
    assert page.locator("model-viewer").count() == 2
    assert page.problems == []
    page.close()


@pytest.mark.parametrize("width", [320, 390, 1280])
@pytest.mark.parametrize("name", PLAYING)
def test_nothing_is_cut_off_or_collides(browser, address, name, width):
    """At each sample of each run of each replay of a page."""
    page = browser.new_page(viewport={"width": width, "height": 800})
    page.goto(f"{address}/{name}.html")
    assert page.evaluate(TOO_WIDE) == []
    page.close()


def test_the_validator_finds_nothing_in_the_site_s_model(files, tmp_path):
    found = report((files / f"{MODEL}.glb").read_bytes(), tmp_path)
    assert found["issues"]["messages"] == []
    assert found["info"]["animationCount"] == 3


def test_script_and_download_hold_one_model_with_its_licence(files):
    text = (files / f"{MODEL}.js").read_text()
    assert sphinx_replay.script_of(MODEL, (files / f"{MODEL}.glb").read_bytes()) == text.encode()
    assert "Franka Robotics GmbH" in (files / sphinx_replay.NOTICE).read_text()
    assert "Apache License" in (files / sphinx_replay.VIEWER_LICENCE).read_text()


def test_the_script_is_deferred_and_on_no_other_page(site):
    (script,) = parsed(site, LECTURE).select("script[src*='replay.js']")
    assert script.has_attr("defer")
    found = [path for path in site.rglob("*.html") if "_static/replay.js" in path.read_text()]
    playing = {path.relative_to(site).with_suffix("").as_posix() for path in found}
    assert playing == set(PLAYING)
