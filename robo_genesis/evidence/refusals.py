"""Refusals of a bundle: a stable code, and a message with found, expected and what to do."""

from collections.abc import Sequence
from typing import Any

from robo_genesis.core.text import printable, quoted

AGAIN = "Record the bundle again."


class BundleRefused(ValueError):  # noqa: N818 - the word of the domain: accepted or refused
    """A bundle is not valid evidence. `code` is stable; the message says what to do.

    The message may quote the bundle: its control characters and line breaks are
    escaped. `differing` has path, recorded and current value of what made it stale.
    """

    def __init__(
        self, code: str, message: str, differing: Sequence[tuple[str, Any, Any]] = ()
    ) -> None:
        self.code, self.message, self.differing = code, printable(message), differing
        super().__init__(f"{code}: {self.message}")


def expect(
    code: str,
    file: str,
    what: str,
    found: object,
    expected: object,
    remedy: str = AGAIN,
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
        here, there = map(quoted, (found, expected))
        message = f"{file}: {what} is {here}, expected {there}. {remedy}"
        raise BundleRefused(code, message)


def expect_equal(code: str, file: str, what: str, found: Any, expected: Any) -> None:
    """Raise BundleRefused with `code` at the first difference of two JSON values.

    Floats may differ by rounding, because another processor computes the last digits
    otherwise.

    Args:
        code: stable name of the refusal.
        file: the file of the bundle that contains the value.
        what: names the entry that differs; `{}` is its path.
        found: the value in the bundle.
        expected: the valid value.
    """
    # A host that only starts a container has no NumPy.
    from robo_genesis.core.comparison import agree, differences

    for path, here, there in differences(found, expected, agree):
        difference = f"{what.format(path)} is {here!r}, expected {there!r}"
        raise BundleRefused(code, f"{file}: {difference}. {AGAIN}")
