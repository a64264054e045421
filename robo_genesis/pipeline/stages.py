"""The stages of `make book`, from executing to publishing; `make execute` is one, for one page."""

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from robo_genesis.core import project
from robo_genesis.core.files import locked, put, settle, settle_below
from robo_genesis.core.git import require_history, unclean
from robo_genesis.pipeline import npm, up_to_date
from robo_genesis.pipeline.agreement import agree
from robo_genesis.pipeline.bundles.of_build import verify_results
from robo_genesis.pipeline.bundles.status import refused_records
from robo_genesis.pipeline.bundles.verify import verify_bundle
from robo_genesis.pipeline.command import TIMEOUT, Progress, say
from robo_genesis.pipeline.html.address import described, site_address, site_root
from robo_genesis.pipeline.html.archive import pack, write_sums
from robo_genesis.pipeline.html.checks import Site, run_checks
from robo_genesis.pipeline.html.draft import Draft
from robo_genesis.pipeline.html.kept import discard
from robo_genesis.pipeline.html.publish import add_bundles, publish, staging_folder
from robo_genesis.pipeline.html.render import render
from robo_genesis.pipeline.html.sphinx_process import LOG, SphinxProcess
from robo_genesis.pipeline.pages.book import Page, find_pages
from robo_genesis.pipeline.pages.built import BuiltPages
from robo_genesis.pipeline.pages.execute import Lines, execute_pages, kernel_environment
from robo_genesis.pipeline.pages.results import PageResult, failure_report
from robo_genesis.pipeline.pages.store import (
    Verify,
    forget,
    handed_over,
    places,
)
from robo_genesis.pipeline.release import missing_for_release


class BuildError(project.ProjectError):
    """A stage failed; the message is the whole report, and the old site is unchanged."""


@dataclass(frozen=True, slots=True)
class Build:
    """What to build, with which resources, and where progress is printed.

    `jobs` pages run at once; `verify` None is the course's own verification. `release`
    demands a clean tree and every lesson's required evidence, and reuses no executed
    page of the cache; `release.build` calls it so. `executed` holds all pages as
    another machine executed them; then none is executed here. `second` holds a second
    execution, which must agree with it. `to` is the book that gets the site, by default
    `book`. `command` is the command that bundles name. `sphinx` loads Sphinx, by
    default a process that the build starts.
    """

    root: Path = project.ROOT
    book: Path = project.BOOK
    cache: Path = project.CACHE
    jobs: int = os.cpu_count() or 1
    timeout: int = TIMEOUT
    verify: Verify | None = None
    release: bool = False
    executed: Path | None = None
    second: Path | None = None
    to: Path | None = None
    command: str = "make book"
    sphinx: SphinxProcess | None = None
    say: Callable[[str], None] = say


