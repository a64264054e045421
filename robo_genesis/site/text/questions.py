"""Questions whose right answer was measured: multiple choice, or a number with a tolerance.

A page asks how one metric of a case compares with that of another, or for the value of
a metric. The right answer is read from the accepted bundle when the page is rendered,
so it cannot become stale. A list below the question gives the cause for each answer; it
may be left out:

    ```{choice} l04/lecture rise_time G1 G2
    When does G2 reach 90 % of its step?

    - lower: Both runs deliver 87 N·m until 0.07 s, so KP cannot matter before that.
    - unknown: Both runs reach 90 % in this window.
    ```

    ```{number} l04/lecture G2.overshoot
    :tolerance: 20
    How large is the overshoot of G2?

    - low: Saturation makes the overshoot larger than the linear formula says.
    - x57.3: That is in degrees.
    ```

The keys are lower, equal, higher and unknown, or right, low and high. The tolerance is
in percent; it may be below one. `:unit: mm` asks for a length in millimetres, other units
for their thousandths, and `:unit: episodes` for a count.
A key as `x57.3` belongs to a typical wrong answer: the value times this factor.

No reader should find the answer beside the question, so a question is one of these, and
the build refuses any other:

- blind: `{replay}` with `:blind:` follows directly, and shows the run after an answer;
- `:hides:`: whatever follows in its section, with subsections, figures and outputs,
  shows after an answer. The section's end is the marked place: a heading ends it earlier;
- `:calculation:`: it follows from inputs that are given, and no result of it is in sight;
- `:explained:`: it asks about an earlier lesson, and names the section that explains it,
  for after the answer, in Markdown: `` :explained: {ref}`a contact <l03>` ``;
- `:absent:`: a choice for a second case that no page of the lesson records, so that
  unknown is right; its cause says which measurement would tell.
"""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from docutils import nodes
from docutils.parsers.rst.directives import flag, unchanged
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform
from sphinx.util import logging

from robo_genesis.core.comparison import Comparison
from robo_genesis.core.files import json_digest
from robo_genesis.core.markup import filled
from robo_genesis.core.tables import comparison_sentence
from robo_genesis.core.text import SCALED, format_value
from robo_genesis.evidence import bundle
from robo_genesis.lessons import find_lesson
from robo_genesis.pipeline.pages.page_index import page_bundle
from robo_genesis.pipeline.pages.values import value_of
from robo_genesis.site.evidence.plain_nodes import WRITERS, between, html
from robo_genesis.site.evidence.values import COUNTED, measured
from robo_genesis.site.figures.case_labels import label
from robo_genesis.site.pages import PageDirective

# The options by order; `{}` is the smallest difference that counts.
LOWER = {"lower": "less", "equal": "the same (to {})", "higher": "more"}
EARLIER = {"lower": "earlier", "equal": "at the same time", "higher": "later"}
CLOSE = "about the same (less than {} apart)"
UNDECIDED = "this record cannot tell"
UNKNOWN = "unknown"  # The key of the option that no order was observed

# The keys of an answer that is a number, and its feedback.
JUDGED = {"right": "Yes.", "low": "Too low.", "high": "Too high."}
AGAIN = "Try another number, or open the answer."  # A wrong number without a cause
CAUSE = re.compile(r"[-*] +([\w.]+): +(.+)", re.DOTALL)

# The key of a typical wrong number: the value times this factor.
FACTOR = re.compile(r"x\d+(\.\d+)?")
QUESTIONS = "questions"  # In the metadata of a page: the facts of each, by its name

# Below a question; `course.css` hides what follows it.
HIDES = '<p class="after-answer">The text goes on here when you have answered.</p>'

# The options of a question that say why its answer is not in sight; see above.
KINDS: dict[str, Any] = {"hides": flag, "calculation": flag, "explained": unchanged}
IN_SIGHT = (
    "the answer of this question may be in sight. Add `:hides:` if results follow in its "
    "section, let a `{replay}` with `:blind:` follow directly, or add `:calculation:` if it "
    "follows from given inputs, or `:explained:` if it is about an earlier lesson."
)

logger = logging.getLogger(__name__)


class question(between):  # noqa: N801 - docutils names nodes in lower case
    """A question; its text is between the parts that the build writes."""


def asked(**facts: Any) -> question:
    """Return a question: a multiple choice, or for a number if the right `value` is given.

    `choice.js` announces the feedback of the chosen option, or that which fits what is
    typed.

    Args:
        facts: `name` of its fields, unique on the page; `answer`, what was measured,
            and its `origin`. Of a choice also `options`, for each one (text, right,
            cause). Of a number its `value`, `tolerance` and `unit`, empty for none, and
            `feedback`, (key, text) by the keys of the directive.
    """
    whole = filled(Path(__file__).with_name("question.html"), **facts)
    opening, closing = whole.split("TEXT", 1)
    return question(opening=opening, closing=closing)


