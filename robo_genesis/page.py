"""The page of a lesson while it runs: it measures, shows, checks and writes its bundle.

A page calls `gs.init` itself; `open_page` follows it:

    gs.init(backend=rg.backend(), seed=rg.SEED, precision=rg.PRECISION,
            use_deterministic_algorithms=True, **rg.PLAIN_LOG)
    page = rg.open_page("l02", "lab")
"""

import os
import re
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from IPython import get_ipython
from IPython.display import Markdown, display
from matplotlib.figure import Figure

import __main__
from robo_genesis.core import checks, plotting, shown, tables
from robo_genesis.core.checks import Check, CheckFailed
from robo_genesis.core.exercises import FUNCTIONS, FunctionFailed, Written, refused
from robo_genesis.core.experiment import Experiment
from robo_genesis.core.files import put
from robo_genesis.core.project import RUN_ID, cache_folders, nothing_compiled
from robo_genesis.evidence.bundle import read_manifest
from robo_genesis.evidence.recorder import Recorder, RecordError
from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.lessons import find_page
from robo_genesis.pipeline.pages import sources
from robo_genesis.sim import session
from robo_genesis.sim.camera import frames as cameras
from robo_genesis.sim.visual_shape import Part

# What a reader's own notebook prints; a page that a command executes does not.
FIRST_START = """\
First start on this machine: the engine compiles its kernels, most of them without output.
Step 1 of 3: the scene, and the first run. This is the compilation: minutes; later, seconds.
Step 2 of 3: the other runs, of {count} in all.
Step 3 of 3: checks, figures and the bundle."""

_opened: list[str] = []


def backend() -> Any:
    """Return the argument `backend` of the `gs.init` that follows, and start to keep its log.

    It is `gs.cpu`, and `gs.gpu` where ROBO_GENESIS_BACKEND is `auto`.

    Raises:
        ContractError: a variable of the contract is not valid.
        EngineError: Genesis is missing or already initialised.
    """
    return session.requested_backend(session.read_contract())


def open_page(lesson: str, name: str) -> "LessonPage":
    """Start the record of a page, after `gs.init`.

    Raises:
        LookupError: the lesson or the page does not exist; the message lists the
            choices.
        ContractError: a variable of the contract is not valid.
        EngineError: a page is open already, Genesis is not initialised, or it was
            initialised with another backend, seed or precision.
    """
    declared = find_page(lesson, name)
    if _opened:
        raise session.EngineError(
            f"The page {_opened[0]} is open in this process, and a process has one page. Restart "
            "the kernel and run all cells from the top."
        )
    contract = session.read_contract()
    contract = replace(contract, render=contract.render and declared.camera)
    page = LessonPage(lesson, name, contract, session.started(contract))
    _opened.append(f"{lesson}/{name}")
    plotting.use_course_style()
    if RUN_ID not in os.environ:
        if shell := get_ipython():
            short = NotImplementedError, CheckFailed, RecordError, session.EngineError
            shell.set_custom_exc(short, without_frames)
            shell.events.register("pre_run_cell", page.begin)
            shell.events.register("post_run_cell", page.go_on)
        if nothing_compiled(cache_folders()):
            print(FIRST_START.format(count=len(declared.runs)))
    return page


def without_frames(shell: Any, kind: type, error: Any, trace: Any, **_: Any) -> None:
    """Show the message of an error alone."""
    shell.showtraceback((FunctionFailed, FunctionFailed(str(error)), trace))


