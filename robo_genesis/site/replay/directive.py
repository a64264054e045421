"""A recorded run that plays in the page, and the files that load only on a reader's request.

A page writes ```` ```{replay} l04/lecture ```` for the first replay that its lesson
declares, for another one its name as well: ```` ```{replay} l03/lecture slides ````.
The option `:brief:` leaves out all channels but the first, and the sentences on each
case. With `:blind:` the curves appear with the time that is played, and nothing shows
before the question above has an answer. `:first:` names the case that plays first, by
default the first one of the lesson. `:close-up:` offers a view that follows the link of
the curves and is this wide [m]. The panel of a recorded run also has a replay.
Poses and curves come from the record; the shape comes from the model, which the lecture
writes to a file.
"""

import base64
import gzip
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from docutils import nodes
from docutils.parsers.rst.directives import flag
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.util.docutils import SphinxDirective

from robo_genesis.core import project
from robo_genesis.core.channels import Run
from robo_genesis.core.files import derived, files_below, files_digest, write_whole
from robo_genesis.core.markup import filled
from robo_genesis.core.text import bullets
from robo_genesis.evidence import bundle
from robo_genesis.lessons import find_replay
from robo_genesis.pipeline.pages.page_index import page_bundle
from robo_genesis.pipeline.pages.sources import PACKAGE
from robo_genesis.sim import visual_shape
from robo_genesis.site.evidence.plain_nodes import html, image, on_request, scroll_box
from robo_genesis.site.evidence.runs import BACKEND
from robo_genesis.site.figures.case_labels import label, labels_of
from robo_genesis.site.pages import PageDirective
from robo_genesis.site.text.questions import question

from . import controls, viewer
from .recorded_runs import read_runs
from .scenery import Scenery, scenery, side_by_side
from .viewer import FOLDER, NOTICE, VIEWER, VIEWER_LICENCE

SHAPE_PAGE = "lecture"


class ReplayDirective(PageDirective):
    """Play the runs of a page's bundle of this build."""

    required_arguments = 1
    optional_arguments = 1
    option_spec = {  # noqa: RUF012 - as docutils declares it
        "brief": flag,
        "blind": flag,
        "first": str,
        "close-up": float,
    }

    def shown(self) -> list[nodes.Node]:
        """Return the replay."""
        given = self.options
        lesson_page, *chosen = self.arguments
        asked = next(self.state.document.findall(question), None)
        if (
            "blind" in given
            and asked is None
            and self.env.docname != self.config.root_doc
        ):
            raise LookupError(
                "`:blind:` needs a question above it, as `{choice}` or `{number}`."
            )
        key, folder = f"{lesson_page}/{BACKEND}", page_bundle(lesson_page)
        block = replay_block(
            self,
            key,
            folder,
            *chosen,
            brief="brief" in given,
            blind="blind" in given,
            first=given.get("first"),
            close_up=given.get("close-up"),
        )
        return [block]


def replay_block(
    directive: SphinxDirective,
    key: str,
    folder: Path,
    chosen: str = "",
    *,
    brief: bool = False,
    blind: bool = False,
    first: str | None = None,
    close_up: float | None = None,
) -> nodes.Node:
    """Return the replay of an accepted bundle, with all its information as text and as a table.

    Args:
        directive: the directive that shows it.
        key: names the run, as in the ledger.
        folder: of the bundle.
        chosen: name of the replay, empty for the first of the lesson.
        brief: whether to show the first channel alone, and no sentences on the cases.
        blind: whether nothing shows before the question above it has an answer.
        first: name of the case that plays first, None for the first of the replay.
        close_up: width of a view of the link that the curves follow [m], None for none.

    Raises:
        LookupError: the lesson has no such replay, or that no such case.
        ValueError: its runs cannot be played together, or no page of this build wrote
            the shape of these links.
    """
    env, lesson = directive.env, key.split("/")[0]
    name = f"replay/{key}/{chosen}".rstrip("/").replace("/", "-")
    replay = find_replay(lesson, chosen)
    runs = read_runs(folder, replay, labels_of(lesson))
    shape = shape_file(lesson, replay.thing)
    parts = visual_shape.load_shape(shape)
    if replay.places:
        runs, parts = side_by_side(runs, parts)
    if first:
        words = label(lesson, first)
        runs = replace(runs, traces={words: runs.traces[words], **runs.traces})
    around = scenery(parts, runs)
    if close_up:
        around = replace(around, near=runs.links.index(replay.follows))
    drawn = around, runs.links, runs.traces, replay.credit
    files, weight, still = leave_model(
        env, name, folder, shape, drawn, controls.alt(runs)
    )
    if close_up:
        files["close-up"] = around.camera.angle(close_up)
    shown, (curve, *_) = runs, runs.channels
    if brief:  # the model is the same
        shown = replace(runs, channels=[curve], levels=runs.levels_of(curve), moves={})
    opening = controls.opening("replay", files | controls.data(shown))
    samples = "all samples as a table"
    summary = f"Results and {samples}" if shown.moves else samples.capitalize()

    block = nodes.container(classes=["replay-block"], evidence_runs=(key,))
    if blind:
        on_home = env.docname == env.config.root_doc
        block["classes"] += ["growing"] if on_home else ["growing", "veiled"]
    block += html(opening)
    over = controls.over_the_picture("Play")
    block += stage(still, over, controls.caption(runs, around), f"{name}-model")
    fold = f"<details><summary>{summary}</summary>"
    block += html(controls.panel(name, shown, weight, blind) + fold)
    block += directive.parse_text_to_nodes(bullets(shown.moves.values()))
    table = directive.parse_text_to_nodes(controls.samples(shown))
    block += on_request(scroll_box(f"{summary}: {', '.join(runs.traces)}", *table))
    block += html(f"</details>{origin_html(name, folder, env, replay.credit)}")
    return block


