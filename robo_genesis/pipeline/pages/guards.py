"""Sentences of a page that name the check that guards them.

A sentence that claims an order or a bound ends with the role `{guard}` and the name of
a check of its page, or of `lesson/page check`. If the check fails, the sentence must be
written again.
"""

import re
from collections.abc import Iterator
from pathlib import Path

GUARD = re.compile(r"\s*\{guard\}`([^`]+)`")
DECLARED = re.compile(
    r"^robo_genesis:\s*\{?\s*lesson: *(\w+),?\s*page: *(\w+)", re.MULTILINE
)
START = re.compile(r"(?<=[.!?])\s+(?=\S)|\n\s*(?:[-*]|\d+\.|\|)\s|\n\s*\n|\|")


def guarded_sentences(text: str) -> Iterator[tuple[int, str, str]]:
    """Yield (line, sentence, check) of each guard in a page's Markdown."""
    sentence = ""
    last = 0
    for match in GUARD.finditer(text):
        before = text[last : match.start()]
        if before.strip():
            sentence = " ".join(START.split(before.rstrip())[-1].split())
        last = match.end()
        yield text.count("\n", 0, match.start()) + 1, sentence, match[1]


def contradicted(book: Path, lesson_page: str, message: str) -> str:
    """Return which sentences of the book a message of failed checks contradicts, as a message.

    Args:
        book: the folder of the pages.
        lesson_page: whose checks failed: `l04/lab`.
        message: it has the names of the failed checks in brackets.
    """
    failed, said = set(re.findall(r"\[(\w+)\]", message)), []
    for file in sorted(book.glob("[!_]*/**/*.md")):
        text = file.read_text("utf8")
        front = DECLARED.search(text)
        own = front is not None and "/".join(front.groups()) == lesson_page
        for line, sentence, guard in guarded_sentences(text):
            place, _, check = guard.rpartition(" ")
            if check in failed and (place == lesson_page or (own and not place)):
                name = file.relative_to(book).as_posix()
                said.append(f"{name}, line {line}, says “{sentence}” ({check})")
    return f" Write again what the runs contradict: {'; '.join(said)}." if said else ""
