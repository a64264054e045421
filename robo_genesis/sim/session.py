"""The environment contract, and the one `gs.init` of a process with its backend."""

import ctypes
import importlib
import inspect
import logging
import os
import re
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from robo_genesis.core import project
from robo_genesis.core.project import BACKEND, OUTPUTS_DIR, RENDER
from robo_genesis.core.scene import SEED

from .backends import contradictions
from .engine_log import EngineLog, remove_private_paths

# Valid values of the variables of the contract; the first is the default.
CHOICES = {BACKEND: ("cpu", "auto"), RENDER: ("1", "0")}

LIBRARIES = ("libGL.so.1", "libEGL.so.1")  # What the engine needs even without a camera

PRECISION = "32"

# Of each `gs.init` of the course, beside backend and log.
ARGUMENTS = {"seed": SEED, "precision": PRECISION, "use_deterministic_algorithms": True}

PLATFORM_DEVICE = 0x313F  # Of EGL: without a window system


class ContractError(ValueError):
    """An environment variable of the contract has a value outside its choices."""


class CaseError(ValueError):
    """A case is not valid, or its scene is another one; the message says what is valid."""


class EngineError(RuntimeError):
    """The engine is missing or incomplete, is started twice, or contradicts itself."""


@dataclass(frozen=True, slots=True)
class Contract:
    """The settings that the environment gives a page: backend, camera or none, output folder."""

    backend: str
    render: bool
    outputs: Path


def read_contract(environ: Mapping[str, str] | None = None) -> Contract:
    """Read ROBO_GENESIS_BACKEND (auto|cpu), ROBO_GENESIS_RENDER (0|1) and ROBO_GENESIS_OUTPUTS_DIR.

    Unset means cpu, 1 and `outputs` in the working directory.

    It raises ContractError with the variable, its value and the choices.
    """
    environ = os.environ if environ is None else environ
    values = {name: environ.get(name, choices[0]) for name, choices in CHOICES.items()}
    for name, value in values.items():
        if value not in CHOICES[name]:
            choices = ", ".join(sorted(CHOICES[name]))
            raise ContractError(
                f"{name}={value!r} is not valid. Choose one of: {choices}."
            )
    outputs = Path(environ.get(OUTPUTS_DIR) or "outputs").resolve()
    require_writable(OUTPUTS_DIR, outputs)
    backend, render = values.values()
    return Contract(backend, render == "1", outputs)


def require_writable(variable: str, folder: Path) -> None:
    """Raise ContractError unless the folder of a variable can be made and takes a file of 1 MB."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder) as file:
            file.write(bytes(2**20))
    except OSError as error:
        raise ContractError(
            f"{variable}={str(folder)!r} cannot be written: {error.strerror}. "
            "Name a folder that you may create and write."
        ) from error


@dataclass(frozen=True, slots=True)
class Backend:
    """The backend in use, read after `gs.init` from Genesis, Quadrants and Torch."""

    requested: str
    actual: str
    arch: str
    torch_device: str
    torch_version: str
    hip_version: str | None
    cuda_version: str | None
    device_name: str


@dataclass(frozen=True, slots=True)
class Engine:
    """The started engine with its versions, its backend and its log.

    `switches` are the variables that were set for engine, compiler or drivers.
    """

    version: str
    quadrants_version: str
    precision: str
    seed: int
    backend: Backend
    log: EngineLog
    switches: Mapping[str, str] = field(default_factory=dict)


def start(contract: Contract) -> Engine:
    """Initialise Genesis, once per process, and probe where it runs.

    Raises:
        EngineError: Genesis is missing or already initialised, a graphics library is
            missing, or engine, Quadrants and Torch disagree on the backend.
    """
    backend = requested_backend(contract)
    import_engine().init(backend=backend, **ARGUMENTS, **plain_log())
    return started(contract)


def requested_backend(contract: Contract) -> Any:
    """Return the argument `backend` of the `gs.init` that follows, and start to keep its log.

    It raises EngineError if Genesis is missing or initialised, or a graphics library is
    missing.
    """
    gs = import_engine()
    if getattr(gs, "_initialized", False):
        raise EngineError(
            f"Genesis is already initialised in this process (backend {gs.backend.name}). A "
            "backend, seed or precision cannot be changed afterwards: restart the kernel."
        )
    logger = logging.getLogger("genesis")
    logger.addFilter(remove_private_paths)
    logger.addHandler(EngineLog())
    return gs.cpu if contract.backend == "cpu" else gs.gpu


def plain_log() -> dict[str, str]:
    """Return the arguments of `gs.init` that make its log plain text with all messages.

    The theme without colour codes is `raw`, in older versions `dumb`.
    """
    newer = hasattr(importlib.import_module("genesis.styles"), "THEME")
    return {"theme": "raw" if newer else "dumb", "logging_level": "info"}


def started(contract: Contract) -> Engine:
    """Return the engine that `gs.init` started, after checking how it was started.

    Raises:
        EngineError: Genesis is not initialised, its log was not kept, seed, precision
            or algorithms are not the expected ones, or engine, Quadrants and Torch
            disagree on the backend.
    """
    gs = import_engine()
    if not getattr(gs, "_initialized", False):
        raise EngineError(
            "Genesis is not initialised. Run the cell with gs.init first."
        )
    logs = _kept_logs()
    if not logs or not logs[-1].lines:
        raise EngineError(
            "Genesis was initialised, but its log was not kept. Restart the kernel and write "
            "gs.init(backend=rg.backend(), ..., **rg.PLAIN_LOG)."
        )
    found = {
        "seed": getattr(gs, "SEED", None),
        "precision": str(8 * np.dtype(gs.np_float).itemsize),
        "use_deterministic_algorithms": getattr(
            gs, "use_deterministic_algorithms", True
        ),
    }
    if found != ARGUMENTS:
        raise EngineError(
            f"gs.init was called with {found}, valid is {ARGUMENTS}. Restart the kernel and write "
            "gs.init(backend=rg.backend(), seed=rg.SEED, precision=rg.PRECISION, "
            "use_deterministic_algorithms=True, **rg.PLAIN_LOG)."
        )
    compiler = ".".join(map(str, importlib.import_module("quadrants").__version__))
    switches = project.engine_switches()
    backend = probe(contract.backend)
    return Engine(
        gs.__version__, compiler, PRECISION, SEED, backend, logs[-1], switches
    )


def _kept_logs() -> list[EngineLog]:
    """Return the handlers of the engine's logger that keep its lines."""
    return [
        h for h in logging.getLogger("genesis").handlers if isinstance(h, EngineLog)
    ]


