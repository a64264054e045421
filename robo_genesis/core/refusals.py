"""Refusals of a bundle: a stable code, and a message with found, expected and what to do."""

import re

from robo_genesis.core.messages import printable

AGAIN = "Record the bundle again."
LONGEST_SHOWN = 160


class BundleRefused(ValueError):  # noqa: N818 - the word of the domain: accepted or refused
    """A bundle is not valid evidence. `code` is stable; the message says what to do.

    The message may quote the bundle: its control characters and line breaks are escaped.
    """

    def __init__(self, code: str, message: str) -> None:
        self.code, self.message = code, printable(message)
        super().__init__(f"{code}: {self.message}")


def shown(value: object) -> str:
    """Return the repr of a value, shortened for a message."""
    text = repr(value)
    if re.fullmatch("'[0-9a-f]{64}'", text):
        return f"{text[:13]}…'"
    return text if len(text) <= LONGEST_SHOWN else f"{text[:LONGEST_SHOWN]}…"


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
        raise BundleRefused(
            code, f"{file}: {what} is {shown(found)}, expected {shown(expected)}. {remedy}"
        )
