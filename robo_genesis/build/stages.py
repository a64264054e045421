"""The stages of `make book` in their order: execute, verify, render, pack, check, publish."""

import os
import shutil
import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from robo_genesis.build import npm, up_to_date
from robo_genesis.build.execute import TIMEOUT, execute_pages
from robo_genesis.build.page_import import Verify, take_over
from robo_genesis.build.page_results import PageResult, failure_report
from robo_genesis.build.publish import publish, recover
from robo_genesis.build.release import lacking
from robo_genesis.build.render import render
from robo_genesis.build.site_address import AddressError, site_address, site_root
from robo_genesis.build.site_archive import pack
from robo_genesis.build.site_checks import check_site
from robo_genesis.core import project
from robo_genesis.core.files import locked
from robo_genesis.core.git import unclean
from robo_genesis.evidence import bundle_store
from robo_genesis.lessons.book_pages import Page, find_pages, fingerprint


class BuildError(Exception):
    """A stage failed; the message is the whole report. The site that stood before still stands."""


@dataclass(frozen=True, slots=True)
class Build:
    """What to build, with which resources, and where progress is printed.

    `jobs` None means one for each core; `verify` takes a bundle folder and its run id, returns the
    manifest or raises; None is the course's own verification. `release` demands a clean tree and
    every lesson's required evidence, and executes all pages anew. `executed` holds all pages as
    another machine executed them; then none is executed here. `command` is what bundles name.
    """

    root: Path = project.ROOT
    book: Path = project.BOOK
    cache: Path = project.CACHE
    jobs: int | None = None
    timeout: int = TIMEOUT
    verify: Verify | None = None
    release: bool = False
    executed: Path | None = None
    command: str = "make book"
    say: Callable[[str], None] = print


class Progress:
    """Prints lines of elapsed time, stage, page and event."""

    def __init__(self, say: Callable[[str], None]):
        self.say, self.begin = say, time.monotonic()

    def __call__(self, stage: str, what: str, event: str = "") -> None:
        """Print one line."""
        elapsed = time.monotonic() - self.begin
        self.say(f"[{elapsed:7.1f} s] {stage:8} {what}  {event}".rstrip())


def run_build(build: Build) -> list[str]:
    """Build the site and publish it.

    Args:
        build: see there.

    Returns:
        The last lines for the user: where the site is and what it was built with.

    Raises:
        BuildError: a stage failed; nothing was published.
        HandoverError: pages that were executed elsewhere are refused; nothing was published.
        ProjectError, PageError: the checkout is not fit for a build.
    """
    with only_build(build.cache):
        recover(build.book)
        bundle_store.recover(build.book / "evidence")
        inputs = up_to_date.inputs_digest(build.root, build.book)
        progress = Progress(build.say)
        engine = project.require_pinned_engine(build.root)
        _require_for_render()
        project.remove_stale_kernel_lock(build.cache)
        pages = find_pages(build.book)
        folder = project.page_cache_folder(fingerprint(pages, build.root), build.cache)
        if build.release:
            _require_for_release(unclean(build.root))
            shutil.rmtree(folder, ignore_errors=True)  # what is released was run at this commit
        if build.executed:
            for record in take_over(build.executed, pages, folder, _verifier(build)):
                progress("handover", record.docname, f"run {record.run_id[:8]}")
        results = execute_stage(build, pages, folder, progress)
        manifests = _verify(build, results, progress)
        if build.release:
            problems = lacking(build.book, _labs(results), build.root)
            _require_for_release([*unclean(build.root), *problems])
            progress("release", "clean tree, current evidence")
        progress("render", "all pages")
        staging, log = build.cache / "staging", build.cache / "render.log"
        executed = [r.page.docname for r in results if r.status == "executed"]
        html = render(build.book, staging, folder, log, executed)
        progress("pack", pack(html).name)  # last of the site's files; the checks know it
        checked = _check(html, progress)
        project.forget_old_pages(folder)
        finish = partial(
            _keep, build, inputs, _summary(engine, _reused(results), manifests, checked)
        )
        html = publish(build.book, html, results, finish)  # last: after it, nothing may fail
        progress("publish", str(html))
        return [f"Site: {html / 'index.html'}", *_summary(engine, results, manifests, checked)]


def _reused(results: Sequence[PageResult]) -> list[PageResult]:
    """Return the results as the next build would have them, if nothing changes."""
    return [replace(result, status="reused") for result in results]


def _keep(build: Build, inputs: str | None, lines: Sequence[str], published: Path) -> None:
    """Write beside the site what it was made from; not known where a file was edited meanwhile."""
    after = up_to_date.inputs_digest(build.root, build.book)
    up_to_date.keep(published, inputs if inputs == after else None, lines)


def _require_for_render() -> None:
    """Raise what the last stages would raise after minutes: an address, npm's packages."""
    try:
        site_address()
    except AddressError as error:
        raise BuildError(str(error)) from error
    npm.packages()


def _require_for_release(problems: Sequence[str]) -> None:
    """Raise BuildError where anything stands against a release."""
    if problems:
        raise BuildError("\n".join(["RELEASE=1 cannot be met.", *problems]))


