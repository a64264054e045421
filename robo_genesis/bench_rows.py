"""The rows of `make bench`: each a piece of work of the course, and what it is held against."""

import json
import shutil
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path

from robo_genesis import project
from robo_genesis.bench import BenchError, Pair, Row, Sample, in_turn
from robo_genesis.bench_bare import write_sources
from robo_genesis.bench_clone import Clone, make
from robo_genesis.lessons import LESSONS
from robo_genesis.page_cache import array_digests, outputs_folder
from robo_genesis.pages import find_pages

SPHINX = "from sphinx.cmd.build import main; import sys; sys.exit(main(sys.argv[1:]))"
BARE_START = "import numpy, pydantic"
LAB = "lessons/l04-joint-control/lab"
MEMORY = "memory"

PROSE = "bare Sphinx has no verification, replays, takeaways, finished pages or checks of them."
BUNDLE = "the start of a Jupyter kernel, plots, metrics, and writing the bundle."
BALANCE = "the longest page alone takes longer than half of all pages."
READS = "the engine starts a kernel for each read of a control force."
MEMORY_LIMIT = 8 * 2**30


def rows(clone: Clone) -> list[Row]:
    """Return all rows, measured in a copy of the checkout that was built."""
    verifying = make("verify", "BUNDLE=book/_build/evidence/l04/cpu")
    bundle = "book/_build/evidence/l04/cpu"
    comparing = make("compare", f"OLD={bundle}", f"NEW={bundle}")
    start = "python -c 'import numpy, pydantic'"
    return [
        Row("unchanged", "make book, nothing changed", "bare Sphinx, nothing changed", 1.5,
            partial(unchanged, clone)),
        Row("prose", "make book after a change of prose", "bare Sphinx, all pages", 1.3,
            partial(prose, clone), where=PROSE),
        Row("lab", "L04 lab executed warm", "bare script, same engine calls", 1.25,
            partial(lab, clone), runs=3, where=BUNDLE),
        Row("jobs", "all lessons executed warm, JOBS=2", "JOBS=1", 0.65,
            partial(jobs, clone), runs=3, where=BALANCE),
        Row("verify", "make verify of a bundle", start, 3.0,
            partial(against_start, clone, verifying)),
        Row("compare", "make compare of two bundles", start, 3.0,
            partial(against_start, clone, comparing)),
        Row("recording", "step loop that records all 9 DOFs", "step loop, no reads", 1.5,
            partial(recording, clone), runs=25, where=READS),
        *(
            Row(lesson, f"{lesson.upper()} executed cold", "executed warm", None,
                partial(cold_and_warm, clone, lesson), runs=1)
            for lesson in LESSONS
        ),
    ]  # fmt: skip


def python(*words: str) -> list[str]:
    """Return a command of this interpreter."""
    return [sys.executable, *words]


def bare_sphinx(clone: Clone) -> list[str]:
    """Write a bare book below the copy, build it once, and return the command that does so."""
    folder = clone.root.parent / "bare"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    sources = write_sources(clone.book, clone.pages, folder / "book")
    command = python("-c", SPHINX, "-b", "html", str(sources), str(folder / "html"))
    clone.time([*command, "-W", "--keep-going"], "build succeeded")
    clone.time(command)  # the first build after a -E still finds files that changed
    return command


def unchanged(clone: Clone, runs: int) -> Iterator[Pair]:
    """Build where nothing changed."""
    bare = bare_sphinx(clone)
    clone.time(make("book"))
    yield from in_turn(
        lambda: clone.time(make("book"), "Nothing changed"),
        lambda: clone.time(bare, "no targets are out of date"),
        runs,
    )


def prose(clone: Clone, runs: int) -> Iterator[Pair]:
    """Build after a sentence was added to the lab; bare Sphinx reads and writes all pages."""
    bare = bare_sphinx(clone)
    page = clone.book / f"{LAB}.md"

    def build() -> Sample:
        text = page.read_text("utf8")
        page.write_text(text.replace("\n## 2. ", "\nOne more sentence.\n\n## 2. ", 1), "utf8")
        return clone.time(make("book"), "Pages: 0 executed")

    yield from in_turn(build, lambda: clone.time([*bare, "-E", "-a"], "build succeeded"), runs)


def lab(clone: Clone, runs: int) -> Iterator[Pair]:
    """Execute the lab with all kernels compiled; the bare script calls the engine likewise."""
    page = executing(clone, LAB)
    script = python("build_scripts/measured/lab.py")
    clone.time(script)
    yield from in_turn(page, lambda: clone.time(script), runs)


def jobs(clone: Clone, runs: int) -> Iterator[Pair]:
    """Execute all pages, two at once and one after the other; both must measure the same.

    Raises:
        BenchError: an array is not the same bit for bit.
    """
    both, one = executing(clone, JOBS="2"), executing(clone, JOBS="1")
    for pair in in_turn(both, one, runs):
        if both.arrays != one.arrays:
            moved = sorted(dict(both.arrays.items() ^ one.arrays.items()))
            raise BenchError(f"Arrays that differ between JOBS=2 and JOBS=1: {', '.join(moved)}.")
        yield pair


def cold_and_warm(clone: Clone, lesson: str, runs: int) -> Iterator[Pair]:
    """Execute all pages of a lesson one after the other, with no kernel compiled, and again."""
    named = [page.docname for page in find_pages(clone.book) if page.lesson == lesson]
    pages = executing(clone, *named, JOBS="1")
    compiled = project.engine_cache_folder(clone.root)
    aside = compiled.with_name(f"{compiled.name}.aside")
    for _ in range(runs):
        compiled.rename(aside)
        try:
            yield pages(), pages()
        finally:
            shutil.rmtree(compiled, ignore_errors=True)
            aside.rename(compiled)


class executing:  # noqa: N801 - reads as a function
    """Executes pages of a copy from nothing, as a build does where none are cached.

    `arrays` names what the last run recorded, with its digest.
    """

    def __init__(self, clone: Clone, *pages: str, **wishes: str):
        self.clone, self.pages, self.wishes = clone, pages, wishes
        self.arrays: dict[str, str] = {}

    def __call__(self) -> Sample:
        """Return what it cost."""
        folder = self.clone.root.parent / "executed"
        shutil.rmtree(folder, ignore_errors=True)
        command = python("build_scripts/measured/pages.py", str(folder), *self.pages)
        sample = self.clone.time(command, "executed in", **self.wishes)
        self.arrays = array_digests(outputs_folder(folder))
        return sample


def against_start(clone: Clone, command: list[str], runs: int) -> Iterator[Pair]:
    """Run a command; its opponent is a bare start of Python with two packages."""
    bare = python("-c", BARE_START)
    yield from in_turn(lambda: clone.time(command), lambda: clone.time(bare), runs)


def recording(clone: Clone, runs: int) -> Iterator[Pair]:
    """Run the step loop in one process, with and without records in turn."""
    found = clone.root / ".cache" / "steps.json"
    clone.time(python("build_scripts/measured/steps.py", str(runs), str(found)))
    for recorded, bare in json.loads(Path(found).read_text("utf8")):
        yield Sample(recorded), Sample(bare)


def peak_of_full_build(clone: Clone) -> int:
    """Return the peak memory of a build that executes all pages, two at once [bytes]."""
    clone.time(make("clean"))
    return clone.peak_memory(make("book"), "0 reused", JOBS="2")
