"""Sentences of a page that name the check that guards them.

A sentence that claims an order or a bound ends with the role `{guard}` and the name of
a check of its page, or of `lesson/page check`. If the check fails, the sentence must be
written again.
"""

import re
from pathlib import Path

GUARD = re.compile(r"\{guard\}`([^`]+)`")


def contradicted(book: Path, own: Path, lesson_page: str, message: str) -> str:
    """Return which lines of the book a message of failed checks contradicts, as a message.

    Args:
        book: the folder of the pages.
        own: the file of the page whose checks failed.
        lesson_page: its name in the guards of other pages: `l04/lab`.
        message: it has the names of the failed checks in brackets.
    """
    failed, lines = set(re.findall(r"\[(\w+)\]", message)), []
    for file in sorted(book.glob("[!_]*/**/*.md")):
        text = file.read_text("utf8")
        for guard in GUARD.finditer(text):
            place, _, check = guard[1].rpartition(" ")
            is_its_own = place == lesson_page or (not place and file == own)
            if check in failed and is_its_own:
                line = text.count("\n", 0, guard.start()) + 1
                lines.append(f"{file.relative_to(book)}, line {line} ({check})")
    return f" Write again what the runs contradict: {'; '.join(lines)}." * bool(lines)
