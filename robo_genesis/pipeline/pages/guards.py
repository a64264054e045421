"""Sentences of a page that name the check that guards them.

A sentence that claims an order or a bound ends with the role `{guard}` and the name of
a check of its page, or of `lesson/page check`. If the check fails, the sentence must be
written again.
"""

import re
from pathlib import Path

GUARD = re.compile(r"\{guard\}`([^`]+)`")
DECLARED = re.compile(
    r"^robo_genesis:\s*\{?\s*lesson: *(\w+),?\s*page: *(\w+)", re.MULTILINE
)


def contradicted(book: Path, lesson_page: str, message: str) -> str:
    """Return which lines of the book a message of failed checks contradicts, as a message.

    Args:
        book: the folder of the pages.
        lesson_page: whose checks failed: `l04/lab`.
        message: it has the names of the failed checks in brackets.
    """
    failed, lines = set(re.findall(r"\[(\w+)\]", message)), []
    for file in sorted(book.glob("[!_]*/**/*.md")):
        text = file.read_text("utf8")
        front = DECLARED.search(text)
        own = "/".join(front.groups()) if front else ""
        for guard in GUARD.finditer(text):
            place, _, check = guard[1].rpartition(" ")
            if check in failed and (place or own) == lesson_page:
                line = text.count("\n", 0, guard.start()) + 1
                lines.append(f"{file.relative_to(book)}, line {line} ({check})")
    return f" Write again what the runs contradict: {'; '.join(lines)}." * bool(lines)
