"""Measure how cost grows, in a copy of the checkout with copies of a lesson in it."""

import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import yaml

from robo_genesis import kept
from robo_genesis.growth import Built, Growth, GrowthError, Verified
from robo_genesis.pages import find_pages
from robo_genesis.workcopy import WISHES, CommandError, copy_tree, run_logged

LESSON = "l04"
"""The lesson that is copied."""
COPIES = (0, 1, 3, 7)
BUNDLES = (1, 25, 50, 100, 200)

# The lesson's name as a page writes it for itself: in front matter, directives, roles, labels,
# links and strings; not the module of that name.
OWN_NAME = re.compile(
    rf"(?<=lesson: ){LESSON}\b|(?<=\}} ){LESSON}\b|(?<=[`\"(<-]){LESSON}\b(?![.,])"
)
LABEL = re.compile(r"^\(([\w-]+)\)=$", re.MULTILINE)

REGISTER = {
    "robo_genesis/lessons.py": "\nLESSONS |= dict.fromkeys({names!r}, LESSONS[{lesson!r}])\n",
    "robo_genesis/evidence/verify.py": "\nJUDGES |= dict.fromkeys({names!r}, JUDGES[{lesson!r}])\n",
}

VERIFY = """
import sys
from pathlib import Path
from robo_genesis.evidence.verify import verify_bundle
root = Path.cwd()
for folder in sorted(Path(sys.argv[1]).iterdir())[: int(sys.argv[2])]:
    verify_bundle(folder / "cpu", root=root, book=root / "book")
"""


def measure(root: Path, cache: Path, say: Callable[[str], None]) -> Growth:
    """Build the book with more and more lessons, then verify more and more bundles.

    Args:
        root: the checkout; nothing in it is changed.
        cache: its cache folder, which lends the compiled kernels and holds copy and logs.
        say: told of each step.

    Raises:
        GrowthError: a command of the copy failed.
        ProjectError: the checkout cannot be copied.
    """
    made_with = kept.surroundings(root)
    folder = cache / "growth"
    work = folder / "work"
    try:
        copy_tree(root, work, cache)
        (work / ".cache" / "pages").unlink()  # all pages are executed anew, for each size
        names = add_copies(work, max(COPIES))
        built = tuple(_built(work, names, folder / "logs", say))
        verified = tuple(_verified(work, folder / "bundles", say))
    finally:
        for rubbish in (work, folder / "bundles"):
            shutil.rmtree(rubbish, ignore_errors=True)
    return Growth(**made_with, built=built, verified=verified)


def add_copies(work: Path, count: int) -> list[str]:
    """Add copies of the lesson, each under a name of its own, and return the names.

    The table of contents does not name them yet.
    """
    folder = _folder(work / "book")
    names = [f"{LESSON}copy{number}" for number in range(1, count + 1)]
    for name in names:
        shutil.copytree(folder, folder.with_name(name))
        for page in folder.with_name(name).glob("*.md"):
            page.write_text(renamed(page.read_text("utf8"), name), "utf8")
    for file, line in REGISTER.items():
        with (work / file).open("a", encoding="utf8") as stream:
            stream.write(line.format(names=names, lesson=LESSON))
    return names


def renamed(text: str, name: str) -> str:
    """Return a page of the lesson as that of another: its own name and its labels are changed."""
    for label in LABEL.findall(text):
        if LESSON not in label:
            text = re.sub(rf"(?<![\w-]){re.escape(label)}(?![\w-])", f"{name}-{label}", text)
    return OWN_NAME.sub(name, text)


def list_lessons(work: Path, names: Sequence[str]) -> None:
    """Let the table of contents name the lesson's copies after it, and no others."""
    path = work / "book" / "_toc.yml"
    toc = yaml.safe_load(path.read_text("utf8"))
    own = _folder(work / "book").name
    chapters = [c for c in toc["chapters"] if LESSON + "copy" not in c["file"]]
    place = next(k for k, chapter in enumerate(chapters) if f"/{own}/" in chapter["file"])
    text = yaml.safe_dump(chapters[place])
    added = [yaml.safe_load(text.replace(f"/{own}/", f"/{name}/")) for name in names]
    toc["chapters"] = chapters[: place + 1] + added + chapters[place + 1 :]
    path.write_text(yaml.safe_dump(toc, sort_keys=False), "utf8")


def _folder(book: Path) -> Path:
    """Return the folder of the lesson's pages."""
    return next(page.path.parent for page in find_pages(book) if page.lesson == LESSON)


def _built(
    work: Path, names: Sequence[str], logs: Path, say: Callable[[str], None]
) -> Iterator[Built]:
    for count in COPIES:
        list_lessons(work, names[:count])
        lessons = len({page.lesson for page in find_pages(work / "book") if page.declares_bundle})
        shutil.rmtree(work / ".cache" / "pages", ignore_errors=True)
        seconds = []
        for what in ("executing", "rendering"):
            say(f"{lessons} lessons, {what}")
            shutil.rmtree(work / "book" / "_build", ignore_errors=True)
            seconds.append(_timed(work, logs / f"{lessons}-{what}.log"))
        site = sum(p.stat().st_size for p in (work / "book/_build/html").rglob("*") if p.is_file())
        say(f"{lessons} lessons: {seconds[0]:.0f} s, {seconds[1]:.0f} s, {site / 1e6:.0f} MB")
        yield Built(lessons=lessons, executing=seconds[0], rendering=seconds[1], site=site)


def _timed(work: Path, log: Path) -> float:
    """Return the seconds of a `make book` in the copy."""
    begin = time.monotonic()
    try:
        run_logged(["make", "book", f"PYTHON={sys.executable}"], work, log, without=WISHES)
    except CommandError as error:
        raise GrowthError(f"{error}\nmake book failed in the copy.") from error
    return round(time.monotonic() - begin, 1)


def _verified(work: Path, folder: Path, say: Callable[[str], None]) -> Iterator[Verified]:
    """Verify copies of the lab's bundle, each in a process that starts for that."""
    for number in range(max(BUNDLES)):
        shutil.copytree(work / "book/_build/evidence" / LESSON, folder / f"{number:03d}")
    for count in BUNDLES:
        begin = time.monotonic()
        command = [sys.executable, "-c", VERIFY, str(folder), str(count)]
        done = subprocess.run(
            command, cwd=work, env=os.environ | {"PYTHONPATH": str(work)}, capture_output=True,
            text=True, check=False,
        )  # fmt: skip
        if done.returncode:
            raise GrowthError(f"{done.stderr}\nVerifying {count} bundles failed.")
        seconds = round(time.monotonic() - begin, 2)
        say(f"{count} bundles verified in {seconds:.1f} s")
        yield Verified(bundles=count, seconds=seconds)
