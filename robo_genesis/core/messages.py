"""Text that others wrote, such as the engine's log, made safe for terminals, files and pages."""

LINE_LIMIT = 2**14
"""Characters of one line of the engine's log, and of one warning. Most have less than 400."""

BLANK = "\n\t\N{NO-BREAK SPACE}\N{ZERO WIDTH JOINER}"
"""Characters of a message that are not printable by themselves."""


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
