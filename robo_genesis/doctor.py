"""Run the steps of the diagnosis on this machine and stop at the first that is broken.

    python -m robo_genesis.doctor                a table for the terminal
    python -m robo_genesis.doctor --json         the same facts for a bug report
    python -m robo_genesis.doctor --like BUNDLE  and what differs from the machine of a recorded run
    python -m robo_genesis.doctor --report FILE  the table of a saved report, without any step
    python -m robo_genesis.doctor --report FILE --like BUNDLE    and what differs from its machine

A bundle is a folder, or an archive as the ledger of the site offers it. A report is a file that
`--json` wrote, on this machine or another.
Exit status: 0 all steps pass, 1 one is broken, 2 the command was not understood.
"""

import argparse
import contextlib
import io
import json
import os
import platform
import sys
import tempfile
import textwrap
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, Literal

from robo_genesis.core import project
from robo_genesis.core.project import OUTPUTS_DIR
from robo_genesis.core.text import printable
from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.sim import diagnosis
from robo_genesis.sim.diagnosis import Bench, StepResult, shareable

WIDTH = 72  # fits a terminal of 80 columns and the text column of a page
REPORT_FORMAT = 3
MAKE_REPORT = "python -m robo_genesis.doctor --json > report.json"
FACTS = ("engine", "quadrants", "torch", "python", "system", "backend", "device")
"""What a manifest and a report say about a machine."""

PACKAGES = ("genesis-world", "quadrants", "torch", "numpy", "matplotlib")


def table(results: Sequence[StepResult]) -> str:
    """Return the results as an aligned table, no line longer than `WIDTH`."""
    indent = max(len(f.step) for f in results) + 15
    lines = []
    for number, f in enumerate(results, start=1):
        head = f"{number:2}  {f.step:{indent - 15}}  {f.state:7}  "
        found = textwrap.fill(f.found, WIDTH, initial_indent=head, subsequent_indent=" " * indent)
        lines.append(found or head.rstrip())
    text = "\n".join([*lines, "", verdict(results)])
    return "\n".join(map(printable, text.split("\n")))


def verdict(results: Sequence[StepResult]) -> str:
    """Return the last line: how many steps pass, or which one is broken."""
    broken = [f"{number}, {f.step}" for number, f in enumerate(results, 1) if f.state == "broken"]
    if broken:
        return f"DOCTOR: step {broken[0]}, is broken; fix it and run this again"
    passed = sum(f.state == "ok" for f in results)
    how_many = "all" if passed == len(results) else f"{passed} of"
    return f"DOCTOR: {how_many} {len(results)} steps pass"


def examine() -> dict[str, Any]:
    """Run the steps; return a report with versions and platform, and without private paths."""
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        # Without it, the outputs would go to the working directory.
        bench = Bench({OUTPUTS_DIR: folder} | os.environ)
        results = diagnosis.run_steps(diagnosis.STEPS, bench)
    warnings = bench.engine.log.warnings if bench.engine else []
    contract = project.environment_contract(bench.environ)
    return {
        "format": REPORT_FORMAT,
        "ok": all(one.state == "ok" for one in results),
        "broken": next((one.step for one in results if one.state == "broken"), None),
        "steps": [asdict(one) | {"found": shareable(one.found)} for one in results],
        "machine": machine(bench),
        "versions": {"python": platform.python_version()}
        | {name: project.installed_version(name) for name in PACKAGES},
        "platform": {name: getattr(platform, name)() for name in ("system", "release", "machine")}
        | {"cpus": os.cpu_count()},
        "environment": {name: shareable(value) for name, value in contract.items()},
        "warnings": [shareable(text) for text in warnings],
    }


def machine(bench: Bench) -> dict[str, str]:
    """Return the facts that the manifest of a run has too; fewer if the engine did not start."""
    versions = [project.installed_version(name) for name in PACKAGES[:3]]
    found = [*versions, platform.python_version(), platform.platform()]
    if bench.engine:
        found += [bench.engine.backend.actual, bench.engine.backend.device_name]
    return {name: value or "not installed" for name, value in zip(FACTS, found, strict=False)}