def run_build(build: Build) -> list[str]:
    """Build the site and publish it.

    Args:
        build: see there.

    Returns:
        The last lines for the user: where the site is and what it was built with.

    Raises:
        BuildError: a stage failed; nothing was published.
        ProjectError: pages from elsewhere, checkout or SITE_URL are refused; nothing
            was published.
    """
    with (
        build.sphinx or SphinxProcess(build.book, build.cache / LOG) as sphinx,
        build_lock(build.cache),
        staging_folder(build.cache) as staging,
    ):
        target, progress = build.to or build.book, Progress(build.say)
        inputs = up_to_date.inputs_digest(build.root, build.book)  # before any is read
        engine, pages, into, environment = _prepare(build)
        npm.require_published()
        about = [*described(build.book), f"Engine: {project.ENGINE} {engine}"]
        from_nothing = build.release or build.executed or site_address()
        verify = build.verify or partial(
            verify_bundle, book=build.book, once=not from_nothing
        )
        manifests: dict[str, Any] = {}
        agreed: list[str] = []
        if build.executed:
            progress("execute", f"no page: all are taken from {build.executed}")
            results = handed_over(build.executed, pages, into)
            if build.second:
                agreed = agree(build.executed, build.second, verify)
                progress("agree", agreed[0])
            manifests = _accepted(build, verify, results, progress)
        else:
            results = _execute(build, pages, into, environment, progress, verify)

        def accept(
            draft: Draft,
        ) -> None:  # beside Sphinx, whose pages are published only after it
            if not build.executed:
                manifests.update(_accepted(build, verify, results, progress))
            add_bundles(draft, results)

        progress("render", "all pages")
        kept = None if from_nothing else build.cache / project.KEPT
        draft = render(
            sphinx, staging, BuiltPages.of(results, agreed), kept, meanwhile=accept
        )
        with ThreadPoolExecutor(1) as beside:  # compression runs beside Python
            packing = beside.submit(pack, draft.html)
            site = Site(draft.html, site_root())
            progress("pack", packing.result().name)
        sums = write_sums(
            draft.html, draft.digests
        )  # last of the site's files, before the checks
        progress("sums", sums.name)
        try:
            checked = _check(site, progress)
        except BuildError:
            if kept:  # what is wrong may be a file that the kept folder has lost
                discard(kept)
            raise
        for result in results:
            if (
                build.executed
            ):  # stored only now: what was refused must not stop later builds
                put(result.folder, into[result.page.docname])
        forget(build.cache / project.STORE, pages, into)
        summary = partial(_summary, about, results, manifests, checked)

        def finish(published: Path) -> None:
            now = up_to_date.inputs_digest(build.root, build.book)
            up_to_date.record(published, inputs, now, summary(executed=0))

        html = publish(target, draft.folder, finish)  # last: after it, nothing may fail
        progress("publish", str(html))
        ran = sum(result.status == "executed" for result in results)
        return [f"Site: {html / 'index.html'}", *summary(executed=ran), *agreed]


def execute_one(name: str, build: Build) -> list[str]:
    """Execute one page of the book, unless the store has it.

    Args:
        name: the page as the table of contents names it, or as `l04/lab`.
        build: where book and caches are, and with which resources.

    Returns:
        The last lines for the user: what executed it, and where its log is.

    Raises:
        BuildError: the book lacks the page, or it failed or is refused.
        ProjectError: checkout or book are not fit for it, or a build runs here.
    """
    with build_lock(build.cache):
        engine, pages, into, environment = _prepare(build)
        names = {page.docname: page for page in pages}
        names |= {
            f"{page.lesson}/{page.page}": page for page in pages if page.declares_bundle
        }
        if name not in names:
            valid = ", ".join(page.docname for page in pages) or "none"
            raise BuildError(
                f"PAGE={name!r} is not valid. Executed pages of this book: {valid}."
            )
        progress = Progress(build.say)
        [result] = results = _execute(build, [names[name]], into, environment, progress)
        verify = build.verify or partial(verify_bundle, book=build.book)
        if refused := verify_results(verify, results, progress)[1]:
            raise BuildError(*refused)
    return [
        f"Executed page: {into[result.page.docname]} ({result.status})",
        f"Engine: {project.ENGINE} {engine}, run {result.run_id}",
    ]


def _prepare(build: Build) -> tuple[str, list[Page], dict[str, Path], dict[str, str]]:
    """Return the engine's version, the book's pages, their places in the store, kernels' variables.

    What a killed build left is repaired first.
    """
    require_history(build.root)
    environment = kernel_environment(build.root, build.cache, build.command)
    settle_below(build.book / "evidence")
    settle_below(build.cache / project.STORE)
    settle((build.to or build.book) / project.PUBLISHED)
    project.remove_stale_kernel_lock(build.cache)
    engine = project.require_pinned_engine(build.root)
    pages = find_pages(build.book)
    return (
        engine,
        pages,
        places(pages, build.cache / project.STORE, build.root),
        environment,
    )


