"""Where things are: the checkout, the engine pin, the lock and the cache folders."""

import hashlib
import os
import platform
import re
import shlex
import sys
import sysconfig
import tomllib
from collections.abc import Mapping
from importlib.machinery import PathFinder
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path

MEASURES = False

ROOT = Path(__file__).resolve().parents[2]
# Asked once: each answer reads Python's configuration
PACKAGES = sysconfig.get_path("purelib")
BOOK = ROOT / "book"
PUBLISHED = "_build"  # The folder of a book that holds its published site

CACHE = ROOT / ".cache"
STORE, COMPILED, RECORDING, LOGS = "pages", "engine", "recording", "logs"
# Below the cache folder: executed pages, what the engine compiles, the lab that is
# being recorded, what each page wrote when it was last executed, and what Sphinx keeps
# for the next build.
KEPT = "render"

ENGINE = "genesis-world"
COURSE = "robo-genesis"
WHEEL = COURSE.replace("-", "_")  # How the name of its file begins
BUILD_BACKEND = "cpu"  # What every page of the site is executed on

# Environment variables by which commands, pages and Sphinx tell each other.

# The contract of a page: its compute target, its camera, and where it leaves files.
BACKEND, RENDER = "ROBO_GENESIS_BACKEND", "ROBO_GENESIS_RENDER"
OUTPUTS_DIR = "ROBO_GENESIS_OUTPUTS_DIR"

# What a command gives a page: the id of the run, the command, the digest of the page's
# code, and the modules of the course that the page imports.
RUN_ID, COMMAND = "ROBO_GENESIS_RUN_ID", "ROBO_GENESIS_COMMAND"
PAGE_SHA256, PAGE_IMPORTS = "ROBO_GENESIS_PAGE_SHA256", "ROBO_GENESIS_PAGE_IMPORTS"

# What a build tells Sphinx: the file that lists the executed pages, see
# `build.page_index`.
EXECUTED_PAGES = "ROBO_GENESIS_EXECUTED_PAGES"

# 0: the site has no solutions and answers, see `site.solutions`
SOLUTIONS = "SOLUTIONS"

# Variables that switch the engine, its compiler and the drivers below it.
ENGINE_PREFIXES = (
    "GS_",
    "QD_",
    "LIBGL_",
    "MESA_",
    "EGL_",
    "HIP_",
    "ROCR_",
    "ROCM_",
    "HSA_",
    "CUDA_",
    "NVIDIA_TF32_",
)
KERNELS, GEOMETRY, NUMBA = (
    "QD_OFFLINE_CACHE_FILE_PATH",
    "GS_CACHE_FILE_PATH",
    "NUMBA_CACHE_DIR",
)
CACHE_FOLDERS = {
    KERNELS: "kernels",
    GEOMETRY: "geometry",  # by default below the user's home, for all versions
    NUMBA: "numba",
    "MESA_SHADER_CACHE_DIR": "mesa",
    "MPLCONFIGDIR": "matplotlib",  # its font list; also ignores a user's matplotlibrc
}
# With its default limit of 100 MB the engine removes kernels that it has just compiled.
CACHE_LIMIT = {"QD_OFFLINE_CACHE_MAX_SIZE_OF_FILES": "2000000000"}


def solutions_shown() -> bool:
    """Whether the site that is built contains solutions and answers."""
    return os.environ.get(SOLUTIONS) != "0"


class ProjectError(Exception):
    """A command cannot do its work; the message is the whole report and says what to do."""


def in_checkout() -> bool:
    """Whether this package lies in a checkout; an installed wheel has no pyproject.toml."""
    return (ROOT / "pyproject.toml").is_file()


def engine_pin(root: Path = ROOT) -> str:
    """Return the engine version that pyproject.toml pins, or the metadata of an installed wheel.

    Args:
        root: the checkout, or the folder of the installed package.

    Returns:
        The version X of the dependency `genesis-world==X`.

    Raises:
        ProjectError: none or several dependencies have this form.
    """
    file = root / "pyproject.toml"
    if root == ROOT and not in_checkout():
        declared = requires(COURSE) or []
    else:
        declared = tomllib.loads(file.read_text("utf8"))["project"]["dependencies"]
    pinned = re.compile(rf"{ENGINE} *== *([\w.+!-]+)")
    pins = [match[1] for line in declared if (match := pinned.fullmatch(line))]
    if len(pins) != 1:
        raise ProjectError(
            f'{file} has {len(pins)} pins. Valid is exactly one dependency "{ENGINE}==X".'
        )
    return pins[0]


def installed_version(package: str) -> str | None:
    """Return the installed version of a package, None if it is not installed."""
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def installed() -> list[tuple[str, str, int]]:
    """Return each installed package by folder, name with version, and time of installation.

    The course itself is excluded: pip leaves its metadata in a checkout.
    """
    suffixes = (".dist-info", ".egg-info", ".egg-link", ".pth")
    return sorted(
        (str(folder), path.name, path.stat().st_mtime_ns)
        for folder in (Path(place or ".") for place in sys.path)
        if folder.is_dir()
        for path in folder.iterdir()
        if path.suffix in suffixes and not path.name.startswith(f"{WHEEL}.")
    )


def install_command(what: str = "") -> str:
    """Return the command that installs packages into this Python, by default all of the course."""
    here = (
        "-r requirements.lock"
        if in_checkout()
        else f"-c constraints.txt ./{WHEEL}-*.whl"
    )
    return f"{shlex.quote(sys.executable)} -m pip install {what or here}"