def recorded_machine(bundle: str) -> dict[str, str]:
    """Return the same facts of the machine that recorded a bundle.

    Raises:
        BundleRefused: there is no bundle, or its manifest cannot be read.
    """
    from robo_genesis.compare import bundle_folder
    from robo_genesis.evidence.bundle import read_manifest

    with contextlib.ExitStack() as opened:
        run = read_manifest(bundle_folder(bundle, opened)).predicate
    engine, backend, host = run.engine, run.backend, run.host
    versions = [engine.version, engine.quadrants_version, backend.torch_version, host.python]
    found = [*versions, host.os, backend.actual, backend.device_name]
    return dict(zip(FACTS, found, strict=True))


def read_report(file: str) -> dict[str, Any]:
    """Return a saved report.

    Raises:
        ValueError: the file is not a report of this format.
    """
    from pydantic import BaseModel, Field, ValidationError

    class Report(BaseModel):
        format: Literal[3]
        steps: list[StepResult] = Field(min_length=1)
        machine: dict[str, str]

    try:
        return Report.model_validate_json(Path(file).read_bytes()).model_dump()
    except OSError as error:
        problem = str(error)
    except ValidationError as error:
        first = error.errors()[0]
        problem = f"{'.'.join(map(str, ('report', *first['loc'])))}: {first['msg']}"
    raise ValueError(
        f"{file!r} cannot be read as a report: {problem}; a report is a file that --json wrote; "
        f"make a new one with {MAKE_REPORT}"
    )


def differences(
    here: Mapping[str, str], recorded: Mapping[str, str], head: str = "this machine"
) -> list[str]:
    """Return a line for each fact: equal, or both values, in columns of equal width.

    Args:
        here: the facts of this machine, or of a saved report.
        recorded: the facts of the machine that recorded a bundle.
        head: the head of the column of `here`.
    """
    rows = [("", "recorded", head)]
    for name, value in recorded.items():
        found = here.get(name, "unknown: the engine did not start")
        rows.append((name, printable(value), "equal" if found == value else printable(found)))
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [f"{name:{widths[0]}}  {value:{widths[1]}}  {found}" for name, value, found in rows]
    if here.get("engine") != recorded["engine"]:
        lines.append("Install the engine's version of the site: another one gives other numbers.")
    elif here.get("backend", recorded["backend"]) != recorded["backend"]:
        lines.append("Another backend rounds differently. Orderings of runs should agree.")
    else:
        same = "engine is" if "backend" in here else "engine's version is"
        lines.append(f"The {same} the same. Other differences usually change only the last digits.")
    return lines


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the results and return the exit status."""
    parser = argparse.ArgumentParser(
        "python -m robo_genesis.doctor",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--json", action="store_true", help="a report for a bug, on stdout")
    parser.add_argument("--like", metavar="BUNDLE", help="compare with the machine of this run")
    parser.add_argument("--report", metavar="FILE", help="show this report, run no step")
    options = parser.parse_args(arguments)
    given = [name for name in ("like", "report") if getattr(options, name) is not None]
    if options.json and given:
        parser.error(
            f"--json and --{given[0]} cannot be combined. Make the report with {MAKE_REPORT}, and "
            "compare it with --report report.json --like BUNDLE"
        )
    try:
        recorded = None if options.like is None else recorded_machine(options.like)
        report = None if options.report is None else read_report(options.report)
    except (BundleRefused, zipfile.BadZipFile, ValueError) as error:
        parser.error(printable(str(error)))
    head = "this machine" if report is None else "report"
    if report is None:
        count = len(diagnosis.STEPS)
        print(f"{count} steps; the first start of the engine takes minutes", file=sys.stderr)
        report = examine()
    results = [StepResult(**step) for step in report["steps"]]
    print(json.dumps(report, indent=2, ensure_ascii=False) if options.json else table(results))
    if recorded is not None:
        print("", *differences(report["machine"], recorded, head), sep="\n")
    return 0 if all(one.state == "ok" for one in results) else 1


if __name__ == "__main__":
    sys.exit(main())
