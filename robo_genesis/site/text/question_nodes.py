"""Questions as HTML that `_static/choice.js` makes lively."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from robo_genesis.core.markup import filled
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
    return _question("", name=name, answer=answer, origin=origin, options=options)


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
    attributes = f' data-value="{value!r}" data-tolerance="{tolerance!r}"'
    given = {"name": name, "answer": answer, "origin": origin, "unit": unit}
    return _question(attributes, **given, feedback=feedback)


def _question(attributes: str, **values: Any) -> question:
    """Return a question with a place for announcements and the answer in a fold."""
    closing = filled(Path(__file__).with_name("question.html"), **values)
    return question(opening=f'<fieldset class="choice"{attributes}><legend>', closing=closing)
