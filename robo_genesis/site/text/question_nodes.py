"""Questions in a doctree, and as HTML that `_static/choice.js` makes lively."""

from html import escape
from typing import Any

from docutils import nodes


class choice(nodes.General, nodes.Element):  # noqa: N801 - docutils names nodes in lower case
    """A question; `options` are (text, right, cause), `answer` and `origin` what was measured."""


class number(choice):  # noqa: N801
    """A question for a number: `value`, `tolerance` and `unit`, with (key, text) as `feedback`."""


def visit_question(self: Any, node: choice) -> None:
    """Open the question; its text follows."""
    attributes = ""
    if isinstance(node, number):
        attributes = f' data-value="{node["value"]!r}" data-tolerance="{node["tolerance"]!r}"'
    self.body.append(f'<fieldset class="choice"{attributes}><legend>')


def depart_choice(self: Any, node: choice) -> None:
    """Write the options, each with its feedback, which choice.js also announces."""
    name, answer = f"choice-{node['number']}", escape(node["answer"])
    rows = [
        f'<div><input type="radio" name="{name}" id="{name}-{k}"/>'
        f'<label for="{name}-{k}">{escape(text)}</label>'
        f'<p class="feedback {"right" if right else "wrong"}">{"Yes" if right else "No"}. '
        f"{f'{escape(cause)} ' if cause else ''}{answer}</p></div>"
        for k, (text, right, cause) in enumerate(node["options"])
    ]
    right = next(text for text, is_right, _ in node["options"] if is_right)
    close(self, node, "".join(rows), f"<strong>{escape(right)}</strong>. {answer}")


def depart_number(self: Any, node: number) -> None:
    """Write the field; choice.js shows the feedback that fits the number."""
    name = f"choice-{node['number']}"
    texts = "".join(
        f'<p class="feedback {"right" if key == "right" else "wrong"}" data-key="{key}">'
        f"{escape(text)}</p>"
        for key, text in node["feedback"]
    )
    unit = f" in {escape(node['unit'])}" if node["unit"] else ""
    field = (
        f'<div class="number"><label for="{name}">Your number{unit}</label>'
        f'<input type="number" step="any" inputmode="decimal" id="{name}"/>{texts}</div>'
    )
    close(self, node, field, escape(node["answer"]))


def close(self: Any, node: choice, inside: str, answer: str) -> None:
    """End a question: what is inside, a place for announcements, and the answer in a fold."""
    self.body.append(
        f'</legend>{inside}<output class="visually-hidden" aria-live="polite"></output>'
        f"<details><summary>Answer</summary><p>{answer}</p>"
        f'<p class="origin">{escape(node["origin"])}.</p></details></fieldset>'
    )
