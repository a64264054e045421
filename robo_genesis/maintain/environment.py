"""`make .venv/.installed`: install requirements.lock into `.venv`; it needs Python alone.

uv installs, which pip brings; where it is not to be had, pip installs. Torch for the
CPU comes from the index of `book/_config.yml`, or from that of TORCH_INDEX.
"""

import os
import re
import subprocess
import sys
from pathlib import Path
from urllib.error import HTTPError
from urllib.request import urlopen

LOCK = "requirements.lock"
PYTHON = ".venv/bin/python"
# pip's settings of where packages are → uv's variables.
UV_VARIABLES = {
    "index-url": "UV_DEFAULT_INDEX",
    "extra-index-url": "UV_EXTRA_INDEX_URL",
    "find-links": "UV_FIND_LINKS",
}


def install() -> int:
    """Make `.venv` and install every package of the lock; return the exit status."""
    if not (3, 11) <= sys.version_info < (3, 14):
        sys.exit(
            f"Python {sys.version.split()[0]} runs, the course needs 3.11, 3.12 or 3.13. Name one: "
            "BASE_PYTHON=path."
        )
    subprocess.run([sys.executable, "-m", "venv", ".venv"], check=True)
    index = torch_index()
    pip = [PYTHON, "-m", "pip", "install"]
    packages = ["--no-deps", "--requirement", LOCK]
    if subprocess.run([*pip, "--quiet", "uv", "--constraint", LOCK]).returncode:
        print(
            "uv is not to be had; pip installs instead, which takes longer.", flush=True
        )
        extra = ["--extra-index-url", index] if index else []
        return subprocess.run([*pip, *extra, *packages]).returncode
    uv = [PYTHON, "-m", "uv", "pip", "install", f"--python={PYTHON}", *packages]
    return subprocess.run(uv, env=uv_environment(PYTHON, index)).returncode


def torch_index() -> str:
    """Return the address of an index with Torch for the CPU, empty if it cannot be reached."""
    config = Path("book/_config.yml").read_text("utf8")
    configured = re.findall(r"torch_index: (\S+)", config)
    index = os.environ.get("TORCH_INDEX") or "".join(configured)
    if not index:
        return ""
    try:
        urlopen(f"{index}/torch/", timeout=15).close()
    except HTTPError:  # it answers
        pass
    except OSError as error:
        print(f"{index} cannot be reached: {error}. Torch comes from PyPI.", flush=True)
        return ""
    return index


def uv_environment(python: str, index: str = "") -> dict[str, str]:
    """Return the variables of this process, and for uv the indexes that pip is set to use.

    Args:
        python: an interpreter with pip.
        index: a further one.
    """
    command = [python, "-m", "pip", "config", "list"]
    variables = {"UV_INDEX_STRATEGY": "unsafe-best-match"}  # as pip: the newest of all
    for line in subprocess.check_output(command, text=True).splitlines():
        setting, _, value = line.partition("=")
        if variable := UV_VARIABLES.get(setting.rpartition(".")[2]):
            variables[variable] = value.strip("'")
    extra = f"{index} {variables.get('UV_EXTRA_INDEX_URL', '')}"
    return variables | {"UV_EXTRA_INDEX_URL": extra.strip()} | os.environ


if __name__ == "__main__":
    sys.exit(install())
