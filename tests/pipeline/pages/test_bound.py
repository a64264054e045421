"""The outputs of an executed page are those of its bundle; every edit of them is refused."""

import json
import re
import shutil
from collections.abc import Iterable
from copy import deepcopy
from pathlib import Path

import nbformat
import pytest
from built_site import executed_pages
from bundles import written
from lessons.body_runs import make_drop
from lessons.changed_runs import passed
from nbformat.v4 import new_code_cell, new_notebook, new_output
from small_book import executed as run_pages
from tiny_book import LAB_FRONT, WRITE_BUNDLE, cell, make_book, notebook, raising

from robo_genesis.core import shown
from robo_genesis.core.experiment import Experiment
from robo_genesis.evidence import bundle
from robo_genesis.evidence.reader import from_bundle
from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.evidence.strict_json import write_json
from robo_genesis.lessons.l02 import spec
from robo_genesis.lessons.l02.pages import LAB
from robo_genesis.pipeline.pages.book import Page, find_pages
from robo_genesis.pipeline.pages.bound import (
    difference_of,
    require_printed,
    require_shown,
)
from robo_genesis.pipeline.pages.folder import NOTEBOOK, OUTPUTS, read_record
from robo_genesis.pipeline.pages.printed import outputs_of
from robo_genesis.pipeline.pages.results import find_bundle
from robo_genesis.pipeline.pages.store import exported_folders

TABLE, HEIGHT, POSTURE = (
    f"robo_genesis.lessons.l02.{name}"
    for name in ("text.metric_table", "plots.height", "plots.posture")
)
SOURCES = (
    "from robo_genesis.lessons.l02 import plots, text",
    "page.show(text.metric_table)\npage.show(plots.height)",
    "page.show(plots.posture)",
    "print('a number of no function')",
    "page.finish(scene)",
)
SHOWN = ((), (TABLE, HEIGHT), (POSTURE,), (), (shown.CHECKS,))


@pytest.fixture(scope="module")
def folder(tmp_path_factory, engine, frames) -> Path:
    """The bundle of L02's lab."""
    readings = {"model": spec.EXPECTED_MODEL, "body": {"mass": spec.BASELINE.mass}}
    readings |= passed(LAB)
    traces = {"baseline": make_drop(spec.BASELINE)}
    outputs = tmp_path_factory.mktemp("shown")
    run = Experiment(LAB, traces, [spec.LINK], readings, frames, True)
    return written(engine, outputs, "l02", "lab", run)


def page_of(*sources: str) -> Page:
    notebook = new_notebook(cells=[new_code_cell(source) for source in sources])
    return Page("lessons/lab", Path("lab.md"), notebook, "l02", "lab")


@pytest.fixture(scope="module")
def sound(folder):
    """The page as it was executed."""
    run = from_bundle(folder, bundle.read_manifest(folder), bundle.read_metrics(folder))

    def measured(name):
        about = shown.metadata(name, [])
        return new_output(
            "display_data", shown.mime_data(name, run, []), metadata=about
        )

    printed = new_output("stream", name="stdout", text="a line\n")
    outputs = ([printed, *map(measured, names)] for names in SHOWN)
    return new_notebook(cells=[new_code_cell(outputs=of) for of in outputs])


@pytest.fixture
def executed(sound):
    """A copy, to spoil."""
    return deepcopy(sound)


def check(executed, folder, *sources: str) -> int:
    """Compare a page that a careful editor has changed in the bundle, too."""
    manifest = bundle.read_manifest(folder)
    write_json(folder / bundle.PRINTED, outputs_of(executed))
    return require_shown(page_of(*(sources or SOURCES)), executed, folder, manifest)


def refusal(*given) -> str:
    with pytest.raises(BundleRefused) as caught:
        check(*given)
    assert caught.value.code == "shown"
    return str(caught.value)


def test_a_sound_page_is_accepted_and_its_measured_outputs_are_counted(
    executed, folder
):
    assert check(executed, folder) == 4


def output(executed, cell, number):
    """The output of a cell by its number after the printed line."""
    return executed.cells[cell].outputs[1 + number]


def test_the_accepted_metrics_are_shown_and_not_metrics_computed_here(
    executed, folder, tmp_path
):
    """Another processor computes the last digit otherwise."""
    copy = Path(shutil.copytree(folder, tmp_path / "l02" / "lab" / "cpu"))
    path = copy / "metrics.json"
    records = path.read_text()
    accepted = records.replace("0.201104998588562", "0.25")
    assert accepted != records
    path.write_text(accepted)
    message = refusal(executed, copy)
    assert (
        f"lessons/lab, code cell 2, {TABLE}: the page shows another text/markdown"
        in message
    )
    assert all(
        said in message for said in ("0.2011", "0.2500", "or the environment moved")
    )
    shows = table(executed)["data"]
    shows["text/markdown"] = shows["text/markdown"].replace("0.2011", "0.2500")
    assert check(executed, copy) == 4


