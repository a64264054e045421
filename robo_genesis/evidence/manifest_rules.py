"""Rules between the fields of a manifest, the name of its folder and the log."""

import re
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path

from robo_genesis.core import project
from robo_genesis.core.refusals import AGAIN, BundleRefused, expect
from robo_genesis.evidence.bundle import Manifest, Predicate, evidence_key
from robo_genesis.lessons.registry import LESSONS
from robo_genesis.sim.session import Renderer

MANIFEST = "manifest.json"
RELABEL = "Name the folder after the backend that computed."
TORCH = (
    "Use a Torch build for this backend, unset GS_TORCH_FORCE_CPU_DEVICE and QD_ARCH, and run the "
    "page again."
)

FORCED = ("GS_TORCH_FORCE_CPU_DEVICE", "QD_ARCH")
"""Switches that can make the engine and Torch use different devices."""

AGREEMENT = {
    "cpu": (("x64", "arm64"), "cpu"),
    "cuda": (("cuda",), "cuda"),
    "amdgpu": (("amdgpu",), "cuda"),
    "metal": (("metal",), "mps"),
}
"""Actual backend → architectures of Quadrants, device of Torch. ROCm calls its device `cuda`."""

LEVELS = ("DEBUG", "INFO", "WARNING", "ERROR", "CRITICAL")
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


def check_backend(folder: Path, manifest: Manifest) -> None:
    """Require one backend, which names the folder, during the whole run, and a matching Torch.

    Only the build of Torch distinguishes ROCm from CUDA.

    Raises:
        BundleRefused: `backend` or `torch`.
    """
    backend = manifest.predicate.backend
    expect("backend", MANIFEST, "backend.actual", backend.actual, folder.name, RELABEL)
    again = "The backend changed during the run. Run the page again."
    expect("backend", MANIFEST, "actual_at_end", backend.actual_at_end, backend.actual, again)
    if backend.requested == "cpu":
        expect("backend", MANIFEST, "actual where cpu was requested", backend.actual, "cpu")
    archs, device = AGREEMENT[backend.actual]
    if backend.arch not in archs:
        expect("torch", MANIFEST, "backend.arch", backend.arch, archs, TORCH)
    expect("torch", MANIFEST, "backend.torch_device", backend.torch_device, device, TORCH)
    builds = (bool(backend.hip_version), bool(backend.cuda_version))
    needed = {"amdgpu": (True, False), "cuda": (False, True)}.get(backend.actual, builds)
    what = f"whether Torch has (HIP, CUDA) for {backend.actual}"
    expect("torch", MANIFEST, what, builds, needed, TORCH)


def check_environment(manifest: Manifest) -> None:
    """Require that the recorded variables are switches of the engine that force no device.

    Raises:
        BundleRefused: `torch` for a switch that forces a device; `environment` for a variable that
            is not a switch, and for a value that names a home folder.
    """
    found = manifest.predicate.environment
    forced = [name for name in FORCED if name in found]
    expect("torch", MANIFEST, "list of set variables that must stay unset", forced, [], TORCH)
    others = sorted(found.keys() - project.engine_switches(found).keys())
    expect("environment", MANIFEST, "list of variables that are not engine switches", others, [])
    private = sorted(name for name, value in found.items() if project.HOME_FOLDER.search(value))
    expect("environment", MANIFEST, "list of variables that name a home folder", private, [])


def check_engine_files(manifest: Manifest) -> None:
    """Require that the files of the engine are those of its wheels.

    Raises:
        BundleRefused: `engine-files`.
    """
    match = manifest.predicate.engine.files_match_wheel
    remedy = "The installed engine was changed. Install it again from requirements.lock."
    expect("engine-files", MANIFEST, "engine.files_match_wheel", match, True, remedy)


def check_render(manifest: Manifest) -> None:
    """Require that mode, vendor, name of the renderer and software flag agree.

    Raises:
        BundleRefused: `render`.
    """
    render = manifest.predicate.render
    found = (render.vendor, render.renderer, render.software)
    expected: tuple[object, ...] = (None, None, None)
    if render.mode == "camera":
        vendor = "a vendor" if render.vendor is None else render.vendor
        name = "a renderer" if render.renderer is None else render.renderer
        expected = (vendor, name, Renderer(vendor, name).software)
    what = f"vendor, renderer, software of mode {render.mode}"
    expect("render", MANIFEST, what, found, expected)


def check_log(folder: Path, manifest: Manifest) -> None:
    """Require that the engine's own log does not contradict the manifest.

    A line may be missing, because engine versions write different lines.

    Raises:
        BundleRefused: `log`.
    """
    try:
        text = (folder / "log.txt").read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise BundleRefused("log", f"log.txt: {error}, expected UTF-8. {AGAIN}") from error
    for what, found, expected in _log_facts(text, manifest.predicate):
        expect("log", "log.txt", what, found, expected)


def _log_facts(text: str, predicate: Predicate) -> Iterator[tuple[str, object, object]]:
    """Yield (name, value in the log, value in the manifest) of each fact that the log states."""
    backend, engine = predicate.backend, predicate.engine
    yield "warnings", _warnings(text), predicate.warnings
    for device, name in re.findall(r"Running on \[(.*)\] with backend (?:gs\.)?(\w+)", text):
        yield "backend", name, backend.actual
        yield "device", device, backend.device_name
    for what, pattern, expected in (
        ("engine version", r"initialized\..*version: ([^,\s]+)", engine.version),
        ("seed", r"initialized\..*seed: ([^,\s]+)", str(predicate.seed)),
        ("precision", r"initialized\..*precision: ([^,\s]+)", engine.precision),
    ):
        yield from ((what, found, expected) for found in re.findall(pattern, text))
    if SOFTWARE_LINE in text and predicate.render.mode == "camera":
        yield "software rendering", True, predicate.render.software


def _warnings(text: str) -> list[str]:
    """Return the messages of the log at WARNING or above; a message may have several lines."""
    messages: list[tuple[str, str]] = []
    for line in text.removesuffix("\n").split("\n"):
        level, _, rest = line.partition(" ")
        if level in LEVELS:
            messages.append((level, rest))
        elif messages:
            messages[-1] = (messages[-1][0], f"{messages[-1][1]}\n{line}")
    return [rest for level, rest in messages if level not in ("DEBUG", "INFO")]