class LessonPage:
    """One page of a lesson with everything that it measured so far.

    | attribute | meaning |
    |---|---|
    | `traces` | runs by name |
    | `readings` | values of the engine by group and name |
    | `frames` | camera frames by name |
    | `joints` | the `JointMap` of the arrays' DOFs, None for free bodies |
    | `links` | names of the links, in the order of the arrays |
    | `render` | whether the environment requests a camera and the page declares one |
    | `log` | the engine's log |
    """

    def __init__(
        self, lesson: str, name: str, contract: session.Contract, engine: session.Engine
    ) -> None:
        self._declared = find_page(lesson, name)
        self._recorder = Recorder(
            lesson, name, contract, engine, sources.running_modules(lesson)
        )
        self._lesson, self.log = lesson, engine.log
        self.render = contract.render
        self.traces: dict[str, Any] = {}
        self.readings: dict[str, Mapping[str, float]] = {}
        self.frames: dict[str, np.ndarray] = {}
        self.joints: Any = None
        self._shape: Sequence[Part] = ()
        self.links: Sequence[str] = list(self._declared.links)
        names = getattr(self._declared.readings.get(FUNCTIONS), "units", ())
        self._written = dict.fromkeys(names, 0)
        self._errors: dict[str, str] = {}

    @property
    def experiment(self) -> Experiment:
        """The experiment with what was measured so far."""
        return Experiment(
            page=self._declared,
            traces={
                name: self.traces[name]
                for name in self._declared.runs
                if name in self.traces
            },
            links=self.links,
            readings=self.readings
            | ({FUNCTIONS: self._written} if self._written else {}),
            frames=dict(self.frames),
            rendered=self.render,
            joints=self.joints,
        )

    def facts(self) -> Markdown:
        """Return a table of engine, backend, rendering and folder of this run."""
        return table(self._recorder.facts())

    def capture(self, camera: Any, name: str) -> None:
        """Render a frame and keep it by its name; without a camera nothing happens.

        Raises:
            FrameError: the frame is not usable.
        """
        if self.render:
            self.frames[name] = cameras.capture(camera)

    def write_shape(self, parts: Sequence[Part]) -> None:
        """Keep the geometry that the page's replay draws; `finish` writes it to the bundle."""
        self._shape = parts

    def show(self, function: Callable[..., Any], *arguments: Any) -> None:
        """Show a measured table, text or figure: a function of the experiment.

        The build calls the function again, on the experiment that it reads from the
        bundle. So the result must depend on nothing else, and not on runs that are
        recorded after this call.

        Args:
            function: at the top level of a module of the lesson or of `core`. Its first
                argument is the experiment; it returns Markdown or a Matplotlib figure.
            arguments: its further arguments, JSON values, written out in the call.

        Raises:
            ShownError: function or result are not of this kind.
        """
        name = shown.name_of(function)
        metadata = shown.metadata(name, arguments)
        display(
            shown.mime_data(name, self.experiment, arguments),
            metadata=metadata,
            raw=True,
        )

    def require(self, what: str, **seen: object) -> None:
        """Print that all values are true: what the cells of a page saw, beside its checks.

        Raises:
            CheckFailed: naming every value that is not true.
        """
        found = [Check(name, bool(value), str(value)) for name, value in seen.items()]
        print(checks.require(f"{self._lesson} {what}", found))

    def test(self, test: Callable[..., Check], function: Written, *given: Any) -> None:
        """Test a function that a student wrote, and print that it passed; `finish` counts it.

        Args:
            test: of the lesson's `exercises`.
            function: has one of the names that the page declares.
            given: further arguments of the test.

        Raises:
            LookupError: the page does not declare the function.
            FunctionFailed: naming the call, what it returned, and the line if it
                raised.
        """
        name = function.__name__
        if name not in self._written:
            raise LookupError(
                f"{name} is not declared. Functions: {', '.join(self._written)}."
            )
        outcome = test(function, *given)
        self._written[name] = int(outcome.passed)
        if not outcome.passed:
            raise FunctionFailed(
                f"{name} does not pass its test yet.\n  {outcome.detail}"
            )
        print(f"{name} passes its test")

    def begin(self, cell: Any) -> None:
        """Forget the error that a cell had when it ran before."""
        self._errors.pop(cell.cell_id, None)

    def go_on(self, result: Any) -> None:
        """Let the next cells run after an error, and say what its cell needs.

        Jupyter would skip the cells that wait, and the reader would see neither the error
        nor a verdict. A second `gs.init` fails too, and the first one still holds.

        Args:
            result: of a cell, by IPython; it loses its error.
        """
        error, cell = result.error_before_exec or result.error_in_exec, result.info
        if not isinstance(error, Exception):
            return
        result.error_before_exec = result.error_in_exec = None
        if isinstance(error, session.EngineError) and "gs.init(" in cell.raw_cell:
            return
        self._errors[cell.cell_id] = f"[{result.execution_count}]"
        for name in self._written:
            # Such a cell has not defined it, and the older one must not count.
            if isinstance(error, SyntaxError) and f"def {name}(" in cell.raw_cell:
                self._written[name] = 0
                vars(__main__).pop(name, None)
        missing = self._missing
        used = [n for n in missing if re.search(rf"\b{n}\b", cell.raw_cell)]
        if used and not isinstance(error, NameError | AttributeError):
            print(f"No passed test yet: {', '.join(used)}.")
        elif missing:
            print("Begin with the first cell that has an error.")

    @property
    def _missing(self) -> list[str]:
        return [name for name, passed in self._written.items() if not passed]

    def finish(self, scene: Any) -> None:
        """Measure, write the bundle, print the verdict, and show the table of checks.

        The verdict is `PASSED` if all checks passed. Where nothing but functions is
        missing, it is `INCOMPLETE` and names them. An earlier bundle that passed is kept
        beside one that does not.

        Args:
            scene: the scene with the camera; only its renderer is read.

        Raises:
            CheckFailed: naming every check that failed, with what it found.
        """
        experiment, folder = self.experiment, self._recorder.folder
        outcomes = experiment.outcomes()
        with suppress(BundleRefused):  # there is none
            earlier = read_manifest(folder).checks
            old, new = (all(c.passed for c in of) for of in (earlier, outcomes))
            if old > new:
                put(folder, folder.with_name(f"{folder.name}-passed"))
                print(f"{folder.name}-passed keeps the earlier bundle, which passed.")
        renderer = cameras.read_renderer(scene) if self.render else None
        self._recorder.write(experiment, renderer, self._shape)
        print(f"The bundle is in {'/'.join(folder.parts[-4:])}.")
        if self._errors:
            print("Cells with an error:", *self._errors.values())
        missing = self._missing
        if count := len(self._written):
            print(f"functions {count - len(missing)} of {count}")
        measured = [c for c in outcomes if not missing or c.name != FUNCTIONS]
        failed = refused(partial(checks.require, self._lesson, measured))
        verdict = (
            f"INCOMPLETE, not passed: {', '.join(missing)}" if missing else "PASSED"
        )
        print(failed or f"{self._lesson.upper()} CHECK: {verdict}")
        self.show(tables.checks_of_run)
        if failed:
            raise failed


def curves(
    drawn: Mapping[str, tuple[Any, Any]], quantity: str, axis: str = "time [s]"
) -> Figure:
    """Return a figure of one curve or two for the end of a cell; the build does not compare it.

    Args:
        drawn: by label, two arrays (n,): what is drawn to the right, and the quantity.
        quantity: what is drawn upwards, with its unit.
        axis: what is drawn to the right, with its unit.
    """
    figure, ax = plotting.axes(2.9)
    for (label, (x, y)), mark in zip(
        drawn.items(), ("other", "baseline"), strict=False
    ):
        ax.plot(x, y, label=label, **plotting.look(mark))
    ax.margins(x=0.01)
    plotting.finish(ax, "", quantity, "best")
    ax.set_xlabel(axis)
    return figure


def table(rows: Sequence[Mapping[str, Any]]) -> Markdown:
    """Return rows as a table for the end of a cell; the build does not compare it."""
    return Markdown(tables.markdown(rows))