def move(svg: str, by: float) -> str:
    """Move one point of the longest line."""
    path = max(re.findall(r'<path d="([^"]*)" clip-path', svg), key=len)
    number = re.search(r"L (\d+\.\d+) ", path)
    assert number
    moved = path.replace(number[0], f"L {float(number[1]) + by:.6f} ", 1)
    return svg.replace(path, moved, 1)


def other_picture(svg: str) -> str:
    """Change one letter in the middle of an embedded picture."""
    start = svg.index("base64,") + 4000
    letter = "A" if svg[start] != "A" else "B"
    return svg[:start] + letter + svg[start + 1 :]


def test_points_may_move_by_less_than_a_tenth_of_a_pixel_and_have_other_names(
    executed, folder
):
    data = output(executed, 1, 1)["data"]
    svg = data["image/svg+xml"] = move(data["image/svg+xml"], 0.09)
    name = re.search(r'clipPath id="(\w+)"', svg)[1]
    data["image/svg+xml"] = svg.replace(name, "another")
    assert check(executed, folder) == 4
    assert difference_of(svg.replace(f'id="{name}"', 'id="another"'), svg, True)


def table(executed):
    return output(executed, 1, 0)


def function(executed):
    return table(executed).metadata["robo_genesis"]


def redraw(cell, number, change):
    """Return a change of a drawing of the executed page."""
    return lambda ran: output(ran, cell, number)["data"].update(
        {SVG: change(output(ran, cell, number)["data"][SVG])}
    )


SVG, SHOW = "image/svg+xml", SOURCES[1]
OTHER_SVG = "the page shows another image/svg+xml than the bundle"


@pytest.mark.parametrize(
    ("source", "spoil", "said"),
    [
        (SHOW, redraw(1, 1, lambda svg: move(svg, 0.2)), OTHER_SVG),
        (
            SHOW,
            redraw(1, 1, lambda svg: re.sub("(#DejaVuSans-)1", r"\g<1>2", svg)),
            OTHER_SVG,
        ),
        (
            SHOW,
            redraw(1, 1, lambda svg: svg.replace("</svg>", "<script/></svg>")),
            OTHER_SVG,
        ),
        (SHOW, redraw(2, 0, other_picture), OTHER_SVG),
        (
            SHOW,
            lambda ran: table(ran).update(output_type="execute_result"),
            "type of the output",
        ),
        (
            SHOW,
            lambda ran: table(ran).metadata.clear(),
            "measured outputs is 1, expected 2",
        ),
        (
            SHOW,
            lambda ran: ran.cells[3].outputs.append(table(ran)),
            "code cell 4: number of meas",
        ),
        (
            SHOW,
            lambda ran: table(ran)["data"].update({"text/html": "0"}),
            "kinds of the output is",
        ),
        (
            SHOW,
            lambda ran: function(ran).update(function="os.system"),
            "{'function': 'os.system'",
        ),
        (
            SHOW,
            lambda ran: function(ran).update(arguments=["G1"]),
            "'arguments': ['G1']",
        ),
        (
            SHOW,
            lambda ran: table(ran).metadata.update(robo_genesis=7),
            "the output is of 7, exp",
        ),
        ("page.show(text.metric_table)", id, "measured outputs is 2, expected 1"),
        (
            "for k in (1, 2):\n    page.show(plots.height)",
            id,
            "outside of loops and conditions",
        ),
        (SHOW.replace("metric_table", "absent"), id, "text.absent)`. Write"),
        (SHOW.replace("metric_table", "metric_table, a"), id, "Write arguments out"),
        (
            SHOW.replace("metric_table", "metric_table, a=1"),
            id,
            "metric_table, a=1)`. Write",
        ),
        (
            SHOW.replace("text.metric_table", ""),
            id,
            "expected that of `page.show()`. Write",
        ),
        (
            SHOW.replace("metric_table", "readable"),  # it takes no experiment
            lambda ran: function(ran).update(
                function="robo_genesis.lessons.l02.text.readable"
            ),
            "it cannot be called on the bundle",
        ),
    ],
)
def test_a_page_that_shows_something_else_is_refused(
    executed, folder, source, spoil, said
):
    spoil(executed)
    assert said in refusal(executed, folder, SOURCES[0], source, *SOURCES[2:])


DROP = "baseline.drop m"


