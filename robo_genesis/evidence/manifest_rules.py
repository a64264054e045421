"""Rules between the fields of a manifest, the name of its folder and the log."""

import re
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

from robo_genesis.core import project
from robo_genesis.evidence.bundle import (
    Manifest,
    Predicate,
    evidence_key,
    render_record,
)
from robo_genesis.evidence.fields import LINE_LIMIT
from robo_genesis.evidence.refusals import AGAIN, BundleRefused, expect, expect_equal
from robo_genesis.sim.backends import DRIVERS, FOREIGN, PROCESSOR, TAG, contradictions
from robo_genesis.sim.camera.frames import Renderer

MANIFEST = "manifest.json"
RELABEL = "Name the folder after the backend that computed."
TORCH = (
    "Use a Torch build for this backend, unset GS_TORCH_FORCE_CPU_DEVICE and QD_ARCH, and run the "
    "page again."
)
REINSTALL = (
    "A file of the installed engine differs from the published package. Install it again: "
    "pip install --force-reinstall -r requirements.lock."
)

# Switches that can make the engine and Torch use different devices.
FORCED = ("GS_TORCH_FORCE_CPU_DEVICE", "QD_ARCH")

# The facts that the log of the pinned version states: where it runs, and how it was
# started.
STATED = ("backend", "device", "engine version", "seed", "precision")

CLOCKS = timedelta(days=1)  # Allowed difference between the clocks of two machines

LEVELS = "WARNING|ERROR|CRITICAL"

# A message at WARNING or above, which may have several lines.
WARNING = re.compile(
    rf"^(?:{LEVELS}) (.*?)\n?(?=^(?:DEBUG|INFO|{LEVELS}) |\Z)", re.M | re.S
)

# The fact that the engine draws in software, and the line that states it for
# `llvmpipe`.
SOFTWARE, SOFTWARE_LINE = "software rendering", "Software rendering context detected"

# A line that may state a fact; in most of a log's lines, which may be millions, nothing
# does.
STATING = re.compile(r"^.*(?:Running on \[|initialized\.).*$", re.MULTILINE)


def check_identity(
    manifest: Manifest, run_id: str | None, lesson: str | None, page: str | None
) -> None:
    """Require the given run, lesson and page, times in order, and the key of the other fields.

    Raises:
        BundleRefused: `run-id`, `lesson`, `time` or `key`.
    """
    predicate = manifest.predicate
    if run_id is not None:
        expect(
            "run-id",
            MANIFEST,
            "run_id",
            predicate.run_id,
            run_id,
            "Execute the page again.",
        )
    move = "Put the bundle into the folder of its own lesson."
    if lesson is not None:
        expect("lesson", MANIFEST, "lesson", predicate.lesson, lesson, move)
    if page is not None:
        expect("lesson", MANIFEST, "page", predicate.page, page, move)
    try:
        started, ended = map(
            datetime.fromisoformat, (predicate.started, predicate.ended)
        )
        if not started <= ended <= datetime.now(UTC) + CLOCKS:
            raise ValueError(f"the run is from {started} to {ended}")
    except ValueError as error:
        text = f"{error}, expected RFC 3339 times in order, none in the future"
        raise BundleRefused("time", f"{MANIFEST}: {text}. {AGAIN}") from error
    key = evidence_key(predicate.model_dump())
    expect("key", MANIFEST, "evidence_key", predicate.evidence_key, key)


def check_circumstances(folder: Path, predicate: Predicate) -> None:
    """Require one backend, a machine and a Torch for it, true switches, a true renderer.

    The backend names the folder. The files of the engine are those of its wheels.

    Raises:
        BundleRefused: `backend`, also for a machine that cannot have it; `torch`, also
            for a switch that forces a device; `packages`; `environment` for a variable
            that is not a switch of the engine, and for a value that names a home
            folder; `render`; `engine-files`.
    """
    backend, render, switches = (
        predicate.backend,
        predicate.render,
        predicate.environment,
    )
    expect("backend", MANIFEST, "backend.actual", backend.actual, folder.name, RELABEL)
    again = "The backend changed during the run. Run the page again."
    expect(
        "backend",
        MANIFEST,
        "actual_at_end",
        backend.actual_at_end,
        backend.actual,
        again,
    )
    if backend.requested == "cpu":
        expect(
            "backend", MANIFEST, "actual where cpu was requested", backend.actual, "cpu"
        )
    for what, found, expected in contradictions(backend):
        expect("torch", MANIFEST, what, found, expected, TORCH)
    _check_machine(predicate)
    _check_packages(predicate)
    forced = [name for name in FORCED if name in switches]
    expect(
        "torch",
        MANIFEST,
        "list of set variables that must stay unset",
        forced,
        [],
        TORCH,
    )
    others = sorted(switches.keys() - project.engine_switches(switches).keys())
    expect(
        "environment",
        MANIFEST,
        "list of variables that are not engine switches",
        others,
        [],
    )
    private = sorted(
        name for name, value in switches.items() if project.HOME_FOLDER.search(value)
    )
    expect(
        "environment",
        MANIFEST,
        "list of variables that name a home folder",
        private,
        [],
    )
    drawn = Renderer(render.vendor or "a vendor", render.renderer or "a renderer")
    valid = render_record(drawn if render.mode == "camera" else None)
    expect_equal("render", MANIFEST, "render.{}", render.model_dump(), valid)
    match = predicate.engine.files_match_wheel
    expect("engine-files", MANIFEST, "engine.files_match_wheel", match, True, REINSTALL)


