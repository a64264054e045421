"""The stages of `make book`, from executing to publishing; `make execute` is one, for one page."""

import os
import shutil
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from robo_genesis.core import project
from robo_genesis.core.files import locked, settle, settle_below
from robo_genesis.evidence.refusals import BundleRefused

from . import npm, up_to_date
from .bundles.page_bundles import verify_result
from .bundles.status import RECORDED_PAGE, refused_records
from .bundles.verify import verify_bundle
from .command import TIMEOUT, Progress, say
from .html.address import described, site_address, site_root
from .html.checks import run_checks
from .html.publish import publish
from .html.render import LOG, render
from .pages.book import Page, find_pages
from .pages.execute import execute_pages
from .pages.page_index import PageIndex
from .pages.results import PageResult, failure_report
from .pages.store import Verify, forget, places, typical_seconds
from .release import missing_for_release


class BuildError(project.ProjectError):
    """A stage failed; the message is the whole report, and the old site is unchanged."""


@dataclass(frozen=True, slots=True)
class Build:
    """What to build, with which resources, and where progress is printed.

    `jobs` pages run at once; `verify` None is the course's own verification. `release`
    demands a clean tree and every lesson's required evidence; `release.build` calls it
    so. `to` is the book that gets the site, by default `book`. `command` is the command
    that bundles name.
    """

    book: Path = project.BOOK
    cache: Path = project.CACHE
    jobs: int = os.cpu_count() or 1
    timeout: int = TIMEOUT
    verify: Verify | None = None
    release: bool = False
    to: Path | None = None
    command: str = "make book"
    say: Callable[[str], None] = say


def run_build(build: Build) -> list[str]:
    """Build the site and publish it.

    Args:
        build: see there.

    Returns:
        The last lines for the user: where the site is and what it was built with.

    Raises:
        BuildError: a stage failed; nothing was published.
        ProjectError: checkout or SITE_URL are refused; nothing was published.
    """
    with build_lock(build.cache):
        target, progress = build.to or build.book, Progress(build.say)
        # The inputs are digested before any is read.
        inputs = up_to_date.inputs_digest(project.ROOT, build.book)
        engine, pages, into = prepare(build)
        npm.packages()
        about = [*described(), f"Engine: {project.ENGINE} {engine}"]
        results, manifests = execute(build, pages, into, progress)
        _require_evidence(build, results)
        progress("render", "all pages")
        folder = build.cache / project.KEPT
        if build.release:
            shutil.rmtree(folder, ignore_errors=True)
        index = PageIndex.of(results)
        rendered = render(build.book, folder, index, build.cache / LOG)
        forget(build.cache / project.STORE, pages, into)
        summary = partial(_summary, about, results, manifests)

        def finish(published: Path) -> None:
            _check(published / "html", progress)
            # After an edit during the build, the next one has work.
            if up_to_date.inputs_digest(project.ROOT, build.book) == inputs:
                up_to_date.record(published, inputs, summary(executed=0))

        html = publish(target, rendered, results, finish)
        progress("publish", str(html))
        ran = sum(result.status == "executed" for result in results)
        return [f"Site: {html / 'index.html'}", *summary(executed=ran)]


def execute_one(name: str, build: Build) -> list[str]:
    """Execute one page of the book into the store, unless the store has it.

    Args:
        name: the page as the table of contents names it, or as `l04/lab`.
        build: where book and caches are, and with which resources.

    Returns:
        The last lines for the user: where the page is, and what executed it.

    Raises:
        BuildError: the book lacks the page, or it failed or is refused.
        ProjectError: the checkout is not fit for it, or a build runs here.
    """
    with build_lock(build.cache):
        engine, pages, into = prepare(build)
        chosen = [p for p in pages if name in (p.docname, f"{p.lesson}/{p.page}")]
        if not chosen:
            valid = ", ".join(page.docname for page in pages) or "none"
            raise BuildError(
                f"PAGE={name!r} is not valid. Executed pages of this book: {valid}."
            )
        [result], _ = execute(build, chosen, into, Progress(build.say))
    return [
        f"Executed page: {result.folder}",
        f"Engine: {project.ENGINE} {engine}",
    ]


