"""Each measured figure on a page is what its cell draws from the arrays of the page's bundle."""

import nbformat
import pytest
from nbclient import NotebookClient

from robo_genesis.build.page_cache import PageCache, notebooks_folder, outputs_folder
from robo_genesis.core.project import BOOK, ROOT, page_cache_folder
from robo_genesis.lessons.book_pages import find_pages, fingerprint

pytestmark = pytest.mark.engine

FROM_BUNDLE = """
import matplotlib.pyplot as plt, numpy as np
from pathlib import Path
from PIL import Image
from robo_genesis import engines_compared, l04, l04_studies, plots, studies, study_plots
from robo_genesis.evidence import bundle, step_runs
from robo_genesis.evidence.trace_files import read_trace
from robo_genesis.sim.joints import JointMap
from robo_genesis.core.scene import JOINT_NAMES

plots.use_course_style()
folder = Path({folder!r})
arrays = bundle.read_arrays(folder)
everything = {{case: read_trace(folder, arrays, case) for case in arrays.cases}}
baseline, assigned = everything["baseline"], everything.get("assigned")
compared = {{case: everything[case] for case in ("G1", "G2", "G3")}}
traces = {{"baseline": baseline}}
camera = True
frames = {{n: np.array(Image.open(folder / "frames" / f"{{n}}.png")) for n in ("initial", "final")}}
joints = JointMap(JOINT_NAMES, l04.EXPECTED_TYPES, *[np.arange(9)] * 4)
entry = joints.entry(l04.STEPPED_JOINT)
found = step_runs.read_studies(folder, bundle.read_manifest(folder))
"""

FROM_DROPS = """
import matplotlib.pyplot as plt, numpy as np
from pathlib import Path
from PIL import Image
from robo_genesis import drop_plots, l02, plots, substep_study
from robo_genesis.lessons.l02.metrics import measure, predicted
from robo_genesis.evidence import bundle
from robo_genesis.evidence.trace_files import read_body_trace

plots.use_course_style()
folder = Path({folder!r})
arrays = bundle.read_arrays(folder)
traces = {{case: read_body_trace(folder, arrays, case) for case in arrays.cases}}
case, trace = l02.BASELINE, traces["baseline"]
camera = True
frames = {{n: np.array(Image.open(folder / "frames" / f"{{n}}.png")) for n in ("initial", "final")}}
cases = {{n: c for n, c in (l02.CASES | l02.SUBSTEP_CASES).items() if n in traces}}
study = substep_study.study(measure(traces, cases), cases)
"""

FROM_CONTACTS = """
import matplotlib.pyplot as plt, numpy as np
from pathlib import Path
from PIL import Image
from robo_genesis import contact_plots, contact_studies, contacts, drop_plots, energy, l03, plots
from robo_genesis.lessons.l03 import friction as sliding
from robo_genesis.lessons.l03.metrics import measure
from robo_genesis.evidence import bundle
from robo_genesis.evidence.trace_files import read_contact_trace

plots.use_course_style()
folder = Path({folder!r})
arrays, numbers = bundle.read_arrays(folder), bundle.read_metrics(folder)
traces = {{case: read_contact_trace(folder, arrays, case) for case in arrays.cases}}
case, trace = l03.BASELINE, traces["baseline"]
camera = True
frames = {{n: np.array(Image.open(folder / "frames" / f"{{n}}.png")) for n in ("initial", "final")}}
if folder.parent.name == "lab":
    slid, bounced = measure(traces, l03.SLIDES), measure(traces, l03.BOUNCES)
    coulomb = {{
        name: sliding.coulomb_distance(of.speed, max(of.friction, of.surface_friction))
        for name, of in l03.SLIDES.items()
    }}
    shown = {{n: l03.BOUNCES[n] for n in ("bounce_sub1", "bounce_sub2", "bounce_sub100")}}
    shares = {{l03.BOUNCES[name].h: of.first_kept for name, of in bounced.items()}}
    expected = 100 * energy.kept_at_bounces(l03.DROPPED_BALL.spring[1])
else:
    seconds = {{name: metric.value for name, metric in numbers["time_constant"].items()}}
    study = contact_studies.Studies(traces, measure(traces, l03.STUDY_CASES), seconds)
"""

SETUPS = {"l02": FROM_DROPS, "l03": FROM_CONTACTS, "l04": FROM_BUNDLE}

STUDIED = {"fig-l04-theory", "fig-l04-step-size", "fig-l04-convergence"}
"""Figures that are drawn when the page has all of its traces, not the baseline's alone."""

NOT_IN_BUNDLE = {"fig-l04-grid-overshoot", "fig-l04-grid-saturation", "fig-l04-film"}
"""Maps of the grid, whose runs the page holds as JSON and no bundle does, and the film: its cell
holds the filmed run to the recorded one."""


def name_of(cell) -> str:
    return cell.metadata["mystnb"]["figure"]["name"]


def redrawing(cell) -> str:
    return f"traces = everything\n{cell.source}" if name_of(cell) in STUDIED else cell.source


def svgs(cells) -> list[str]:
    outputs = [output for cell in cells for output in cell.get("outputs", [])]
    return [o["data"]["image/svg+xml"] for o in outputs if "image/svg+xml" in o.get("data", {})]


@pytest.mark.parametrize("name", ["lecture", "lab"])
@pytest.mark.parametrize("lesson", SETUPS)
def test_figures_are_drawn_from_the_bundle_s_arrays(build_output, monkeypatch, lesson, name):
    for variable, value in (("ROBO_GENESIS_RENDER", "1"), ("ROBO_GENESIS_BACKEND", "cpu")):
        monkeypatch.setenv(variable, value)
    pages = find_pages(BOOK)
    (page,) = (p for p in pages if (p.lesson, p.page) == (lesson, name))
    folder = page_cache_folder(fingerprint(pages, ROOT))
    cache = PageCache(notebooks_folder(folder))
    executed = cache.get_cache_bundle(cache.match_cache_notebook(page.notebook).pk).nb
    code = [cell for cell in page.notebook.cells if cell.cell_type == "code"]
    tagged = [
        (cell, ran)
        for cell, ran in zip(code, executed.cells, strict=True)
        if "figure" in cell.metadata.get("tags", []) and name_of(cell) not in NOT_IN_BUNDLE
    ]
    setup = SETUPS[lesson].format(folder=str(outputs_folder(folder) / lesson / name / "cpu"))
    sources = [setup, *(redrawing(cell) for cell, _ in tagged)]
    redrawn = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(s) for s in sources])
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    NotebookClient(redrawn, kernel_name="python3", timeout=120).execute()
    drawn = svgs([ran for _, ran in tagged])
    assert len(drawn) == len(tagged) >= 3
    assert svgs(redrawn.cells) == drawn