def split_causes(
    content: Sequence[str], keys: Sequence[str]
) -> tuple[str, dict[str, str]]:
    """Return the question, and the cause of each answer that has one.

    Args:
        content: lines; each cause begins a line with `- key:`.
        keys: the valid keys, besides that of a typical wrong number.

    Raises:
        LookupError: a key is not valid or given twice; the message lists the valid
            ones.
    """
    text, *items = re.split(r"\n(?=[-*] )", "\n".join(content))
    causes: dict[str, str] = {}
    for item in map(str.strip, items):
        parts = CAUSE.fullmatch(item)
        key, cause = parts.groups() if parts else ("", "")
        known = key in keys or FACTOR.fullmatch(key)
        if not known or key in causes:
            valid = ", ".join(f"`- {key}: …`" for key in keys)
            raise LookupError(f"{item!r} is not a cause. Valid, once each: {valid}.")
        causes[key] = " ".join(cause.split())
    return " ".join(text.split()), causes


class Question(PageDirective):
    """Ask for something that was measured."""

    has_content = True

    def shown(self) -> list[nodes.Node]:
        """Return the question, which the course's list of questions then has too.

        One about an earlier lesson is left out where the checkout lacks this lesson.
        """
        folder = f"lessons/{self.arguments[0].partition('/')[0]}-"
        here = any(name.startswith(folder) for name in self.env.found_docs)
        if "explained" in self.options and not here:
            return []
        text, facts = self.ask()
        # By its words, so that it stays when the question moves.
        name = f"question-{json_digest(text)[:8]}"
        node = asked(name=name, **facts)
        node["kinds"] = [kind for kind in (*KINDS, "absent") if kind in self.options]
        self.set_source_info(node)
        words, messages = self.parse_inline(text, lineno=self.lineno)
        node += words
        known = self.env.metadata[self.env.docname].setdefault(QUESTIONS, {})
        known[name] = {"text": "".join(word.astext() for word in words), **facts}
        after = [html(HIDES)] if "hides" in self.options else []
        if section := self.options.get("explained"):
            link, more = self.parse_inline(section, lineno=self.lineno)
            line = nodes.paragraph("", "Explained in ", *link, classes=["explained"])
            after, messages = [line, *after], messages + more
        return [node, *messages, *after]

    def ask(self) -> tuple[str, dict[str, Any]]:
        """Return the question's text, and its facts; see `asked`."""
        raise NotImplementedError


class Choice(Question):
    """Ask how the second of two cases compares with the first in one metric."""

    required_arguments = 4
    option_spec = KINDS | {"absent": flag}

    def ask(self) -> tuple[str, dict[str, Any]]:
        """See `Question.ask`."""
        text, causes = split_causes(self.content, [*LOWER, UNKNOWN])
        page, metric, *cases = self.arguments
        measure, answer, origin = measured_order(
            page, metric, cases, absent="absent" in self.options
        )
        shown = options(measure, causes)
        return text, {"options": shown, "answer": answer, "origin": origin}


class Number(Question):
    """Ask for the value of one metric."""

    required_arguments = 2
    option_spec = KINDS | {"tolerance": float, "unit": unchanged}

    def ask(self) -> tuple[str, dict[str, Any]]:
        """See `Question.ask`."""
        text, causes = split_causes(self.content, [*JUDGED])
        percent, unit = self.options["tolerance"], self.options.get("unit", "")
        page, name = self.arguments
        return text, asked_number(page, name, percent, causes, unit)


def asked_number(
    lesson_page: str,
    name: str,
    percent: float,
    causes: Mapping[str, str],
    unit: str = "",
) -> dict[str, Any]:
    """Return the facts of a question for a number; see `asked`.

    Args:
        lesson_page: as `l04/lab`.
        name: `case.metric`.
        percent: the tolerance relative to the value.
        causes: texts by `JUDGED` or a factor, any of them.
        unit: of the answer, if it is the thousandth of the metric's.

    Raises:
        LookupError: there is no such metric, or it has no value.
        BundleRefused: the bundle cannot be read.
    """
    text, origin = measured(lesson_page, f"{name} {unit}".strip())
    value, own_unit, _ = value_of(page_bundle(lesson_page), name)
    if value is None:
        raise LookupError(f"{lesson_page} did not observe {name}. Ask with {{choice}}.")
    if own_unit == "1" and not unit:
        text = f"{value:g}"
    verdicts = JUDGED | {key: "No." for key in causes if key not in JUDGED}
    if unit and unit not in COUNTED:
        value *= 1000
    return {
        "value": value,
        "tolerance": abs(value) * percent / 100,
        "unit": unit or ("" if own_unit == "1" else own_unit),
        "feedback": [
            (key, f"{verdict} {causes.get(key, AGAIN * (key != 'right'))}".strip())
            for key, verdict in verdicts.items()
        ],
        "answer": f"{text}; answers within {percent:g} % count as right."
        if value
        else f"{text}, exactly.",
        "origin": origin,
    }


