"""A request for a backend that this machine does not have: by name, and for any accelerator."""

from robo_genesis.core.exercises import Mistake
from robo_genesis.sim.fresh_process import last_value, run_python

MEASURES = False

REQUEST = """
import json, logging, sys
import genesis as gs
from robo_genesis.sim.session import plain_theme

kept = []
keep = logging.Handler()
keep.emit = lambda record: kept.append(record.getMessage())
logging.getLogger("genesis").addHandler(keep)
raised = found = None
try:
    gs.init(backend=getattr(gs, sys.argv[1]), theme=plain_theme(), logging_level="warning")
except Exception as error:
    raised = [type(error).__name__, str(error)]
    kept.clear()
    gs.init(backend=gs.gpu, theme=plain_theme(), logging_level="warning")
    found = gs.backend.name
print(json.dumps({"raised": raised, "found": found, "warnings": kept}))
"""
"""Two requests: one backend by name, then any GPU. They run in their own process, because an engine
can be initialised only once in a process."""


def absent_backend(hip_version: str | None) -> Mistake:
    """Request the accelerator whose Torch is not installed here, then any accelerator.

    Args:
        hip_version: of the installed Torch, as the probe reads it; None without ROCm.

    Raises:
        StartError: the process failed.
    """
    name = "cuda" if hip_version else "amdgpu"
    return absent_backend_failure(name, **last_value(run_python(["-c", REQUEST, name], {})))


def absent_backend_failure(
    name: str, raised: list[str] | None, found: str | None, warnings: list[str]
) -> Mistake:
    """Return the failure from the results of the two requests.

    Args:
        name: the backend that was requested by name.
        raised: type and message of its exception, None if there was none.
        found: the backend after the request for `gs.gpu`.
        warnings: the lines that the engine logged at this request.
    """
    if raised is None:
        return Mistake("absent_backend", False, f"`gs.init(backend=gs.{name})` raised nothing.")
    plain = [text.replace("~", "") for text in warnings]
    fell_back = found != "cpu" or (len(plain) == 1 and "Falling back to CPU" in plain[0])
    refused = raised[0] == "GenesisException" and "not available" in raised[1]
    return Mistake(
        "absent_backend",
        shown=refused and fell_back,
        evidence=(
            f"`gs.init(backend=gs.{name})` raised `{raised[0]}`: {raised[1].replace('~', '')} "
            f"`gs.init(backend=gs.gpu)` raised nothing and started on `{found}`; "
            f"its warnings ({len(plain)}): {' '.join(plain) or 'none'}"
        ),
    )
