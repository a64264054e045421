"""Run the steps of the diagnosis on this machine and stop at the first that is broken.

    python -m robo_genesis.doctor         a table for the terminal
    python -m robo_genesis.doctor --json  the same facts for a bug report

The steps run in a process of their own. If the system ends it, the step that it ran is
broken.
Exit status: 0 all steps pass, 1 one is broken, 2 the command was not understood.
"""

import sys

if not (3, 11) <= sys.version_info < (3, 14):
    sys.exit(
        f"DOCTOR: Python {sys.version.split()[0]} runs, the course needs 3.11, 3.12 or 3.13"
    )
if __name__ == "__main__" and not sys.flags.safe_path:
    sys.path.pop(0)  # a student's own json.py is not imported here

import argparse
import json
import os
import platform
import re
import signal
import subprocess
import tempfile
import textwrap
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from typing import Any

from robo_genesis.core import project
from robo_genesis.core.text import ended, printable

# Characters of a row, which fits 80 columns, and before what was found.
WIDTH, INDENT = 72, 28
# Begins a report among the other output of the process that runs the steps.
MARK = "\x1e"
STEPS_PROCESS = "from robo_genesis import doctor; doctor.send_reports()"

PACKAGES = ("genesis-world", "quadrants", "torch", "numpy", "matplotlib")


def table(steps: Sequence[Mapping[str, str]]) -> str:
    """Return the rows of the steps that are done, and the beginning of the next one's.

    If one is broken or none is left, the verdict is the last line. Only a long word
    makes a row longer than `WIDTH`.
    """
    text, verdict = "", f"all {len(steps)} steps pass"
    for number, step in enumerate(steps, start=1):
        name, state = step["step"], step["state"]
        begun = f"{number:2}/{len(steps):<2}  {name:{INDENT - 18}}  "
        if state == "not run":
            return text + begun
        row = textwrap.fill(
            printable(" ".join(step["found"].split())),
            WIDTH,
            initial_indent=f"{begun}{state:7}  ",
            subsequent_indent=" " * INDENT,
            break_long_words=False,
            break_on_hyphens=False,
        )
        text += f"{row}\n"
        if state == "broken":
            verdict = f"step {number}, {name}, is broken; fix it and run this again"
            break
    return f"{text}\nDOCTOR: {verdict}\n"


def report_of(steps: Sequence[Mapping[str, str]], engine: Any = None) -> dict[str, Any]:
    """Return a report on steps, each with `step`, `state` and `found`.

    Args:
        steps: those that are done, and others.
        engine: the started one, None before.
    """
    return {
        "ok": all(step["state"] == "ok" for step in steps),
        "broken": next(
            (step["step"] for step in steps if step["state"] == "broken"), None
        ),
        "steps": steps,
        "machine": {
            "python": platform.python_version(),
            "system": platform.platform(),
        },
        "versions": {name: project.installed_version(name) for name in PACKAGES},
        "environment": project.environment_contract(),
        "warnings": engine.log.warnings if engine else [],
    }


def examine() -> Iterator[dict[str, Any]]:
    """Run the steps in this process; yield the report before the first and after each one."""
    from robo_genesis.sim import diagnosis

    with tempfile.TemporaryDirectory() as folder:
        # Without it, the outputs would go to the working directory.
        bench = diagnosis.Bench({project.OUTPUTS_DIR: folder} | os.environ)
        steps = [
            {"step": s.__name__, "state": "not run", "found": ""}
            for s in diagnosis.STEPS
        ]
        yield report_of(steps)
        for number, result in enumerate(diagnosis.run_steps(diagnosis.STEPS, bench)):
            steps[number] = asdict(result)
            yield report_of(steps, bench.engine)


def send_reports() -> None:
    """Print each report of `examine` on a line of its own."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C ends the compiler at once
    for report in examine():
        print(f"\n{MARK}{json.dumps(report)}", flush=True)


def reports() -> Iterator[dict[str, Any]]:
    """Run the steps in a process of their own; yield its reports.

    If it ends before the last step does, the step that it ran is broken in one more
    report.
    """
    report = report_of([{"step": "version", "state": "not run", "found": ""}])
    last_lines = deque[str](maxlen=3)
    with subprocess.Popen(
        [sys.executable, "-c", STEPS_PROCESS],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf8",
        errors="replace",
    ) as process:
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda sent, _: process.send_signal(sent))
        for line in process.stdout or ():
            text, mark, sent = line.partition(MARK)
            if mark:
                yield (report := json.loads(sent))
            elif text.strip():
                last_lines.append(text.strip())
    left = [step for step in report["steps"] if step["state"] == "not run"]
    if left and not report["broken"]:
        status = process.returncode
        words = f"{[f'Status {status}', *last_lines][-1]}. {project.import_advice()}"
        if status < 0:
            folders = " and ".join(project.cache_folders().values())
            words = f"Ended by {ended(status, folders)}. {' '.join(last_lines)}"
        left[0] |= {"state": "broken", "found": words}
        yield report | {"broken": left[0]["step"]}


def with_cause(found: str) -> str:
    """Return what a broken step found, with the variables that may be its cause.

    Folders of PYTHONPATH come before the packages of the course, and those of
    LD_LIBRARY_PATH before the libraries of the system.
    """
    missed = {
        "PYTHONPATH": {*os.listdir(project.PACKAGES)} - {"__pycache__"},
        "LD_LIBRARY_PATH": {*re.findall(r"[^\s/]+\.so[.\d]*", found)},
    }
    causes = [
        f"{name} names {folder}, which has another {min(others)}"
        for name, own in missed.items()
        for folder in os.environ.get(name, "").split(os.pathsep)
        if os.path.isdir(folder) and folder != str(project.ROOT)
        if (others := own.intersection(os.listdir(folder)))
    ]
    if not causes:
        return found
    found = found.replace(project.import_advice(), "").rstrip(". ")
    return f"{found}. {'. '.join(causes)}. Unset the variable, and run this again."


def shareable(text: str) -> str:
    """Return a text without folders, which can name users; paths in the course stay relative."""
    text = project.without_folders(text.replace(sys.prefix, "…"))
    text = re.sub(r"/(?:home|Users)/[^/:;,\s'\"]+", "~", text)
    return re.sub(r"(?<![\w.~…/-])/(?!usr/(?:share|lib)/)(?:[^/\s'\"]+/)+", "…/", text)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the results and return the exit status."""
    parser = argparse.ArgumentParser(
        "python -m robo_genesis.doctor",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "--json", action="store_true", help="a report for a bug, on stdout"
    )
    options = parser.parse_args(arguments)
    sys.stdout.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    print("The first start of the engine takes minutes.", file=sys.stderr)
    written = ""
    for report in reports():
        for step in report["steps"]:
            if step["state"] == "broken":
                step["found"] = with_cause(step["found"])
        if not options.json:
            text = table(report["steps"])
            print(text[len(written) :], end="", flush=True)
            written = text
    if options.json:
        print(shareable(json.dumps(report, indent=2)))
    return int(not report["ok"])


if __name__ == "__main__":
    sys.exit(main())
