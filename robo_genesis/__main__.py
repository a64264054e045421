"""The commands of the course: `python -m robo_genesis COMMAND [options]`; `make` calls them.

Exit status: 0 done, 1 failed, 2 the command was not understood or nothing can be
compared, 130 interrupted. A command that fails leaves older results unchanged.
"""

import argparse
import os
import sys
from argparse import Namespace
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robo_genesis.core import project
from robo_genesis.core.project import BOOK, CACHE, PUBLISHED, ROOT, ProjectError
from robo_genesis.pipeline.command import TIMEOUT, run

if TYPE_CHECKING:
    from robo_genesis.pipeline.stages import Build  # loads slowly

if sys.flags.optimize > 1:
    sys.exit(
        "PYTHONOPTIMIZE=2 removes docstrings, which are the claims of checks: unset it."
    )


def book(options: Namespace) -> Sequence[str] | int:
    """Measure every lesson on CPU, verify, render and check the site."""
    from robo_genesis.pipeline import up_to_date

    set_environment(options)
    is_release = options.release == "1"
    if is_release and options.render == "0":
        raise ProjectError("A release needs camera frames: leave RENDER=0 out.")
    if is_release and options.to is None:
        from robo_genesis.pipeline import release

        return release.build(options)
    published = options.book / PUBLISHED
    if not is_release and (
        lines := up_to_date.nothing_changed(ROOT, options.book, published)
    ):
        return lines
    from robo_genesis.pipeline.stages import run_build

    return run_build(
        build(options, jobs=options.jobs, release=is_release, to=options.to)
    )


def execute(options: Namespace) -> Sequence[str]:
    """Execute one page, unless it was executed unchanged."""
    from robo_genesis.pipeline.stages import execute_one

    set_environment(options)
    return execute_one(options.page, build(options, command="make execute"))


def verify(options: Namespace) -> int:
    """Verify the recorded and the built evidence, or one bundle."""
    from robo_genesis.pipeline.bundles import overview

    return overview.verify(options.bundle)


def evidence(options: Namespace) -> int:
    """Record all labs on this machine, or one."""
    from robo_genesis.pipeline.recording.labs import Recording, record

    how = build(options, jobs=1, command="make evidence")
    place = options.to or options.book / "evidence"
    return record(Recording(options.lesson, options.backend, place, how))


def evidence_rocm(options: Namespace) -> int:
    """Record all labs, or one, in a container with ROCm; the host needs Python alone."""
    from robo_genesis.pipeline.recording.rocm_container import record

    return record(options.lesson)


def compare(options: Namespace) -> int:
    """Compare two bundles, such as the site's and your own."""
    from robo_genesis.evidence import report

    return report.print_comparison(options.old, options.new, options.report)


def lesson(options: Namespace) -> Sequence[str]:
    """Add a lesson that is made from the template."""
    from robo_genesis.maintain.new_lesson import add_lesson

    return add_lesson(ROOT, options.new)


def live(options: Namespace) -> int:
    """Show the book on localhost while it is written."""
    from robo_genesis.pipeline.html.render import live as run_live

    set_environment(options)
    return run_live(options.port, options.book, options.cache)


def lock(options: Namespace) -> Sequence[str]:
    """Resolve requirements.lock again from pyproject.toml."""
    from robo_genesis.maintain.lock import write_lock

    write_lock(upgrade=options.upgrade.split())
    return ["requirements.lock has all packages; `git diff` shows what changed."]


def repin(options: Namespace) -> Sequence[str]:
    """Try another engine version, then change pin and lock."""
    from robo_genesis.maintain.repin import run_repin

    return run_repin(options.genesis)


def seconds(options: Namespace) -> Sequence[str]:
    """Write what each page took last into the table from which a first build estimates."""
    from robo_genesis.pipeline.pages.book import find_pages
    from robo_genesis.pipeline.pages.store import write_seconds

    store = options.cache / project.STORE
    return [str(write_seconds(options.book, store, find_pages(options.book)))]