def import_advice() -> str:
    """Return what to do where an import fails: rename one's own file, or install packages."""
    if hidden := " and ".join(hidden_modules()):
        return f"Python imports {hidden} of this folder, not the installed module: rename your file"
    course = f"{'.venv' if in_checkout() else 'course'}/bin/python"
    here = f"This is Python {platform.python_version()}, {sys.executable}"
    return f"{here}. Start the one of the course, {course}, or run {install_command()}"


def hidden_modules() -> list[str]:
    """Return the files of the working folder that Python imports in place of installed modules."""
    here = Path.cwd()
    others = [folder for folder in sys.path if Path(folder).resolve() != here]
    own = [*here.glob("*.py"), *(path.parent for path in here.glob("*/__init__.py"))]
    hidden = (
        p.name for p in own if p.stem != WHEEL and PathFinder.find_spec(p.stem, others)
    )
    return sorted(hidden)


def require_pinned_engine() -> str:
    """Return the engine version that a checkout pins; raise ProjectError if it is not installed."""
    pin, installed = engine_pin(), installed_version(ENGINE)
    if installed != pin:
        command = install_command("" if in_checkout() else f"{ENGINE}=={pin}")
        raise ProjectError(
            f"Installed is {ENGINE} {installed or '(none)'}, the course needs {pin}. Run {command}"
            f"{', or change pin and lock together' * in_checkout()}"
        )
    return pin


def lock_digest(root: Path = ROOT) -> str:
    """Return the sha256 of a checkout's lock as hex digits; raise ProjectError without a lock."""
    lock = root / "requirements.lock"
    if not lock.is_file():
        raise ProjectError(f"No {lock}. `make lock` writes it.")
    return hashlib.sha256(lock.read_bytes()).hexdigest()


def locked_versions(lock: str) -> dict[str, str]:
    """Return package to version of a lock's text."""
    return dict(
        line.split("==")
        for line in lock.splitlines()
        if "==" in line and line[0] != "#"
    )


def engine_cache_folder(root: Path = ROOT, cache: Path | None = None) -> Path:
    """Return the folder for what the engine compiles: one per engine version and lock."""
    cache = cache or root / ".cache"
    return cache / COMPILED / f"{engine_pin(root)}-{lock_digest(root)[:12]}"


def engine_cache_environment(
    root: Path = ROOT, cache: Path | None = None
) -> dict[str, str]:
    """Return the variables that make the engine keep its compiled code in the cache folder.

    Args:
        root: the checkout.
        cache: the cache folder, by default `.cache` of the checkout.

    Returns:
        Variable to value; the folders that they name exist.
    """
    base = engine_cache_folder(root, cache)
    paths = {name: base / folder for name, folder in CACHE_FOLDERS.items()}
    for path in paths.values():
        path.mkdir(parents=True, exist_ok=True)
    return {name: str(path) for name, path in paths.items()} | CACHE_LIMIT


def cache_folders() -> dict[str, str]:
    """Return the folders of compiled code by variable: as it is set, or else the default."""
    base = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    default = {KERNELS: "quadrants/qdcache", GEOMETRY: "genesis", NUMBA: "numba"}
    found = {name: f"{base}/{path}" for name, path in default.items()}
    own = engine_cache_environment() if in_checkout() else {}
    return {name: os.environ.get(name) or (found | own)[name] for name in found}


def nothing_compiled(environment: Mapping[str, str]) -> bool:
    """Return whether these variables name a folder for the engine's kernels, and it has none."""
    return KERNELS in environment and not any(Path(environment[KERNELS]).rglob("*.qdc"))


def remove_stale_kernel_lock(cache: Path = CACHE) -> None:
    """Remove lock files of killed engine processes from the kernel caches.

    A lock file does not name its process, so a stale one looks like a live one. Call
    this only at the start of a build, while the build lock excludes other builds.
    """
    for path in (cache / COMPILED).glob("*/kernels/**/*.lock"):
        path.unlink(missing_ok=True)


def environment_contract() -> dict[str, str]:
    """Return the variables that decide what a page measures.

    Returns:
        Backend and render, with defaults if they are not set, and of the engine's
        switches and the folders of libraries those that are set; the folders of
        compiled code are not included.
    """
    # Not a switch in a manifest: the engine appends to LD_LIBRARY_PATH.
    names = (BACKEND, RENDER, "LD_LIBRARY_PATH")
    requested = {name: os.environ[name] for name in names if os.environ.get(name)}
    defaults = {BACKEND: BUILD_BACKEND, RENDER: "1"}
    return defaults | requested | engine_switches()


def engine_switches() -> dict[str, str]:
    """Return the variables that switch the engine, its compiler or its drivers.

    They are the same before and after the import of the engine.
    """
    switches = {name for name in os.environ if name.startswith(ENGINE_PREFIXES)}
    # Genesis itself sets the last one at its import; it decides how messages print. A
    # build sets it to 0. With 1, as in a reader's Jupyter, each call of a kernel prints
    # a text and takes longer.
    switches -= CACHE_FOLDERS.keys() | CACHE_LIMIT.keys() | {"QD_ENABLE_PYBUF"}
    return {name: os.environ[name] for name in sorted(switches)}


def without_folders(text: str) -> str:
    """Return a text without the folders of packages, checkout and home, which are private."""
    home = str(Path.home())
    text = text.replace(PACKAGES, "site-packages").replace(f"{ROOT}/", "")
    return text if home == "/" else re.sub(rf"{re.escape(home)}(?![\w.-])", "~", text)
