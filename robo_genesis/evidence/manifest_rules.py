"""What a manifest may not claim: rules between its own fields, its folder's name and the log."""

import re
from datetime import datetime
from pathlib import Path

from robo_genesis.core import project
from robo_genesis.core.refusals import AGAIN, BundleRefused, expect
from robo_genesis.evidence.bundle import BackendRecord, Manifest, Predicate, evidence_key
from robo_genesis.lessons.registry import LESSONS
from robo_genesis.sim.session import Renderer

MANIFEST = "manifest.json"
RELABEL = "File it under the backend that computed; nothing is relabelled."
TORCH = (
    "Use a Torch build for this backend, unset GS_TORCH_FORCE_CPU_DEVICE and QD_ARCH, run again."
)

FORCED = ("GS_TORCH_FORCE_CPU_DEVICE", "QD_ARCH")
"""Switches that can send engine and Torch to different devices."""

AGREEMENT = {
    "cpu": (("x64", "arm64"), "cpu"),
    "cuda": (("cuda",), "cuda"),
    "amdgpu": (("amdgpu",), "cuda"),
    "metal": (("metal",), "mps"),
}
"""Actual backend → Quadrants' architectures, Torch's device. ROCm calls its device cuda, too."""

LEVELS = ("DEBUG", "INFO", "WARNING", "ERROR", "CRITICAL")
SOFTWARE_LINE = "Software rendering context detected"


def check_identity(
    manifest: Manifest, run_id: str | None, lesson: str | None, page: str | None
) -> None:
    """Require lesson, page and run where they are known, times in order, and a key of its own.

    Raises:
        BundleRefused: `run-id`, `lesson`, `time` or `key`.
    """
    predicate = manifest.predicate
    if run_id is not None:
        expect("run-id", MANIFEST, "run_id", predicate.run_id, run_id, "Execute the page again.")
    mend = "File it under its own lesson."
    if lesson is not None:
        expect("lesson", MANIFEST, "lesson", predicate.lesson, lesson, mend)
    elif predicate.lesson not in LESSONS:
        expect("lesson", MANIFEST, "lesson", predicate.lesson, " or ".join(LESSONS), mend)
    if page is not None:
        expect("lesson", MANIFEST, "page", predicate.page, page, mend)
    try:
        ordered = _moment(predicate.started) <= _moment(predicate.ended)
    except ValueError as error:
        raise BundleRefused("time", f"{MANIFEST}: {error}, expected RFC 3339. {AGAIN}") from error
    if not ordered:
        raise BundleRefused(
            "time",
            f"{MANIFEST}: ended is {predicate.ended}, expected after started, "
            f"{predicate.started}. {AGAIN}",
        )
    key = evidence_key(predicate.model_dump())
    expect("key", MANIFEST, "evidence_key", predicate.evidence_key, key)


def _moment(text: str) -> datetime:
    return datetime.fromisoformat(text)


def check_backend(folder: Path, manifest: Manifest) -> None:
    """Require one backend from the folder's name to the end of the run, and a Torch that fits.

    Raises:
        BundleRefused: `backend` or `torch`.
    """
    backend = manifest.predicate.backend
    expect("backend", MANIFEST, "backend.actual", backend.actual, folder.name, RELABEL)
    again = "The backend changed during the run: run again."
    expect("backend", MANIFEST, "actual_at_end", backend.actual_at_end, backend.actual, again)
    if backend.requested == "cpu":
        expect("backend", MANIFEST, "actual where cpu was requested", backend.actual, "cpu")
    archs, device = AGREEMENT[backend.actual]
    if backend.arch not in archs:
        expect("torch", MANIFEST, "backend.arch", backend.arch, " or ".join(archs), TORCH)
    expect("torch", MANIFEST, "backend.torch_device", backend.torch_device, device, TORCH)
    _check_torch_build(backend)


def _check_torch_build(backend: BackendRecord) -> None:
    """ROCm and CUDA are told apart by what Torch was built with, and by nothing else."""
    built = {"HIP": bool(backend.hip_version), "CUDA": bool(backend.cuda_version)}
    needed = {
        "amdgpu": {"HIP": True, "CUDA": False},
        "cuda": {"HIP": False, "CUDA": True},
    }.get(backend.actual, {})
    for name, expected in needed.items():
        what = f"whether Torch has {name} for {backend.actual}"
        expect("torch", MANIFEST, what, built[name], expected, TORCH)


