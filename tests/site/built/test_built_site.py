"""What a reader finds on the built pages."""

import json
import re
import subprocess
from pathlib import Path

import pytest
from built_site import LESSON_PAGES, MEASURING_PAGES

from robo_genesis.core import project
from robo_genesis.evidence.compare import read_side
from robo_genesis.evidence.rows import Side
from robo_genesis.lessons import find_lesson, find_page
from robo_genesis.pipeline import npm

pytestmark = pytest.mark.engine
PIN = project.engine_pin()
TESTS = Path(__file__).parents[2]
ANCHORS = [TESTS / "site" / "anchors.txt", *sorted(TESTS.glob("lessons/*/anchors.txt"))]
"""The anchors of each lesson's pages are a file beside the lesson's tests."""

PLACES = (
    "article section[id], article section > span[id], article p[id], article p > span[id], "
    "article figure[id], article dt[id]"
)
NUMBERED = re.compile(r"(id|note-)\d+$")

# In a drawing where a line of text begins, its scale, and where its last letter begins.
LINE = re.compile(
    r"translate\(([\d.]+) [\d.]+\) scale\(([\d.]+) -.*translate\(([\d.]+)", re.DOTALL
)
HALF = 30  # of a letter, in the units of the line


@pytest.mark.parametrize(
    ("lesson", "name"),
    [
        (le, name)
        for (le, page), name in LESSON_PAGES.items()
        if page in ("lecture", "motion", "lab")
    ],
)
def test_status_is_computed_and_leaves_missing_runs_out(parsed_pages, lesson, name):
    page = parsed_pages[name]
    line = page.select_one(".status-line > summary").get_text()
    assert line == f"Measured on CPU with Genesis {PIN}"
    status = page.select_one(".lesson-status").get_text()
    count = len(find_page(lesson, "lab").checks)
    assert f"cpu-verified Lab in a clean notebook kernel, Genesis {PIN}" in status
    assert f"{count} of {count} checks passed" in status
    assert "missing" not in status


def test_every_page_is_valid_html(site, tmp_path):
    """By the rules of the HTML standard, as html-validate knows them, at once for all pages."""
    settings = tmp_path / "settings.json"
    settings.write_text('{"root": true, "extends": ["html-validate:standard"]}')
    program = npm.packages() / "html-validate/bin/html-validate.mjs"
    command = [npm.node(), program, "--formatter", "json", "--config", settings]
    pages = sorted(site.parent.rglob("*.html"))

    def found(*files):
        done = subprocess.run(
            [*command, *files], capture_output=True, text=True, check=False
        )
        reports = json.loads(done.stdout)
        return {
            r["filePath"]: [(m["line"], m["message"]) for m in r["messages"]]
            for r in reports
        }

    spoiled = tmp_path / "spoiled.html"
    spoiled.write_text(
        pages[0].read_text("utf8").replace("</body>", "<ul><p>a</p></ul></body>")
    )
    assert "<p>" in found(spoiled)[str(spoiled)][0][1]
    assert found(*pages) == {}


def test_no_text_is_cut_off_at_the_edge_of_a_drawing(parsed_pages):
    room = []
    for name, page in parsed_pages.items():
        for line in page.select("svg.drawing g:has(> use)"):
            if place := LINE.search(str(line)):
                start, scale, last = map(float, place.groups())
                width = float(line.find_parent("svg")["viewbox"].split()[2])
                room.append((width - start - scale * (last + HALF), name))
    assert min(room) > (0,)


def test_published_anchors_stay_and_new_ones_are_kept_from_now_on(parsed_pages):
    """An anchor is that of a heading, figure or term, to which a reader may link.

    Recorded runs come and go with the machines that made them, so what is in their
    panels is none."""
    anchors = {
        f"{name}#{tag['id']}"
        for name, page in parsed_pages.items()
        if not name.startswith("evidence/")
        for tag in page.select(PLACES)
        if not NUMBERED.match(tag["id"])
        and not tag.find_parent(class_="evidence-panel")
    }
    published = {anchor for file in ANCHORS for anchor in file.read_text().split()}
    assert len(published) > 100
    gone = sorted(published - anchors)
    assert gone == [], (
        "Links elsewhere lead there: keep the old name as a target `(name)=` above."
    )
    title = parsed_pages["index"].select_one("article section[id]")[
        "id"
    ]  # each course has its own
    new = sorted(anchors - published - {f"index#{title}"})
    assert new == [], (
        "Add these lines to anchors.txt in tests/lessons/lNN or tests/site."
    )


def test_every_value_and_array_has_a_tolerance(site):
    """A run on another processor differs by its last digits."""
    bundles = [path.parent for path in sorted(site.parent.glob("*/**/manifest.json"))]
    assert len(bundles) >= len(MEASURING_PAGES)
    lacking = {bundle: without_tolerance(read_side(bundle)) for bundle in bundles}
    assert {bundle: names for bundle, names in lacking.items() if names} == {}


def without_tolerance(side: Side) -> list[str]:
    declared = find_lesson(side.manifest.lesson).spec.TOLERANCES.keys()
    units = {
        name: {metric.unit}
        for name, metric in side.numbers.items()
        if metric.kind == "value"
    }
    for case in side.arrays.cases.values():
        for name, array in case.variables.items():
            if array.dtype.startswith("float"):
                units[name] = (
                    {array.unit} if isinstance(array.unit, str) else {*array.unit}
                )
    return [
        n for n, of in units.items() if not (declared & n.split(".") or of <= declared)
    ]


def test_the_page_on_evidence_shows_a_measurement_and_leads_to_its_three_pages(
    parsed_pages,
):
    page = parsed_pages["evidence/index"]
    assert page.select(".measured")
    links = {a["href"] for a in page.select("article a[href]")}
    assert {"ledger.html", "trust.html", "recording.html"} <= links
