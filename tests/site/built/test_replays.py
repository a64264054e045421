"""The replays of the built pages: the robot of a lecture is where the record says, and all fit."""

from collections.abc import Iterator

import numpy as np
import pytest
from built_site import PAGES
from playwright.sync_api import Page
from watching import call, choose, errors, show_all, show_model

from robo_genesis.core.project import BOOK
from robo_genesis.evidence import bundle
from robo_genesis.evidence.trace_files import read_any_trace
from robo_genesis.lessons import find_replay
from robo_genesis.lessons.l04 import spec
from robo_genesis.sim.mujoco.kinematics import link_poses
from robo_genesis.site.replay.model import rotations

pytestmark = [pytest.mark.engine, pytest.mark.browser]

LECTURE = "lessons/l04-joint-control/motion"
REPLAY = ".replay[data-name=replay-l04-motion-cpu]"
FIRST_SCREEN = (
    LECTURE,
    "lessons/l04-joint-control/lecture",
    "lessons/l01-ready/lecture",
)  # Pages that begin with their replay

# The links that joint4 turns.
BELOW = ("link4", "link5", "link6", "link7", "hand", "left_finger", "right_finger")

PLAYING = [name for name in PAGES if "{replay}" in (BOOK / f"{name}.md").read_text()]

POSED = """([name, time]) => {
  const viewer = document.querySelector("model-viewer");
  return viewer.animationName === name && Math.abs(viewer.currentTime - time) < 1e-5;
}"""


# Names of curves through which a curve runs.
CROSSED = """() => [...document.querySelectorAll(".time-plot .name")].flatMap(name => {
  const { x, y, width, height } = name.getBBox();
  const inside = at => at.x > x && at.x < x + width && at.y > y + 3 && at.y < y + height - 3;
  return [...name.parentNode.querySelectorAll("polyline")].flatMap(line => {
    const steps = Array.from({ length: line.getTotalLength() / 3 }, (_, k) => 3 * k);
    return steps.some(s => inside(line.getPointAtLength(s))) ? [name.textContent] : [];
  });
})"""


@pytest.fixture(scope="module")
def lecture(browser_3d, site) -> Iterator[Page]:
    """The lecture from disk with the robot loaded."""
    page = browser_3d.new_page(
        viewport={"width": 480, "height": 700}, color_scheme="dark"
    )
    page.set_default_timeout(120_000)
    problems = errors(page)
    page.goto((site / f"{LECTURE}.html").as_uri())
    show_model(page, REPLAY)
    yield page
    assert problems == []
    page.close()


def test_links_and_their_copies_are_where_the_record_says(lecture, site):
    """In each case at several samples. MuJoCo tells where the target is."""
    folder = site.parent / "pages" / "l04" / "motion" / "cpu"
    arrays = bundle.read_arrays(folder)
    links = arrays.coords["link"]
    for case in find_replay("l04").cases:
        trace = read_any_trace(folder, arrays, case)
        for sample in (0, 9, trace.steps):
            choose(lecture, case, sample, REPLAY)
            # By the clock: without a graphics card, frames may be seconds apart.
            lecture.wait_for_function(
                POSED, arg=[case, float(trace.t[sample])], polling=100
            )
            found = call(lecture, "poses")
            added = [f"target_{link}" for link in BELOW]
            assert sorted(found) == sorted(
                [*links, *added, "still", "target", "shadows"]
            )
            poses = [
                [found[link][part] for link in links]
                for part in ("position", "rotation")
            ]
            places, turns = map(np.array, poses)
            recorded = rotations(trace.link_quat[sample])
            turns *= np.sign((turns * recorded).sum(axis=1))[
                :, None
            ]  # q and −q turn alike
            assert places == pytest.approx(trace.link_pos[sample], abs=1e-6), (
                case,
                sample,
            )
            assert turns == pytest.approx(recorded, abs=1e-6), (case, sample)
        assert np.abs(trace.link_pos[9] - trace.link_pos[0]).max() > 1e-3
    places, turns = (of[0] for of in link_poses(spec.BASELINE.q_target[None], links))
    for link in BELOW:
        copy, k = found[f"target_{link}"], links.index(link)
        assert copy["position"] == pytest.approx(places[k], abs=5e-6), link
        turned = abs(np.dot(copy["rotation"], rotations(turns[k : k + 1])[0]))
        assert turned == pytest.approx(1, abs=1e-6), link


STEPS = ".replay[data-name=replay-l04-motion-cpu-steps]"
CURVES = f"{STEPS} polyline"


def test_nothing_of_the_runs_shows_before_an_answer_and_curves_grow_with_time(
    browser_3d, address
):
    """By keyboard; the answer and what was shown are remembered until the reader forgets them."""
    context = browser_3d.new_context()
    page = context.new_page()
    page.goto(f"{address}/{LECTURE}.html")
    hidden = [f"{STEPS} .play", f"{STEPS} dl", CURVES, ".explorer:has(.plots)"]
    feedback, table = (
        page.locator(".feedback:visible"),
        page.locator(f"{STEPS} + details"),
    )
    assert not any(
        page.locator(one).first.is_visible() for one in [*hidden, f"{STEPS} + details"]
    )
    page.get_by_label("about the same").first.press("Space")
    assert page.get_by_text("Noted. Play the run").count() == 1
    assert feedback.count() == 0
    slider = page.locator(f"{STEPS} input[type=range]")
    page.locator(CURVES).first.wait_for(state="attached")  # they come with a frame
    lengths = "all => all.map(line => line.getAttribute('points').split(' ').length)"
    for key, seen in (("Home", 1), ("ArrowRight", 2), ("ArrowLeft", 2), ("End", 61)):
        slider.press(key)
        assert {*page.locator(CURVES).evaluate_all(lengths)} == {seen}
        assert table.is_visible() == (key == "End")
    assert page.locator("fieldset .wrong").nth(1).is_visible()
    assert not page.locator("#fig-l04-gains").is_visible()  # before the second question
    page.get_by_role("button", name="Show the rest, to 1.2 s").first.click()
    assert {*page.locator(CURVES).evaluate_all(lengths)} == {121}
    page.reload()
    assert page.locator("fieldset .wrong").nth(1).is_visible()
    assert table.is_visible()
    page.goto(f"{address}/index.html")
    page.get_by_role("button", name="Forget all").click()
    page.goto(f"{address}/{LECTURE}.html")
    assert not page.locator(f"{STEPS} dl").is_visible()
    context.close()


@pytest.mark.parametrize("name", PLAYING)
def test_play_is_on_the_first_screen_and_nothing_is_cut_off_or_collides(
    browser_3d, address, name
):
    """At each sample of each run of each replay of a page."""
    page = browser_3d.new_page(viewport={"width": 390, "height": 844})
    page.goto(f"{address}/{name}.html")
    for width, height in ((390, 844), (1280, 900)) if name in FIRST_SCREEN else ():
        page.set_viewport_size({"width": width, "height": height})
        page.evaluate(
            "document.fonts.ready.then(() => new Promise(requestAnimationFrame))"
        )
        play = page.locator(".replay .play").first.bounding_box()
        assert play["y"] + play["height"] < height
    show_all(page)
    page.emulate_media(
        reduced_motion="reduce"
    )  # the theme's menu would slide in after a change
    for width in (1280, 320):
        page.set_viewport_size({"width": width, "height": 800})
        assert call(page, "too_wide") == []
        assert page.evaluate(CROSSED) == []
    page.close()