def check_environment(manifest: Manifest) -> None:
    """Require that the variables named are the engine's switches, none of which forces a device.

    Raises:
        BundleRefused: `torch` for one that does; `environment` for any other variable, and for a
            value that names somebody's home folder.
    """
    found = manifest.predicate.environment
    forced = [name for name in FORCED if name in found]
    expect("torch", MANIFEST, "list of set variables that must stay unset", forced, [], TORCH)
    others = sorted(found.keys() - project.engine_switches(found).keys())
    expect("environment", MANIFEST, "list of variables that switch no engine", others, [])
    private = sorted(name for name, value in found.items() if project.HOME_FOLDER.search(value))
    expect("environment", MANIFEST, "list of variables that name a home folder", private, [])


def check_engine_files(manifest: Manifest) -> None:
    """Require that the engine was the one that its wheels installed.

    Raises:
        BundleRefused: `engine-files`.
    """
    expect(
        "engine-files", MANIFEST, "engine.files_match_wheel",
        manifest.predicate.engine.files_match_wheel, True,
        "The installed engine was changed: install it anew from requirements.lock.",
    )  # fmt: skip


def check_render(manifest: Manifest) -> None:
    """Require that the renderer's name and the flag for software say the same.

    Raises:
        BundleRefused: `render`.
    """
    render = manifest.predicate.render
    facts = (render.vendor, render.renderer, render.software)
    if render.mode == "skip":
        expect("render", MANIFEST, "vendor, renderer, software of mode skip", facts, (None,) * 3)
        return
    if render.vendor is None or render.renderer is None:
        expect("render", MANIFEST, "vendor and renderer of mode camera", facts[:2], "their names")
        return
    software = Renderer(render.vendor, render.renderer).software
    what = f"render.software with {render.renderer}"
    expect("render", MANIFEST, what, render.software, software)


def check_log(folder: Path, manifest: Manifest) -> None:
    """Require that the engine's own log says nothing else than the manifest.

    Lines that an engine version does not write are not asked for.

    Raises:
        BundleRefused: `log`.
    """
    try:
        text = (folder / "log.txt").read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise BundleRefused("log", f"log.txt: {error}, expected UTF-8. {AGAIN}") from error
    predicate = manifest.predicate
    for what, found, expected in _contradictions(text, predicate):
        expect("log", "log.txt", what, found, expected)
    if SOFTWARE_LINE in text and predicate.render.mode == "camera":
        expect("log", "log.txt", "software rendering", True, predicate.render.software)


def _contradictions(text: str, predicate: Predicate) -> list[tuple[str, object, object]]:
    """Return (what, what the log says, what the manifest says) of all that both name."""
    backend, engine = predicate.backend, predicate.engine
    pairs: list[tuple[str, object, object]] = [("warnings", _warnings(text), predicate.warnings)]
    for device, name in re.findall(r"Running on \[(.*)\] with backend (?:gs\.)?(\w+)", text):
        pairs += [("backend", name, backend.actual), ("device", device, backend.device_name)]
    for what, pattern, expected in (
        ("engine version", r"initialized\..*version: ([^,\s]+)", engine.version),
        ("seed", r"initialized\..*seed: ([^,\s]+)", str(predicate.seed)),
        ("precision", r"initialized\..*precision: ([^,\s]+)", engine.precision),
    ):
        pairs += [(what, found, expected) for found in re.findall(pattern, text)]
    return pairs


def _warnings(text: str) -> list[str]:
    """Return the log's messages at WARNING or above; one message may have several lines."""
    messages: list[tuple[str, str]] = []
    for line in text.removesuffix("\n").split("\n"):
        level, _, rest = line.partition(" ")
        if level in LEVELS:
            messages.append((level, rest))
        elif messages:
            messages[-1] = (messages[-1][0], f"{messages[-1][1]}\n{line}")
    return [rest for level, rest in messages if level not in ("DEBUG", "INFO")]
