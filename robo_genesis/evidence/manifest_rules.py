"""Rules between the fields of a manifest, the name of its folder and the log."""

import re
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path

from robo_genesis.core import project
from robo_genesis.evidence.bundle import Manifest, Predicate, evidence_key
from robo_genesis.evidence.fields import LINE_LIMIT
from robo_genesis.evidence.refusals import AGAIN, BundleRefused, expect, unexpected
from robo_genesis.lessons import LESSONS
from robo_genesis.sim.backends import contradictions
from robo_genesis.sim.camera.frames import Renderer

MANIFEST = "manifest.json"
RELABEL = "Name the folder after the backend that computed."
TORCH = (
    "Use a Torch build for this backend, unset GS_TORCH_FORCE_CPU_DEVICE and QD_ARCH, and run the "
    "page again."
)
REINSTALL = "The installed engine was changed. Install it again from requirements.lock."

FORCED = ("GS_TORCH_FORCE_CPU_DEVICE", "QD_ARCH")
"""Switches that can make the engine and Torch use different devices."""

STATED = ("backend", "device", "engine version", "seed", "precision")
"""The facts that the log of the pinned version states: where it runs, and how it was started."""

BEGINNING = re.compile("^(?=(?:DEBUG|INFO|WARNING|ERROR|CRITICAL) )", re.MULTILINE)
MESSAGE = re.compile(r"(?:WARNING|ERROR|CRITICAL) (.*?)\n?\Z", re.DOTALL)
SOFTWARE_LINE = "Software rendering context detected"


def check_identity(
    manifest: Manifest, run_id: str | None, lesson: str | None, page: str | None
) -> None:
    """Require the given run, lesson and page, times in order, and the key of the other fields.

    Raises:
        BundleRefused: `run-id`, `lesson`, `time` or `key`.
    """
    predicate = manifest.predicate
    if run_id is not None:
        expect("run-id", MANIFEST, "run_id", predicate.run_id, run_id, "Execute the page again.")
    move = "Put the bundle into the folder of its own lesson."
    if lesson is not None:
        expect("lesson", MANIFEST, "lesson", predicate.lesson, lesson, move)
    elif predicate.lesson not in LESSONS:
        expect("lesson", MANIFEST, "lesson", predicate.lesson, " or ".join(LESSONS), move)
    if page is not None:
        expect("lesson", MANIFEST, "page", predicate.page, page, move)
    started, ended = predicate.started, predicate.ended
    try:
        if datetime.fromisoformat(started) > datetime.fromisoformat(ended):
            raise ValueError(f"ended is {ended}, before started, {started}")
    except ValueError as error:
        text = f"{error}, expected RFC 3339 times in order"
        raise BundleRefused("time", f"{MANIFEST}: {text}. {AGAIN}") from error
    key = evidence_key(predicate.model_dump())
    expect("key", MANIFEST, "evidence_key", predicate.evidence_key, key)


def check_circumstances(folder: Path, predicate: Predicate) -> None:
    """Require one backend, a matching Torch, switches that force no device, a true renderer.

    The backend names the folder. The files of the engine are those of its wheels.

    Raises:
        BundleRefused: `backend`; `torch`, also for a switch that forces a device; `environment` for
            a variable that is not a switch of the engine, and for a value that names a home folder;
            `render`; `engine-files`.
    """
    backend, render, switches = predicate.backend, predicate.render, predicate.environment
    expect("backend", MANIFEST, "backend.actual", backend.actual, folder.name, RELABEL)
    again = "The backend changed during the run. Run the page again."
    expect("backend", MANIFEST, "actual_at_end", backend.actual_at_end, backend.actual, again)
    if backend.requested == "cpu":
        expect("backend", MANIFEST, "actual where cpu was requested", backend.actual, "cpu")
    for what, found, expected in contradictions(backend):
        expect("torch", MANIFEST, what, found, expected, TORCH)
    forced = [name for name in FORCED if name in switches]
    expect("torch", MANIFEST, "list of set variables that must stay unset", forced, [], TORCH)
    others = sorted(switches.keys() - project.engine_switches(switches).keys())
    expect("environment", MANIFEST, "list of variables that are not engine switches", others, [])
    private = sorted(name for name, value in switches.items() if project.HOME_FOLDER.search(value))
    expect("environment", MANIFEST, "list of variables that name a home folder", private, [])
    named = render.vendor, render.renderer, render.software
    if render.mode == "camera":
        vendor, name = render.vendor or "a vendor", render.renderer or "a renderer"
        valid: tuple[object, ...] = (vendor, name, Renderer(vendor, name).software)
    else:
        valid = (None, None, None)
    what = f"vendor, renderer, software of mode {render.mode}"
    expect("render", MANIFEST, what, named, valid)
    match = predicate.engine.files_match_wheel
    expect("engine-files", MANIFEST, "engine.files_match_wheel", match, True, REINSTALL)


def check_log(folder: Path, manifest: Manifest, root: Path) -> None:
    """Require that the engine's own log states what the manifest says.

    The pinned version must state each fact; other versions write other lines.

    Raises:
        BundleRefused: `log`.
    """
    try:
        text = (folder / "log.txt").read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise BundleRefused("log", f"log.txt: {error}, expected UTF-8. {AGAIN}") from error
    longest = max(map(len, text.split("\n")))
    if longest > LINE_LIMIT:
        most = f"at most {LINE_LIMIT}"
        raise unexpected("log", "log.txt", "length of the longest line", longest, most)
    stated = set()
    for what, found, expected in _log_facts(text, manifest.predicate):
        expect("log", "log.txt", what, found, expected)
        stated.add(what)
    if manifest.predicate.engine.version == project.engine_pin(root):
        missing = [what for what in STATED if what not in stated]
        expect("log", "log.txt", "list of facts that the engine does not state", missing, [])


def _log_facts(text: str, predicate: Predicate) -> Iterator[tuple[str, object, object]]:
    """Yield (name, value in the log, value in the manifest) of each fact that the log states.

    Each line is searched from its start alone: the time grows with its length, not its square.
    """
    backend, engine = predicate.backend, predicate.engine
    yield "warnings", _warnings(text), predicate.warnings
    stated = {
        "engine version": engine.version,
        "seed": str(predicate.seed),
        "precision": engine.precision,
    }
    for line in text.split("\n"):
        device, _, name = line.partition("Running on [")[2].rpartition("] with backend ")
        if word := re.match(r"(?:gs\.)?(\w+)", name):
            yield "backend", word[1], backend.actual
            yield "device", device, backend.device_name
        start = line.partition("initialized.")[2]
        for what, expected in stated.items():
            found = start.rpartition(f"{what.split()[-1]}: ")
            if found[1] and (value := re.match(r"[^,\s]+", found[2])):
                yield what, value[0], expected
    if predicate.render.mode == "camera" and SOFTWARE_LINE in text:
        yield "software rendering", True, predicate.render.software


def _warnings(text: str) -> list[str]:
    """Return the messages of the log at WARNING or above; a message may have several lines."""
    messages = (MESSAGE.match(part) for part in BEGINNING.split(text))
    return [found[1] for found in messages if found]
