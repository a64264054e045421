"""Refusals of a bundle, and text that others wrote, made safe for messages and pages.

A refusal has a stable code, and a message with found, expected and what to do.
"""

from robo_genesis.core.text import quoted

AGAIN = "Record the bundle again."

LINE_LIMIT = 2**14
"""Characters of one line of the engine's log, and of one warning. Most have less than 400."""

BLANK = "\n\t\N{NO-BREAK SPACE}\N{ZERO WIDTH JOINER}"
"""Characters of a message that are not printable by themselves."""


class BundleRefused(ValueError):  # noqa: N818 - the word of the domain: accepted or refused
    """A bundle is not valid evidence. `code` is stable; the message says what to do.

    The message may quote the bundle: its control characters and line breaks are escaped.
    """

    def __init__(self, code: str, message: str) -> None:
        self.code, self.message = code, printable(message)
        super().__init__(f"{code}: {self.message}")


def expect(
    code: str, file: str, what: str, found: object, expected: object, remedy: str = AGAIN
) -> None:
    """Raise BundleRefused with `code` unless `found` equals `expected`.

    Args:
        code: stable name of the refusal.
        file: the file of the bundle that contains the value.
        what: the value's name.
        found: the value in the bundle.
        expected: the valid value.
        remedy: what to do.
    """
    if found != expected:
        raise unexpected(code, file, what, found, expected, remedy)


def unexpected(
    code: str, file: str, what: str, found: object, expected: object, remedy: str = AGAIN
) -> BundleRefused:
    """Return the refusal of a value; see `expect`."""
    here, there = quoted(found), quoted(expected)
    if here == there:  # they differ in later digits
        here, there = repr(found), repr(expected)
    return BundleRefused(code, f"{file}: {what} is {here}, expected {there}. {remedy}")


def printable(text: str) -> str:
    r"""Return text as one line that a terminal shows and does not obey.

    Line breaks, control characters, reversed directions and other invisible characters become
    escapes such as `\x1b`.
    """
    odd = (c for c in {*text} if not c.isprintable())
    return text.translate({ord(c): c.encode("unicode_escape").decode() for c in odd})


def clean_message(text: str, limit: int) -> str:
    """Return a message of several lines without control characters, shortened to a length."""
    plain = "".join(
        c if c.isprintable() or c in BLANK else "\N{REPLACEMENT CHARACTER}" for c in text
    )
    return plain if len(plain) <= limit else f"{plain[: limit - 1]}…"
