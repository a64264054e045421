"""Questions as HTML that `_static/choice.js` makes lively."""

from collections.abc import Sequence
from html import escape

from robo_genesis.site.evidence.plain_nodes import between


class question(between):  # noqa: N801 - docutils names nodes in lower case
    """A question; its text is between the parts that the build writes."""


def choice(
    name: str, answer: str, origin: str, options: Sequence[tuple[str, bool, str]]
) -> question:
    """Return a multiple choice, in which each option has its feedback, which choice.js announces.

    Args:
        name: of its fields, unique on the page.
        answer: what was measured.
        origin: of the measurement.
        options: (text, right, cause) of each option.
    """
    answer = escape(answer)
    rows = [
        f'<div><input type="radio" name="{name}" id="{name}-{k}"/>'
        f'<label for="{name}-{k}">{escape(text)}</label>'
        f'<p class="feedback {"right" if right else "wrong"}">{"Yes" if right else "No"}. '
        f"{f'{escape(cause)} ' if cause else ''}{answer}</p></div>"
        for k, (text, right, cause) in enumerate(options)
    ]
    right = next(text for text, is_right, _ in options if is_right)
    return _question("", "".join(rows), f"<strong>{escape(right)}</strong>. {answer}", origin)


def number(
    name: str, answer: str, origin: str, value: float, tolerance: float, unit: str,
    feedback: Sequence[tuple[str, str]],
) -> question:  # fmt: skip
    """Return a question for a number; choice.js shows the feedback that fits what is typed.

    Args:
        name: of its field, unique on the page.
        answer: what was measured.
        origin: of the measurement.
        value: the right number.
        tolerance: how far from it a number counts as right.
        unit: of the number, empty for none.
        feedback: (key, text) by the keys of the directive.
    """
    texts = "".join(
        f'<p class="feedback {"right" if key == "right" else "wrong"}" data-key="{key}">'
        f"{escape(text)}</p>"
        for key, text in feedback
    )
    in_unit = f" in {escape(unit)}" if unit else ""
    field = (
        f'<div class="number"><label for="{name}">Your number{in_unit}</label>'
        f'<input type="number" step="any" inputmode="decimal" id="{name}"/>{texts}</div>'
    )
    attributes = f' data-value="{value!r}" data-tolerance="{tolerance!r}"'
    return _question(attributes, field, escape(answer), origin)


def _question(attributes: str, inside: str, answer: str, origin: str) -> question:
    """Return a question with a place for announcements and the answer in a fold."""
    closing = (
        f'</legend>{inside}<output class="visually-hidden" aria-live="polite"></output>'
        f"<details><summary>Answer</summary><p>{answer}</p>"
        f'<p class="origin">{escape(origin)}.</p></details></fieldset>'
    )
    return question(opening=f'<fieldset class="choice"{attributes}><legend>', closing=closing)