def replay_folder(env: BuildEnvironment) -> str:
    """Return the address of the replays' files, as the page that is read names it."""
    return "../" * env.docname.count("/") + FOLDER


def leave_model(
    env: BuildEnvironment,
    name: str,
    folder: Path,
    shape: Path,
    drawn: tuple[Scenery, Sequence[str], Mapping[str, Run], str | None],
    alt: str,
) -> tuple[dict[str, str], int, nodes.image]:
    """Write a model for the page that is read, as GLB and as a classic script.

    A page that was opened from disk cannot fetch files, but it can add a script.

    Args:
        env: of the page.
        name: of the model.
        folder: of the bundle.
        shape: the file of the shape.
        drawn: what to draw, the links, the runs and the copyright; see `model.glb`.
        alt: text of the picture that it replaces.

    Returns:
        Name, addresses and camera of what loads on a reader's request, its compressed
        size [kB], and the still picture.
    """
    from .model import glb  # these load slowly
    from .poster import picture

    around, links, traces, credit = drawn
    camera = around.camera
    files = [shape, *files_below(folder), *files_below(project.ROOT / PACKAGE)]
    digest = files_digest(Path("/"), files)
    inputs = [repr((name, *links, *traces, around.near, credit, digest)).encode()]
    model = derived("replay", inputs, lambda: glb(*drawn))
    still = derived("poster", inputs, lambda: picture(model, camera))
    text = base64.b64encode(model).decode()
    script = f'(globalThis.replayModels ??= {{}})["{name}"] = "{text}";\n'.encode()
    site, up = Path(env.app.outdir) / FOLDER, replay_folder(env)
    write_whole(site / f"{name}.glb", model)
    write_whole(site / f"{name}.js", script)
    weight = round(
        sum(len(gzip.compress(of)) for of in (script, viewer.viewer())) / 1000
    )
    shown = image(env, f"{name}.webp", still, alt)
    shown["kind"], shown["classes"] = "model", ["still"]
    addresses = {"model": f"{up}/{name}.js", "viewer": f"{up}/{VIEWER}"}
    view = {"orbit": camera.orbit, "target": camera.target}
    return {"name": name} | addresses | view, weight, shown


def stage(picture: nodes.image, over: str, caption: str, anchor: str) -> nodes.figure:
    """Return a figure with some markup on top of its picture."""
    content = nodes.container("", picture, html(over), classes=["stage"])
    return nodes.figure("", content, nodes.caption("", caption), ids=[anchor])


def shape_file(lesson: str, thing: str) -> Path:
    """Return the file of the shape that a page of this build wrote.

    Raises:
        ValueError: there is no such file.
    """
    shape = page_bundle(f"{lesson}/{SHAPE_PAGE}") / visual_shape.FILE
    if not shape.is_file():
        raise ValueError(
            f"{lesson} wrote no shape of its {thing}. A cell of its {SHAPE_PAGE} must call "
            f"page.write_shape({lesson}.read_shape(entity)) after scene.build()."
        )
    return shape


def origin_html(
    name: str, folder: Path, env: BuildEnvironment, credit: str | None
) -> str:
    """Return the line that names the run and the origin of the shape.

    Args:
        name: of the replay.
        folder: of the bundle.
        env: of the page that shows it.
        credit: of the shape, None for shapes of the scene itself.
    """
    return filled(
        Path(__file__).with_name("origin.html"),
        name=name,
        run=bundle.read_manifest(folder),
        up=replay_folder(env),
        credit=credit,
        notice=NOTICE,
        licence=VIEWER_LICENCE,
    )


def setup(app: Sphinx) -> None:
    """Register the directive and the writing of the viewer."""
    app.add_directive("replay", ReplayDirective)
    app.connect("build-finished", viewer.write_viewer)
