"""The outputs of an executed page are those of its bundle; every edit of them is refused."""

import json
import re
import shutil
from copy import deepcopy
from pathlib import Path

import nbformat
import pytest
from bundles import written
from lessons.body_runs import make_drop
from lessons.changed_runs import passed
from nbformat.v4 import new_code_cell, new_notebook, new_output
from small_book import executed as run_pages
from tiny_book import LAB_FRONT, WRITE_BUNDLE, cell, make_book, notebook, raising

from robo_genesis.core import project, shown
from robo_genesis.core.experiment import Experiment
from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import write_json
from robo_genesis.evidence.reader import from_bundle
from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.lessons.l02 import spec
from robo_genesis.lessons.l02.pages import LAB
from robo_genesis.pipeline.pages.book import Page, find_pages
from robo_genesis.pipeline.pages.outputs import (
    outputs_of,
    require_printed,
    require_shown,
)
from robo_genesis.pipeline.pages.page_folder import executed_cells

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
SHOWN = (
    (),
    (TABLE, HEIGHT),
    (POSTURE,),
    (),
    ("robo_genesis.core.tables.checks_of_run",),
)


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
    write_json(folder / bundle.PRINTED, outputs_of(executed))
    return require_shown(page_of(*(sources or SOURCES)), executed, folder)


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
    where = f"lessons/lab, code cell 2, {TABLE}: the page shows another text/markdown"
    assert all(said in message for said in (where, "0.2011", "0.2500"))
    shows = table(executed)["data"]
    shows["text/markdown"] = shows["text/markdown"].replace("0.2011", "0.2500")
    assert check(executed, copy) == 4


def table(executed):
    return output(executed, 1, 0)


def test_a_page_that_shows_something_else_is_refused(executed, folder):
    shows, svg = output(executed, 1, 1)["data"], "image/svg+xml"
    drawn = shows[svg]
    shows[svg] = re.sub("(#DejaVuSans-)1", r"\g<1>2", drawn)
    assert f"another {svg}" in refusal(executed, folder)
    shows[svg] = drawn
    function = {"function": "robo_genesis.core.text.readable"}
    table(executed).metadata["robo_genesis"].update(function)
    assert "it cannot be called on the bundle" in refusal(executed, folder)


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
        ({1: DROP}, "0.20112 m", "it prints 0.20112 as"),
        ({2: DROP}, "0.2011 m", "prints the numbers 0.2011. Valid is `prints: {1: "),
        (DROP, "0.2011 m", "it has `prints: baseline.drop m`"),
        ({1: "baseline.drp m"}, "0.2011 m", "no metric 'baseline.drp'. Known: model."),
        (
            {1: "clear_of_ground:baseline.clearance_m kg"},
            "0.249",
            "in m, which cannot be shown in 'kg'. Valid is m or mm or µm",
        ),
        (
            {1: "baseline.drop kg"},
            "0.2011 m",
            "cannot be shown in 'kg'. Valid is m",
        ),
    ],
)
def test_a_number_that_a_cell_prints_is_the_value_that_its_option_names(
    folder, values, text, said
):
    page, ran = page_of("print()"), new_notebook(cells=[new_code_cell()])
    ran.cells[0].outputs = [new_output("stream", text=text)]
    page.notebook.cells[0].metadata["prints"] = values
    write_json(folder / bundle.PRINTED, outputs_of(ran))
    if said is None:
        assert require_shown(page, ran, folder) == 0
    else:
        with pytest.raises(
            BundleRefused, match=f"^shown: .*code cell 1: .*{re.escape(said)}"
        ):
            require_shown(page, ran, folder)


def test_an_error_names_no_folder_of_the_machine(monkeypatch):
    """IPython writes the home folder as `~` in the frames of an error."""
    home = Path(project.PACKAGES).parent
    monkeypatch.setenv("HOME", str(home))
    error = new_output("error", ename="E", evalue="")
    error.traceback = [f"File ~/{Path(project.PACKAGES).name}/genesis/a.py"]
    (kept,) = outputs_of(new_notebook(cells=[new_code_cell(outputs=[error])]))
    assert kept[0]["traceback"] == ["File site-packages/genesis/a.py"]


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
    ran = executed_cells(result.folder)
    for number, ran_cell in enumerate(ran.cells, start=1):
        for index, sound in enumerate(ran_cell.outputs):
            text = json.dumps(sound)
            where = f"lab, code cell {number}, output {index + 1}: the page shows"
            for digit in re.finditer(r"\d", text):
                other = "1234567898"[int(digit[0])]
                edited = text[: digit.start()] + other + text[digit.end() :]
                ran_cell.outputs[index] = nbformat.from_dict(json.loads(edited))
                with pytest.raises(BundleRefused, match=re.escape(where)):
                    require_printed("lab", ran, result.bundle)
            ran_cell.outputs[index] = sound
    require_printed("lab", ran, result.bundle)
    (result.bundle / bundle.PRINTED).unlink()
    with pytest.raises(BundleRefused, match=r"^missing-file: printed\.json"):
        require_printed("lab", ran, result.bundle)