def measured_order(
    lesson_page: str, metric: str, cases: list[str], absent: bool = False
) -> tuple[Comparison, str, str]:
    """Return (comparison of the two cases, sentence, provenance).

    Args:
        lesson_page: as `l04/lab`.
        metric: its name.
        cases: names of both.
        absent: whether no page of the lesson may record the second case; no order is
            known then.

    Raises:
        LookupError: the metric or a case is not in the bundle, and the message lists
            the known ones; or the second case is, and must be absent.
        BundleRefused: the bundle cannot be read.
    """
    lesson_name = lesson_page.split("/")[0]
    lesson = find_lesson(lesson_name)
    if absent and any(cases[1] in page.runs for page in lesson.pages.values()):
        raise LookupError(
            f"{lesson_name} records {cases[1]}; ask for it without `:absent:`."
        )
    for case in cases[:1] if absent else cases:
        _, origin = measured(lesson_page, f"{case}.{metric}")
    records = bundle.read_metrics(page_bundle(lesson_page))
    unit = records[cases[0]][metric].unit
    first, second = (None if absent else records[case][metric].value for case in cases)
    noun = lesson.about_metrics("noun")[metric]
    measure = Comparison(
        noun,
        unit,
        first,
        second,
        lesson.spec.RESOLUTION[unit],
        declared_margin(lesson_name, metric),
    )
    if absent:
        return measure, f"The record of {lesson_page} has no such run.", origin
    names = (label(lesson_name, cases[0]), label(lesson_name, cases[1]))
    return measure, measured_sentence(names, measure), origin


def measured_sentence(names: tuple[str, str], measure: Comparison) -> str:
    """Return a sentence with the values of one metric in two cases."""
    if measure.first is None or measure.second is None:
        return comparison_sentence(names, measure)
    values, unit = (measure.first, measure.second), measure.unit
    texts = [format_value(value, unit) for value in values]
    if unit in ("m", "rad", "m/s") and any(0 < abs(value) < 0.1 for value in values):
        scaled = (round(1000 * value, 3) + 0.0 for value in values)
        texts = [f"{value:.3g} {SCALED[unit]}" for value in scaled]
    noun = measure.label[0].upper() + measure.label[1:]
    sentence = f"{noun}: {texts[0]} for {names[0]}, {texts[1]} for {names[1]}."
    if measure.order == "equal" and measure.margin and values[0] != values[1]:
        sentence += f" A difference below {small(measure.margin, unit)} does not count."
    return sentence


def small(value: float, unit: str) -> str:
    """Return a margin or a resolution with its unit, in thousandths where it is small."""
    if unit in SCALED and value < 0.1:
        value, unit = 1000 * value, SCALED[unit]
    return f"{value:g} {'samples' if unit == '1' else unit}"


def declared_margin(lesson: str, metric: str) -> float:
    """Return the margin that a lesson declares for orderings of a metric, 0 if it declares none."""
    relations = find_lesson(lesson).spec.RELATIONS
    return max(
        (margin for _, name, _, margin in relations if name == metric), default=0.0
    )


def options(
    measure: Comparison, causes: Mapping[str, str]
) -> list[tuple[str, bool, str]]:
    """Return each option, whether it was measured, and its cause; exactly one is true.

    Args:
        measure: the two cases.
        causes: the cause of each answer by its key, or a part of them.
    """
    unit = measure.unit
    words = dict(EARLIER if unit == "s" else LOWER)
    if measure.margin:
        words["equal"] = CLOSE.format(small(measure.margin, unit))
    elif unit == "1":
        words["equal"] = "the same"
    else:
        words["equal"] = words["equal"].format(small(measure.resolution, unit))
    words[UNKNOWN] = UNDECIDED
    right = measure.order or UNKNOWN
    return [(text, key == right, causes.get(key, "")) for key, text in words.items()]


class RequireKinds(SphinxTransform):
    """Warn of each question whose answer may be in sight."""

    default_priority = 199

    def apply(self, **kwargs: object) -> None:
        """Look at questions and at what follows them directly."""
        for node in self.document.findall(question):
            after = node.next_node(descend=False, siblings=True)
            blind = isinstance(after, nodes.container) and "growing" in after["classes"]
            if not (node["kinds"] or blind):
                logger.warning(IN_SIGHT, location=node)


def setup(app: Sphinx) -> None:
    """Register the directives, and what requires that no answer is in sight."""
    app.add_transform(RequireKinds)
    app.add_directive("choice", Choice)
    app.add_directive("number", Number)
    app.add_node(question, html=WRITERS)
