"""What a command loads: its modules, looked at when it ends."""

import os
import subprocess
import sys

from robo_genesis.core.project import ROOT

ENGINE = ("genesis", "quadrants", "torch")
JUPYTER = ("sphinx", "nbformat", "myst_nb", "nbclient", "IPython")

WATCHED = """
import atexit, runpy, sys
atexit.register(lambda: print("LOADED", *{name.split(".")[0] for name in sys.modules}))
sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name="__main__")
"""


def run_watched(script: str, *words: str, **wishes: str) -> tuple[str, set[str]]:
    """Run a script of build_scripts; return what it printed, and the packages that it loaded."""
    command = [
        sys.executable,
        "-c",
        WATCHED,
        str(ROOT / "build_scripts" / script),
        *words,
    ]
    given = os.environ | {"PYTHONPATH": str(ROOT)} | wishes
    done = subprocess.run(command, env=given, capture_output=True, text=True)
    said, _, loaded = done.stdout.rpartition("LOADED ")
    return said + done.stderr, set(loaded.split())