@pytest.mark.parametrize(
    ("values", "text", "said"),
    [
        ({1: DROP}, "[Genesis] 7.5\nby 0.2011 m, version 1.3.3", None),
        (
            {2: f"{DROP}m", 1: "clear_of_ground:baseline.clearance_m"},
            "0.249, +2.01105e2",
            None,
        ),
        (
            {2: DROP},
            "0.2011 m 0.2012",
            "prints 0.2012 as baseline.drop m, which is 0.201104999",
        ),
        ({1: DROP}, "-0.2011 m", "it prints -0.2011 as"),
        ({1: DROP}, "0.20112 m", "it prints 0.20112 as"),
        ({2: DROP}, "0.2011 m", "prints the numbers 0.2011. Valid is `prints: {1: "),
        (DROP, "0.2011 m", "it has `prints: baseline.drop m`"),
        ({1: "baseline.drp m"}, "0.2011 m", "no metric 'baseline.drp'. Known: model."),
        (
            {1: "baseline.drop kg"},
            "0.2011 m",
            "cannot be shown in 'kg'. Valid for a number is m",
        ),
    ],
)
def test_a_number_that_a_cell_prints_is_the_value_that_its_option_names(
    folder, values, text, said
):
    page, ran = page_of("print()"), only(new_output("stream", text=text))
    page.notebook.cells[0].metadata["prints"] = values
    write_json(folder / bundle.PRINTED, outputs_of(ran))
    if said is None:
        assert require_shown(page, ran, folder, bundle.read_manifest(folder)) == 0
    else:
        with pytest.raises(
            BundleRefused, match=f"^shown: .*code cell 1: .*{re.escape(said)}"
        ):
            require_shown(page, ran, folder, bundle.read_manifest(folder))


def unnoticed_edits(places: Iterable[Path]) -> list[str]:
    """Change digits of all outputs of executed pages, one at a time; return what is not refused.

    All digits of texts are changed, and 20 of each picture.

    Args:
        places: folders of executed pages, as `exported_folders` finds them in a store.
    """
    unnoticed = []
    for place in places:
        record, ran = read_record(place), nbformat.read(place / NOTEBOOK, as_version=4)
        folder = find_bundle(place / OUTPUTS, record.run_id)
        require_printed(record.docname, ran, folder)
        for number, ran_cell in enumerate(ran.cells, start=1):
            for index, sound in enumerate(ran_cell.outputs):
                text, kept = json.dumps(sound), outputs_of(only(sound))
                digits = [found.start() for found in re.finditer(r"\d", text)]
                step = max(1, len(digits) // 20) if "image/" in text else 1
                edits = [with_other_digit(text, at) for at in digits[::step]]
                where = f"{record.docname}, code cell {number}, output {index + 1} of its run"
                unnoticed += [
                    where for edited in edits if outputs_of(only(edited)) == kept
                ]
                for ran_cell.outputs[index] in edits[:1]:
                    with pytest.raises(BundleRefused, match=re.escape(where)):
                        require_printed(record.docname, ran, folder)
                ran_cell.outputs[index] = sound
    return unnoticed


def with_other_digit(text: str, at: int):
    """An output, from its JSON, with another digit at one place."""
    other = "1234567898"[int(text[at])]
    return json.loads(text[:at] + other + text[at + 1 :])


def only(output):
    """A notebook of one output; functions of nbformat would validate it each time."""
    return nbformat.from_dict({"cells": [{"cell_type": "code", "outputs": [output]}]})


PRINTS = """\
from IPython.display import SVG, Markdown, display
print("rises by 36.0 mm")
display(Markdown("| height |\\n| --- |\\n| 36.0 mm |"), metadata={"size": 7})
SVG("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 3 2'/>")"""


def test_each_digit_that_a_page_puts_out_is_compared_with_its_bundle(tmp_path):
    options = ":prints: {1: a.b mm}\n:tags: [figure]\n:mystnb: {image: {alt: A box}}\n"
    cells = cell(PRINTS, options), raising("1 / 0 + 25", "ZeroDivisionError: div")
    book = make_book(
        tmp_path, lab=notebook(cell(WRITE_BUNDLE), *cells, front=LAB_FRONT)
    )
    (result,) = run_pages(find_pages(book), tmp_path)
    found = exported_folders(tmp_path / "store")
    assert unnoticed_edits(found) == []
    assert found == [result.folder]
    (result.bundle / bundle.PRINTED).unlink()
    with pytest.raises(
        BundleRefused, match=r"^missing-file: printed\.json is not in cpu"
    ):
        unnoticed_edits(found)


@pytest.mark.engine
def test_each_digit_that_the_course_puts_out_is_compared_with_its_bundle():
    assert unnoticed_edits(executed_pages().folders.values()) == []