def _check_machine(predicate: Predicate) -> None:
    """Require a device and, for an accelerator, a driver of the backend."""
    backend, cpu, actual = (
        predicate.backend,
        predicate.host.cpu,
        predicate.backend.actual,
    )
    device, has_driver = backend.device_name, backend.driver is not None
    if actual == "cpu":
        expect("backend", MANIFEST, "backend.device_name", device, cpu)
    if actual in DRIVERS:
        words = rf"^{re.escape(cpu)}$|{PROCESSOR}|{FOREIGN[actual]}"
        what = f"list of words in device_name that no {actual} device has"
        expect("backend", MANIFEST, what, re.findall(words, device, re.IGNORECASE), [])
    expect(
        "backend", MANIFEST, "whether there is a driver", has_driver, actual in DRIVERS
    )


def _check_packages(predicate: Predicate) -> None:
    """Require that the installed versions are those that ran.

    Torch names its build; its package need not: on PyPI, `2.13.0` is 2.13.0+cu130.
    """
    engine, torch = predicate.engine, predicate.backend.torch_version
    ran = {
        project.ENGINE: engine.version,
        "quadrants": engine.quadrants_version,
        "torch": torch,
    }
    for package, version in ran.items():
        listed = predicate.host.packages.get(package, "none")
        valid = listed if _same_build(listed, version) else version
        expect(
            "packages",
            MANIFEST,
            f"version of {package} in host.packages",
            listed,
            valid,
        )


def _same_build(listed: str, ran: str) -> bool:
    tag = TAG.search(listed)
    return listed.partition("+")[0] == ran.partition("+")[0] and (
        not tag or tag[0] in ran
    )


def check_log(folder: Path, manifest: Manifest, root: Path) -> None:
    """Require that the engine's own log states what the manifest says.

    The pinned version must state each fact; other versions write other lines.

    Raises:
        BundleRefused: `log`.
    """
    try:
        text = (folder / "log.txt").read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise BundleRefused(
            "log", f"log.txt: {error}, expected UTF-8. {AGAIN}"
        ) from error
    long = [n for n in map(len, text.split("\n")) if n > LINE_LIMIT]
    expect(
        "log",
        "log.txt",
        f"list of lines with more than {LINE_LIMIT} characters",
        long,
        [],
    )
    predicate, stated = manifest.predicate, set()
    for what, found, expected in _log_facts(text, predicate):
        expect("log", "log.txt", what, found, expected)
        stated.add(what)
    if predicate.engine.version == project.engine_pin(root):
        needed = (
            (*STATED, SOFTWARE)
            if "llvmpipe" in str(predicate.render.renderer)
            else STATED
        )
        missing = [what for what in needed if what not in stated]
        expect(
            "log",
            "log.txt",
            "list of facts that the engine does not state",
            missing,
            [],
        )


def _log_facts(text: str, predicate: Predicate) -> Iterator[tuple[str, object, object]]:
    """Yield (name, value in the log, value in the manifest) of each fact that the log states.

    Each line is searched from its start alone: the time grows with its length, not its
        square.
    """
    backend, engine = predicate.backend, predicate.engine
    yield "warnings", WARNING.findall(text), predicate.warnings
    stated = {
        "engine version": engine.version,
        "seed": str(predicate.seed),
        "precision": engine.precision,
    }
    for line in STATING.findall(text):
        device, _, name = line.partition("Running on [")[2].rpartition(
            "] with backend "
        )
        if word := re.match(r"(?:gs\.)?(\w+)", name):
            yield "backend", word[1], backend.actual
            yield "device", device, backend.device_name
        start = line.partition("initialized.")[2]
        for what, expected in stated.items():
            found = start.rpartition(f"{what.split()[-1]}: ")
            if found[1] and (value := re.match(r"[^,\s]+", found[2])):
                yield what, value[0], expected
    if predicate.render.mode == "camera" and SOFTWARE_LINE in text:
        yield SOFTWARE, True, predicate.render.software
