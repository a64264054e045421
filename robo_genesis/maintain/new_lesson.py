"""Add a lesson: files made from the template, and its lines in `_toc.yml` and `course_map.yml`.

The files below `template/` hold `$lesson` and `$LESSON` in the place of the name, `l07` and `L07`.
"""

import re
import shutil
from pathlib import Path
from string import Template

from robo_genesis.core.project import ProjectError

TEMPLATE = Path(__file__).with_name("template")
SUFFIX = ".tmpl"
TITLE = "A robot turns one joint"
OUTCOME = "measure how a joint turns"
NAME = re.compile(r"l\d\d")
CHAPTER = re.compile(r"  - file: (\S+)\s*")
ENTRY = re.compile(r"- id: (\S+)\s*")


class LessonError(ProjectError):
    """The lesson cannot be added; the message says why, and what is valid."""


def folders(root: Path, lesson: str) -> dict[str, Path]:
    """Return where each folder of the template goes in a checkout."""
    return {
        "package": root / "robo_genesis" / "lessons" / lesson,
        "book": root / "book" / "lessons" / f"{lesson}-new-lesson",
        "tests": root / "tests" / "lessons" / lesson,
    }


def add_lesson(root: Path, lesson: str) -> list[str]:
    """Write the files of a new lesson, all of them or none.

    Args:
        root: the checkout.
        lesson: the name, `l` and two digits.

    Returns:
        Lines for the user: what was written, and what to do next.

    Raises:
        LessonError: the name is not valid, the lesson exists, or a list has another form.
        OSError: a file cannot be written.
    """
    require_new(root, lesson)
    toc, course_map = root / "book" / "_toc.yml", root / "book" / "course_map.yml"
    lists = {path: path.read_text("utf8") for path in (toc, course_map)}
    files = lesson_files(root, lesson)
    files[toc] = with_chapter(lists[toc], lesson)
    files[course_map] = with_entry(lists[course_map], lesson)
    try:
        for path, text in files.items():
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, "utf8")
    except BaseException:
        for folder in folders(root, lesson).values():
            shutil.rmtree(folder, ignore_errors=True)
        for path, text in lists.items():
            path.write_text(text, "utf8")
        raise
    written = [f"  {path.relative_to(root)}" for path in files]
    return [f"Lesson {lesson} was added:", *written, "Next: edit these files, then `make book`."]


def require_new(root: Path, lesson: str) -> None:
    """Refuse a name that is not valid or is in use.

    Raises:
        LessonError: the message says what is valid.
    """
    if not NAME.fullmatch(lesson):
        raise LessonError(f"NEW={lesson!r} is not valid: write `l` and two digits, as in NEW=l07.")
    used = [
        found.relative_to(root).as_posix()
        for parent in ("robo_genesis/lessons", "book/lessons", "tests/lessons")
        for found in sorted((root / parent).glob(f"{lesson}*"))
    ]
    if used:
        raise LessonError(
            f"Lesson {lesson} exists: {', '.join(used)}. Give another number, or remove these."
        )


def lesson_files(root: Path, lesson: str) -> dict[Path, str]:
    """Return the text of each file that the template gives."""
    words = {"lesson": lesson, "LESSON": lesson.upper()}
    return {
        target / path.name.removesuffix(SUFFIX): Template(path.read_text("utf8")).substitute(words)
        for part, target in folders(root, lesson).items()
        for path in sorted((TEMPLATE / part).glob(f"*{SUFFIX}"))
    }


def with_chapter(toc: str, lesson: str) -> str:
    """Return the table of contents with the lesson's pages, in the order of the lessons.

    Raises:
        LessonError: it names no lesson.
    """
    lines = toc.splitlines()
    chapters = _matches(CHAPTER, lines)
    lessons = {name: k for name, k in chapters.items() if name.startswith("lessons/")}
    if not lessons:
        raise LessonError("book/_toc.yml has no line `  - file: lessons/...`. Add one there.")
    later = [k for name, k in lessons.items() if name > f"lessons/{lesson}"]
    at = min(later) if later else _end(chapters, max(lessons.values()), lines)
    folder = f"lessons/{lesson}-new-lesson"
    pages = [f"      - file: {folder}/{page}" for page in ("lab", "mistakes")]
    lines[at:at] = [f"  - file: {folder}/lecture", "    sections:", *pages]
    return "\n".join(lines) + "\n"


def with_entry(course_map: str, lesson: str) -> str:
    """Return the course map with the lesson: a planned one gets its page, another one is added.

    Raises:
        LessonError: the map already names a page of this lesson.
    """
    lines = course_map.splitlines()
    entries, name = _matches(ENTRY, lines), lesson.upper()
    new = [f"  page: lessons/{lesson}-new-lesson/lecture", f"  outcomes: [{OUTCOME}]"]
    if name in entries:
        at = _end(entries, entries[name], lines)
        if any(line.startswith("  page:") for line in lines[entries[name] : at]):
            raise LessonError(f"book/course_map.yml names a page of {name}. Remove that line.")
    else:
        at = min((k for entry, k in entries.items() if entry > name), default=len(lines))
        new = [f"- id: {name}", f"  title: {TITLE}", *new]
    lines[at:at] = new
    return "\n".join(lines) + "\n"


def _matches(pattern: re.Pattern[str], lines: list[str]) -> dict[str, int]:
    """Return the number of each line that a pattern matches, by the name in it."""
    return {m[1]: k for k, line in enumerate(lines) if (m := pattern.fullmatch(line))}


def _end(starts: dict[str, int], start: int, lines: list[str]) -> int:
    """Return the number of the line after the block that begins at `start`."""
    return min((k for k in starts.values() if k > start), default=len(lines))
