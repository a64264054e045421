"""Add a lesson: files made from the template, and its lines in `_toc.yml` and `course_map.yml`.

The files below `template/` lie as in the checkout. Their paths and texts hold `$lesson`
and `$LESSON` in the place of the name, `l07` and `L07`.
"""

import re
from pathlib import Path
from string import Template

from robo_genesis.core.files import write_whole
from robo_genesis.core.project import ProjectError

TEMPLATE = Path(__file__).with_name("template")
OUTCOME = "measure how a joint turns"
CHAPTER, ENTRY = "  - file: ", "- id: "


def add_lesson(root: Path, lesson: str) -> list[str]:
    """Write the files of a new lesson, and then its lines in the two lists of the book.

    Args:
        root: the checkout.
        lesson: the name, `l` and two digits.

    Returns:
        Lines for the user: what was written, and what to do next.

    Raises:
        ProjectError: the name is not valid, or the lesson exists.
        OSError: a file cannot be written. A next call names the folders that were made.
    """
    if not re.fullmatch(r"l\d\d", lesson):
        raise ProjectError(
            f"NEW={lesson!r} is not valid: write `l` and two digits, as in NEW=l07."
        )
    if used := sorted(root.glob(f"*/lessons/{lesson}*")):
        names = ", ".join(path.relative_to(root).as_posix() for path in used)
        raise ProjectError(
            f"Lesson {lesson} exists: {names}. Give another number, or remove it."
        )
    toc, course_map = root / "book" / "_toc.yml", root / "book" / "course_map.yml"
    files = lesson_files(root, lesson)
    files[toc] = with_chapter(toc.read_text("utf8"), lesson)
    files[course_map] = with_entry(course_map.read_text("utf8"), lesson)
    for path, text in files.items():
        write_whole(path, text.encode())
    written = [f"  {path.relative_to(root)}" for path in files]
    return [
        f"Lesson {lesson} was added:",
        *written,
        "Next: edit these files, then `make book`.",
    ]


def lesson_files(root: Path, lesson: str) -> dict[Path, str]:
    """Return the text of each file that the template gives."""

    def filled(text: str) -> str:
        return Template(text).substitute(lesson=lesson, LESSON=lesson.upper())

    return {
        root / filled(str(path.relative_to(TEMPLATE).with_suffix(""))): filled(
            path.read_text("utf8")
        )
        for path in sorted(TEMPLATE.rglob("*.tmpl"))
    }


def with_chapter(toc: str, lesson: str) -> str:
    """Return the table of contents with the lesson's pages, in the order of the lessons."""
    head, *chapters = re.split(f"(?m)^(?={CHAPTER})", f"{toc.rstrip()}\n")
    folder = f"lessons/{lesson}-new-lesson"
    new = f"{CHAPTER}{folder}/lecture\n    sections:\n"
    names = ("practice", "lab", "mistakes")
    new += "".join(f"      - file: {folder}/{name}\n" for name in names)
    # The lessons are the first chapters.
    at = sum(f"{CHAPTER}lessons/" <= text < new for text in chapters)
    chapters.insert(at, new)
    return "".join([head, *chapters])


def with_entry(course_map: str, lesson: str) -> str:
    """Return the course map with the lesson: a planned one gets its page, another one is added."""
    head, *entries = re.split(f"(?m)^(?={ENTRY})", f"{course_map.rstrip()}\n")
    names, name = [entry.split()[2] for entry in entries], lesson.upper()
    new = f"  page: lessons/{lesson}-new-lesson/lecture\n  outcomes: [{OUTCOME}]\n"
    if name not in names:
        at = sum(other < name for other in names)
        entries.insert(at, f"{ENTRY}{name}\n  title: A robot turns one joint\n{new}")
    else:
        entries[names.index(name)] += new
    return "".join([head, *entries])