def prepare(
    build: Build, store: str = project.STORE
) -> tuple[str, list[Page], dict[str, Path]]:
    """Return the engine's version, the book's pages, and their places in a store.

    What a killed build left is repaired first.

    Args:
        build: where book and caches are.
        store: a folder of the caches.

    Raises:
        ProjectError: pin, lock and installed engine are not of one version, or a page
            breaks a rule.
    """
    settle_below(build.book / "evidence")
    settle_below(build.cache / project.STORE)
    settle((build.to or build.book) / project.PUBLISHED)
    project.remove_stale_kernel_lock(build.cache)
    pin, lock = project.engine_pin(), project.ROOT / "requirements.lock"
    project.lock_digest()
    if f"{project.ENGINE}=={pin}\n" not in lock.read_text("utf8"):
        raise BuildError(
            f"pyproject.toml pins {project.ENGINE} {pin}, but {lock.name} has another version. "
            "`make lock` makes the lock follow the pin. To try another version, restore both "
            "files; `make repin GENESIS=version` changes both."
        )
    project.require_pinned_engine()
    pages = find_pages(build.book)
    return pin, pages, places(pages, build.cache / store)


def execute(
    build: Build, pages: Sequence[Page], into: Mapping[str, Path], progress: Progress
) -> tuple[list[PageResult], dict[str, Any]]:
    """Execute pages, and verify the bundle of each soon after its end.

    Every page is tried before the report.

    Returns:
        The results in the order of `pages`, and the accepted manifests by page name.

    Raises:
        BuildError: pages failed, or bundles are refused.
    """
    progress("execute", f"{len(pages)} pages")
    verify = build.verify or partial(
        verify_bundle, book=build.book, once=not (build.release or site_address())
    )
    manifests: dict[str, Any] = {}
    refusals: list[str] = []

    def accept(result: PageResult) -> None:
        name = result.page.docname
        try:
            if bundle := result.bundle:
                manifests[name] = verify_result(verify, result, bundle, progress)
        except BundleRefused as error:
            progress("verify", name, f"refused: {error}")
            refusals.append(f"{name}: the bundle {result.bundle} is refused: {error}")

    environment = {
        **project.engine_cache_environment(cache=build.cache),
        **project.environment_contract(),
        project.COMMAND: build.command,
    }
    results = execute_pages(
        pages,
        into,
        seconds=typical_seconds(build.book),
        jobs=build.jobs,
        timeout=build.timeout,
        environment=environment,
        logs=build.cache / project.LOGS,
        say=partial(progress, "execute"),
        accept=accept,
    )
    failed = any(result.failure for result in results)
    if failed or refusals:
        reports = [failure_report(results)] * failed + refusals
        raise BuildError("\n\n".join(reports))
    return results, manifests


def _require_evidence(build: Build, results: Sequence[PageResult]) -> None:
    """Raise BuildError if a recorded bundle is refused, or if a release lacks one."""
    labs = {
        str(result.page.lesson): result.bundle
        for result in results
        if result.page.page == RECORDED_PAGE and result.bundle
    }
    if refused := refused_records(build.book):
        raise BuildError("\n".join(refused))
    if build.release and (problems := missing_for_release(build.book, labs)):
        raise BuildError("\n".join(["RELEASE=1 cannot be met.", *problems]))


def _check(html: Path, progress: Progress) -> None:
    """Check the rendered site.

    Raises:
        BuildError: it has problems.
    """
    checks = run_checks(html, site_root())
    for name, problems in checks.items():
        progress("check", name, f"{len(problems)} problems")
    lines = [f"{name}: {line}" for name, found in checks.items() for line in found]
    if lines:
        raise BuildError("\n".join([f"The site has {len(lines)} problems.", *lines]))


def _summary(
    about: Sequence[str],
    results: Sequence[PageResult],
    manifests: Mapping[str, Any],
    executed: int,
) -> list[str]:
    """Return the facts that a build ends with."""
    renderers = {facts.render.renderer for facts in manifests.values()} - {None}
    measured = sum(len(manifest.checks) for manifest in manifests.values())
    return [
        *about,
        f"Renderer: {', '.join(sorted(renderers)) or 'SKIP, no camera frames'}",
        f"Pages: {executed} executed, {len(results) - executed} reused.",
        f"Checks passed: {measured} on what was measured, all on the site.",
    ]


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