def _labs(results: Sequence[PageResult]) -> dict[str, Path | None]:
    """Return each lesson of the book to the folder of its lab's bundle of this build."""
    labs: dict[str, Path | None] = {
        str(result.page.lesson): None for result in results if result.page.declares_bundle
    }
    return labs | {str(r.page.lesson): r.bundle for r in results if r.page.page == "lab"}


def execute_stage(
    build: Build, pages: Sequence[Page], folder: Path, progress: Progress
) -> list[PageResult]:
    """Run the execution stage; every page is tried before the report."""
    cores = os.cpu_count() or 1
    progress("execute", f"{len(pages)} pages", f"fingerprint {folder.name}")
    results = execute_pages(
        pages,
        folder,
        jobs=build.jobs or max(1, min(cores, len(pages))),
        timeout=build.timeout,
        environment=_kernel_environment(build),
        on_progress=lambda what, event: progress("execute", what, event),
    )
    if any(result.failure for result in results):
        raise BuildError(failure_report(results))
    return results


def _kernel_environment(build: Build) -> dict[str, str]:
    """Return the variables that every page's kernel gets from this build."""
    return {
        **project.engine_cache_environment(build.root, build.cache),
        **project.environment_contract(),
        "ROBO_GENESIS_COMMAND": build.command,
    }


def _verifier(build: Build) -> Verify:
    """Return what a build verifies bundles with."""
    from robo_genesis.evidence.verify import verify_bundle

    return build.verify or partial(verify_bundle, book=build.book)


def _verify(build: Build, results: Sequence[PageResult], progress: Progress) -> Mapping[str, Any]:
    """Return the accepted manifests of this build's bundles, by page name.

    A recorded bundle that is neither current nor stale stops the build as well.
    """
    from robo_genesis.evidence.bundle import BundleRefused
    from robo_genesis.evidence.status import refused_records

    verify = _verifier(build)
    manifests, refused = {}, []
    for result in results:
        if result.bundle is None:
            continue
        try:
            manifest = verify(result.bundle, result.run_id)
            _require_what_was_asked(manifest.predicate)
            manifests[result.page.docname] = manifest
            progress("verify", result.page.docname, "accepted")
        except BundleRefused as error:
            refused.append(f"{result.page.docname}: the bundle {result.bundle} is refused: {error}")
    refused += refused_records(build.book)
    if refused:
        raise BuildError("\n".join(refused))
    return manifests


def _require_what_was_asked(predicate: Any) -> None:
    """Raise BundleRefused where a bundle's backend or camera is not the one this build asked for.

    Args:
        predicate: what the bundle's manifest says of its run.
    """
    from robo_genesis.evidence.bundle import BundleRefused

    contract = project.environment_contract()
    backend, render = contract["ROBO_GENESIS_BACKEND"], contract["ROBO_GENESIS_RENDER"]
    for code, what, found, asked in (
        ("backend", "backend.requested", predicate.backend.requested, backend),
        ("frames", "render.mode", predicate.render.mode, "camera" if render == "1" else "skip"),
    ):
        if found != asked:
            raise BundleRefused(
                code,
                f"{what} is {found!r}, this build asked for {asked!r}. "
                "Let the page read runtime.read_contract() and set neither itself.",
            )


def _check(html: Path, progress: Progress) -> int:
    """Check the rendered site and return the number of checks passed."""
    checks = check_site(html, site_root())
    for check in checks:
        found = f"{len(check.problems)} problems" if check.problems else "passed"
        progress("check", f"{check.name} ({check.count})", found)
    problems = [f"{check.name}: {line}" for check in checks for line in check.problems]
    if problems:
        raise BuildError("\n".join([f"The site has {len(problems)} problems.", *problems]))
    return len(checks)


def _summary(
    engine: str, results: Sequence[PageResult], manifests: Mapping[str, Any], checked: int
) -> list[str]:
    """Return the facts that a build ends with, one line for each lab."""
    counts = Counter(result.status for result in results)
    labs = [result.page for result in results if result.page.page == "lab"]
    lines = [f"Engine: {project.ENGINE} {engine}"]
    for page in labs:
        facts = manifests[page.docname].predicate
        renderer = facts.render.renderer or "SKIP: no camera frames"
        lines.append(
            f"Lesson {page.lesson}: engine {facts.engine.version}, backend requested "
            f"{facts.backend.requested}, actual {facts.backend.actual}, "
            f"render {facts.render.mode} ({renderer})"
        )
    lines.append(f"Pages: {counts['executed']} executed, {counts['reused']} reused.")
    measured = sum(len(manifest.predicate.checks) for manifest in manifests.values())
    lines.append(f"Checks passed: {measured} on what was measured, {checked} on the site.")
    return lines


def only_build(cache: Path) -> AbstractContextManager[None]:
    """Hold the lock of builds and of tests that run the engine.

    Args:
        cache: folder of the caches. The lock lies beside the compiled kernels, which two cache
            folders may share.

    Raises:
        BuildError: another process holds it; the message names that process.
    """
    return locked(
        cache / "engine" / "build.lock",
        lambda process: BuildError(
            f"Another build, or a test of the engine, runs here (process {process}). Wait for it, "
            "or stop it with Ctrl-C there."
        ),
    )