def import_engine() -> Any:
    """Import Genesis, or raise EngineError: what is missing, and the command that installs it."""
    if sys.platform == "linux":
        require_libraries()
    # Quadrants asks `inspect` for the module of the frame below each of its decorated
    # functions. It is frozen and without a file, so Python would search all modules each
    # time: 5 s in the first scene of a process.
    inspect.modulesbyfile["<frozen importlib._bootstrap>"] = "importlib._bootstrap"
    try:
        return importlib.import_module("genesis")
    except ImportError as error:
        advice = project.import_advice()
        raise EngineError(f"Genesis cannot be imported: {error}. {advice}") from error


def require_libraries() -> ctypes.CDLL:
    """Load `LIBRARIES` and return the last one, EGL; raise EngineError if one cannot be loaded."""
    for name in LIBRARIES:
        try:
            library = ctypes.CDLL(name)
        except OSError as error:
            raise EngineError(
                f"{name} cannot be loaded ({error}). Genesis needs EGL and OpenGL even without a "
                "camera. On Debian: apt install libegl1 libgl1"
            ) from error
    return library


def require_display(egl: ctypes.CDLL) -> None:
    """Start EGL without a window system, as `scene.build()` does; raise EngineError if it fails."""
    pointer = egl.eglGetProcAddress.restype = ctypes.c_void_p
    call = ctypes.CFUNCTYPE(pointer, ctypes.c_uint, pointer, pointer)
    names = (b"eglQueryDevicesEXT", b"eglGetPlatformDisplayEXT")
    query, display = (call(egl.eglGetProcAddress(name)) for name in names)
    devices, count = (pointer * 64)(), ctypes.c_int()
    query(len(devices), devices, ctypes.addressof(count))
    found = [
        display(PLATFORM_DEVICE, device, None) for device in devices[: count.value]
    ]
    if not any(egl.eglInitialize(pointer(one), None, None) for one in found):
        raise EngineError(
            f"EGL starts on none of {count.value} devices, so scene.build() fails. A driver is "
            "missing, or its file in /usr/share/glvnd/egl_vendor.d. On Debian: apt install "
            "--reinstall libegl-mesa0. Unset variables that begin with __EGL_VENDOR."
        )


def probe(requested: str) -> Backend:
    """Read the backend in use from Genesis, Quadrants and Torch, and require that they agree."""
    gs = importlib.import_module("genesis")
    torch = importlib.import_module("torch")
    quadrants = importlib.import_module("quadrants")
    found = Backend(
        requested=requested,
        actual=gs.backend.name,
        arch=str(quadrants.cfg.arch).removeprefix("Arch."),
        torch_device=gs.device.type,
        torch_version=torch.__version__,
        hip_version=torch.version.hip,
        cuda_version=torch.version.cuda,
        device_name=_device_name(gs),
    )
    require_agreement(found)
    return found


def _device_name(gs: Any) -> str:
    """Return the name of the device: from the log, because the engine takes a second to find it."""
    named = re.search(r"Running on \[(.+)\] with ", _kept_logs()[-1].text())
    return named[1] if named else str(gs.utils.get_device(gs.backend)[1])


def require_agreement(found: Backend) -> None:
    """Raise EngineError unless Genesis, Quadrants and Torch use the requested backend."""
    problems = [
        f"{n} is {value!r}, expected {valid!r}"
        for n, value, valid in contradictions(found)
    ]
    if found.requested == "cpu" and found.actual != "cpu":
        problems.append(f"the backend is {found.actual!r}, requested was 'cpu'")
    if problems:
        raise EngineError(
            f"Genesis, Quadrants and Torch disagree about the backend: {'; '.join(problems)}. "
            f"Found: {found}. Unset QD_ARCH and "
            "GS_TORCH_FORCE_CPU_DEVICE, check the Torch build, and restart the kernel."
        )


def require_built(scene: Any, case: Any) -> None:
    """Raise CaseError unless a scene has the `dt` and `substeps` of a case."""
    if (scene.dt, scene.substeps) != (case.dt, case.substeps):
        raise CaseError(
            f"The scene was built with dt={scene.dt}, substeps={scene.substeps}; the case asks for "
            f"dt={case.dt}, substeps={case.substeps}. Restart and build the scene for this case."
        )