def _execute(
    build: Build,
    pages: Sequence[Page],
    into: Mapping[str, Path],
    environment: Mapping[str, str],
    progress: Progress,
    verify: Verify | None = None,
) -> list[PageResult]:
    """Run the execution stage; every page is tried before the report.

    With `verify`, a page is also verified soon after its end, so that a refusal is
    known early. A release is executed at its commit, so it reuses nothing.
    """
    progress("execute", f"{len(pages)} pages")
    refused: list[str] = []

    def accept(*results: PageResult) -> bool:
        found = (
            verify_results(verify, results, progress, "execute")[1] if verify else []
        )
        refused.extend(found)
        return not found

    results = execute_pages(
        pages,
        into,
        reuse=not build.release,
        jobs=build.jobs,
        timeout=build.timeout,
        environment=environment,
        logs=build.cache / project.LOGS,
        report=Lines(partial(progress, "execute")),
        accept=accept,
    )
    failed = (
        [failure_report(results)] if any(result.failure for result in results) else []
    )
    if failed or refused:
        accept(
            *(result for result in results if result.status == "reused")
        )  # to report them all
        raise BuildError("\n\n".join([*failed, *refused]))
    return results


def _accepted(
    build: Build, verify: Verify, results: Sequence[PageResult], progress: Progress
) -> dict[str, Any]:
    """Return the accepted manifests by page name.

    Raises:
        BuildError: a bundle of this build or a recorded one is refused, or a release
            lacks one.
    """
    measuring = [result for result in results if result.page.declares_bundle]
    labs: dict[str, Path | None] = dict.fromkeys(
        str(result.page.lesson) for result in measuring
    )
    labs |= {str(r.page.lesson): r.bundle for r in measuring if r.page.page == "lab"}
    manifests, refused = verify_results(verify, results, progress)
    if refused := refused + refused_records(build.book, labs):
        raise BuildError("\n".join(refused))
    if build.release:
        if problems := unclean(build.root) + missing_for_release(build.book, labs):
            raise BuildError("\n".join(["RELEASE=1 cannot be met.", *problems]))
        progress("release", "clean tree, current evidence")
    return manifests


def _check(site: Site, progress: Progress) -> int:
    """Check the rendered site and return the number of checks passed."""
    checks = run_checks(site)
    for check in checks:
        found = f"{len(check.problems)} problems" if check.problems else "passed"
        progress("check", f"{check.name} ({check.count})", found)
    problems = [f"{check.name}: {line}" for check in checks for line in check.problems]
    if problems:
        raise BuildError(
            "\n".join([f"The site has {len(problems)} problems.", *problems])
        )
    return len(checks)


def _summary(
    about: Sequence[str],
    results: Sequence[PageResult],
    manifests: Mapping[str, Any],
    checked: int,
    executed: int,
) -> list[str]:
    """Return the facts that a build ends with, one line for each lab."""
    lines = [*about]
    for page in (result.page for result in results if result.page.page == "lab"):
        facts = manifests[page.docname].predicate
        renderer = facts.render.renderer or "SKIP: no camera frames"
        lines.append(
            f"Lesson {page.lesson}: engine {facts.engine.version}, backend requested "
            f"{facts.backend.requested}, actual {facts.backend.actual}, "
            f"render {facts.render.mode} ({renderer})"
        )
    lines.append(f"Pages: {executed} executed, {len(results) - executed} reused.")
    measured = sum(len(manifest.predicate.checks) for manifest in manifests.values())
    lines.append(
        f"Checks passed: {measured} on what was measured, {checked} on the site."
    )
    return lines


def build_lock(cache: Path) -> AbstractContextManager[None]:
    """Hold the lock of builds and of tests that run the engine.

    Args:
        cache: folder of the caches. The lock lies beside the compiled kernels, which
            two cache folders may share.

    Raises:
        ProjectError: another process holds it; the message names that process.
    """
    lock = cache / project.COMPILED / "build.lock"
    return locked(lock, "Another build, or a test of the engine,")
