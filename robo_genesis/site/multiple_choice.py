"""Multiple choice whose right answer was measured.

A page asks how one metric of a case compares with that of another. The right option is read from
the accepted bundle when the page is rendered, so it cannot become stale:

    ```{choice} l04/lecture rise_time G1 G2
    When does G2 reach 90 % of its step?
    ```
"""

from html import escape
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robo_genesis.build.built_pages import page_outputs
from robo_genesis.core.comparison import compare_values, comparison_sentence
from robo_genesis.evidence import bundle
from robo_genesis.lessons.registry import find_lesson
from robo_genesis.site.evidence.measured import BACKEND, measured

EARLIER = {"lower": "earlier", "equal": "at the same sample", "higher": "later"}
LOWER = {"lower": "less", "equal": "the same, within the lesson's resolution", "higher": "more"}
CLOSE = "too close to call, within the margin of {} {}"
UNDECIDED = "this window cannot tell"
"""The relation of the second case to the first, in a reader's words."""


class choice(nodes.General, nodes.Element):  # noqa: N801 - docutils names nodes in lower case
    """A question; `options` are (text, right), `answer` and `origin` describe the measurement."""


class Choice(SphinxDirective):
    """Ask how the second of two cases compares with the first in one metric."""

    required_arguments = 4
    has_content = True

    def run(self) -> list[nodes.Node]:
        """Return the question with its options; an unknown page, case or metric is an error."""
        lesson_page, metric, *cases = self.arguments
        try:
            order, unit, answer, origin = measured_order(lesson_page, metric, cases)
        except (LookupError, bundle.BundleRefused) as error:
            raise self.error(f"choice: {error}") from error
        question, messages = self.parse_inline(" ".join(self.content), lineno=self.lineno)
        number = self.env.new_serialno("choice")
        margin = declared_margin(lesson_page.split("/")[0], metric)
        shown = {"number": number, "options": options(unit, order, margin), "answer": answer}
        return [choice("", *question, **shown, origin=origin), *messages]


def measured_order(
    lesson_page: str, metric: str, cases: list[str]
) -> tuple[str | None, str, str, str]:
    """Return (order of the second case relative to the first, unit, sentence, provenance).

    Raises:
        LookupError: the metric or a case is not in the bundle; the message lists the known ones.
        BundleRefused: the bundle cannot be read.
    """
    _, origin = (measured(lesson_page, f"{case}.{metric}")[1] for case in cases)
    records = bundle.read_metrics(page_outputs(lesson_page) / BACKEND)
    first, second = (records[case][metric] for case in cases)
    lesson = find_lesson(lesson_page.split("/")[0])
    noun, resolution = lesson.about_metrics("noun")[metric], lesson.spec.RESOLUTION
    values, margin = (first.value, second.value), declared_margin(lesson_page.split("/")[0], metric)
    found = compare_values(noun, first.unit, *values, resolution, margin)
    return found.order, found.unit, comparison_sentence((cases[0], cases[1]), found), origin


def declared_margin(lesson: str, metric: str) -> float:
    """Return the margin that a lesson declares for orderings of a metric, 0 if it declares none."""
    found = (m for _, name, _, m in find_lesson(lesson).spec.RELATIONS if name == metric)
    return max(found, default=0.0)


def options(unit: str, order: str | None, margin: float = 0.0) -> list[tuple[str, bool]]:
    """Return each option and whether it was measured; exactly one is true."""
    words = dict(EARLIER if unit == "s" else LOWER)
    if margin:
        words["equal"] = CLOSE.format(f"{margin:g}", "samples" if unit == "1" else unit)
    return [*((text, order == name) for name, text in words.items()), (UNDECIDED, order is None)]


def visit_choice(self: Any, node: choice) -> None:
    """Open the question; its text follows."""
    self.body.append('<fieldset class="choice"><legend>')


def depart_choice(self: Any, node: choice) -> None:
    """Write the options, each with its feedback, and the answer in a fold; no script is needed."""
    name, answer = f"choice-{node['number']}", escape(node["answer"])
    rows = [
        f'<div><input type="radio" name="{name}" id="{name}-{k}"/>'
        f'<label for="{name}-{k}">{escape(text)}</label>'
        f'<p class="feedback {"right" if right else "wrong"}">{"Yes" if right else "No"}. {answer}'
        "</p></div>"
        for k, (text, right) in enumerate(node["options"])
    ]
    right = next(text for text, is_right in node["options"] if is_right)
    self.body.append(
        f"</legend>{''.join(rows)}<details><summary>Answer</summary>"
        f"<p><strong>{escape(right)}</strong>. {answer}</p>"
        f'<p class="origin">{escape(node["origin"])}.</p></details></fieldset>'
    )


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("choice", Choice)
    app.add_node(choice, html=(visit_choice, depart_choice))
