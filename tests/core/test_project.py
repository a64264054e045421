import os
from pathlib import Path
from unittest.mock import patch

import pytest

from robo_genesis.core import project

PYPROJECT = '[project]\nname = "x"\nversion = "0"\ndependencies = [{}]\n'


def checkout(folder: Path, *dependencies: str) -> Path:
    listed = ", ".join(f'"{name}"' for name in dependencies)
    (folder / "pyproject.toml").write_text(PYPROJECT.format(listed))
    (folder / "requirements.lock").write_text("numpy==2.0\n")
    return folder


NO_PIN = 'Valid is exactly one dependency "genesis-world==X"'


@pytest.mark.parametrize(
    "declared",
    [
        '"numpy"',
        '"genesis-world==1.*"',
        '"genesis-world==1.3", "genesis-world==1.4"',
    ],
)
def test_the_pin_is_one_exact_version(tmp_path, declared):
    root = checkout(tmp_path, "numpy>=2", "genesis-world==9.8.7")
    assert project.engine_pin(root) == "9.8.7"
    (root / "pyproject.toml").write_text(PYPROJECT.format(declared))
    with pytest.raises(project.ProjectError, match=NO_PIN):
        project.engine_pin(root)


def test_the_pin_is_not_repeated():
    package = Path(project.__file__).parents[1]
    sources = [*package.rglob("*.py"), *(project.BOOK / "lessons").rglob("*.md")]
    assert [
        path for path in sources if project.engine_pin() in path.read_text("utf8")
    ] == []


def test_what_pip_leaves_in_a_checkout_is_no_installed_package(tmp_path, monkeypatch):
    for name in ("robo_genesis.egg-info", "numpy-2.0.dist-info"):
        (tmp_path / name).mkdir()
    monkeypatch.setattr("sys.path", [str(tmp_path)])
    assert [name for _, name, _ in project.installed()] == ["numpy-2.0.dist-info"]


def test_a_missing_lock_is_refused_with_the_command_that_writes_it(tmp_path):
    with pytest.raises(project.ProjectError, match="make lock"):
        project.lock_digest(tmp_path)


def test_engine_caches_are_named_by_engine_and_lock(tmp_path):
    root = checkout(tmp_path, "genesis-world==9.8.7")
    environment = project.engine_cache_environment(root)
    kernels = Path(environment["QD_OFFLINE_CACHE_FILE_PATH"])
    assert kernels == root / ".cache/engine" / kernels.parent.name / "kernels"
    assert kernels.parent.name == f"9.8.7-{project.lock_digest(root)[:12]}"
    assert environment["QD_OFFLINE_CACHE_MAX_SIZE_OF_FILES"] == "2000000000"
    for name in (
        "GS_CACHE_FILE_PATH",
        "NUMBA_CACHE_DIR",
        "MESA_SHADER_CACHE_DIR",
        "MPLCONFIGDIR",
    ):
        assert Path(environment[name]).is_dir()
    (root / "requirements.lock").write_text("numpy==2.1\n")
    assert project.engine_cache_folder(root) != kernels.parent


def test_the_home_folder_is_not_named(monkeypatch):
    monkeypatch.setenv("HOME", "/srv/me")
    text = "/usr/lib:/srv/me/mesa, /srv/me, /srv/men/x"
    assert project.without_folders(text) == "/usr/lib:~/mesa, ~, /srv/men/x"


def test_the_environment_contract_holds_the_engines_switches_and_not_its_cache_folders(
    tmp_path,
):
    switches = {f"{prefix}X": "1" for prefix in project.ENGINE_PREFIXES}
    folders = project.engine_cache_environment(
        checkout(tmp_path, "genesis-world==9.8.7")
    )
    switches["LD_LIBRARY_PATH"] = "/opt/rocm/lib"
    given = {**switches, **folders, "ROBO_GENESIS_RENDER": "0", "HOME": "/"}
    defaults = {"ROBO_GENESIS_BACKEND": "cpu", "ROBO_GENESIS_RENDER": "0"}
    with patch.dict(os.environ, given, clear=True):
        assert project.environment_contract() == switches | defaults