def sizes(options: Namespace) -> int:
    """Compare the size of each page with the limits."""
    from robo_genesis.pipeline.pages.book import find_pages, page_files
    from robo_genesis.site.course.sizes import report

    find_pages(options.book)  # refuses pages that are not valid
    problems = report(page_files(options.book))
    print(*problems, sep="\n")
    return int(bool(problems))


def build(options: Namespace, **more: Any) -> "Build":
    """Return what to build; all commands that execute pages share the folders and the time."""
    from robo_genesis.pipeline.stages import Build

    return Build(options.book, options.cache, timeout=options.timeout, **more)


def set_environment(options: Namespace) -> None:
    """Set the variables that pages and Sphinx read; every build runs on the CPU."""
    os.environ |= {
        project.BACKEND: project.BUILD_BACKEND,
        project.RENDER: options.render,
        project.SOLUTIONS: options.solutions,
        "SITE_URL": options.site_url,
    }


def absolute(path: str) -> Path:
    """Return an absolute path."""
    return Path(path).absolute()


SWITCH = {"choices": ("0", "1")}
FOLDERS: dict[str, dict[str, Any]] = {
    "--book": {"type": absolute, "default": BOOK, "help": "folder of the pages"},
    "--cache": {"type": absolute, "default": CACHE, "help": "folder of the caches"},
    "--timeout": {"type": int, "default": TIMEOUT, "help": "seconds for one cell"},
}
SITE: dict[str, dict[str, Any]] = {
    "--render": {**SWITCH, "default": "1", "help": "0: no camera frames"},
    "--site-url": {"default": "", "help": "address of the published site"},
    "--solutions": {**SWITCH, "default": "1", "help": "0: leave them out"},
}
PORT = {"type": int, "default": 8000, "help": "of localhost; 0: a free one"}
LESSON = {"default": "", "help": "l04, for example; by default all"}

# Command → the verb of its result, and its options.
COMMANDS: dict[Callable[..., Any], tuple[str, dict[str, dict[str, Any]]]] = {
    book: (
        "published",
        FOLDERS
        | SITE
        | {
            "--jobs": {"type": int, "default": os.cpu_count(), "help": "pages at once"},
            "--release": {**SWITCH, "default": "0", "help": "1: build the last commit"},
            "--to": {"type": absolute, "help": argparse.SUPPRESS},
        },
    ),
    execute: ("executed", FOLDERS | SITE | {"page": {"help": "l04/lab, for example"}}),
    verify: ("verified", {"--bundle": {"type": absolute, "help": "one folder"}}),
    evidence: (
        "recorded",
        FOLDERS
        | {
            "--lesson": LESSON,
            "--backend": {"choices": ("amdgpu", "cuda", "cpu"), "help": "expected"},
            "--to": {"type": absolute, "help": "folder; by default book/evidence"},
        },
    ),
    evidence_rocm: ("recorded", {"--lesson": LESSON}),
    compare: (
        "compared",
        {
            "old": {"type": Path, "help": "folder or archive of a bundle"},
            "new": {"type": Path, "help": "likewise"},
            "--report": {"type": Path, "help": "folder of the report"},
        },
    ),
    lesson: ("added", {"new": {"help": "name of the lesson, such as l09"}}),
    live: ("shown", FOLDERS | SITE | {"--port": PORT}),
    lock: ("written", {"--upgrade": {"default": "", "help": "packages to upgrade"}}),
    repin: ("changed", {"genesis": {"help": "version of the engine"}}),
    seconds: ("written", FOLDERS),
    sizes: ("compared", {"--book": FOLDERS["--book"]}),
}


def parser() -> argparse.ArgumentParser:
    """Return the parser of all commands."""
    top = argparse.ArgumentParser(
        "python -m robo_genesis", description=str(__doc__).splitlines()[0]
    )
    commands = top.add_subparsers(required=True, metavar="command")
    for function, (done, described) in COMMANDS.items():
        name, text = function.__name__.replace("_", "-"), function.__doc__
        command = commands.add_parser(name, help=text, description=text)
        command.set_defaults(function=function, done=done)
        for option, settings in described.items():
            command.add_argument(option, **settings)
    return top


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command and return its exit status."""
    options = parser().parse_args(arguments)
    return run(lambda: options.function(options), options.done)


if __name__ == "__main__":
    sys.exit(main())
