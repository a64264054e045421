"""Sentences about one metric of two cases, and values with their units."""

import pytest

from robo_genesis.core.comparison import Comparison, agree, differences
from robo_genesis.core.tables import comparison_sentence
from robo_genesis.core.text import format_value, scaled_value

NAMES = ("G1", "G2")


def test_values_are_written_with_their_unit():
    written = [
        format_value(*of)
        for of in (
            (None, "s"),
            (0.04472, "rad"),
            (87, "N·m"),
            (1, "1"),
            (19, "1"),
            (-1e-5, "rad"),
        )
    ]
    assert written == [
        "not observed",
        "0.0447 rad",
        "87.00 N·m",
        "1 sample",
        "19 samples",
        "0.0000 rad",
    ]


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (0.00447, "mm", "4.47 mm"),
        (0.0123, "%", "1.23 %"),
        (12.345, "mm", "12300 mm"),
        (1e-9, "m", "0.000000001 m"),
    ],
)
def test_a_value_in_another_unit_has_three_digits(value, unit, text):
    assert scaled_value(value, unit) == text


def rise_times(*values, margin=0.0):
    """Compare the rise times of two cases."""
    return Comparison("rise time", "s", *values, 0.005, margin)


@pytest.mark.parametrize(
    ("values", "margin", "says"),
    [
        ((0.4, 0.3), 0, "goes down (G1 0.40 s, G2 0.30 s)."),
        ((0.4, 0.4), 0.015, "does not change measurably (G1 0.40 s, G2 0.40 s)."),
        (
            (0.12, 0.11),
            0.015,
            "is too close to call: G1 0.12 s, G2 0.11 s, within the margin of 0.015 s.",
        ),
        (
            (0.4, None),
            0,
            "was observed for G1 alone (G1 0.40 s, G2 not observed); within this "
            "window G2 is the slower one, by how much is unknown.",
        ),
        (
            (None, None),
            0,
            "was not observed in either case, so this window cannot rank them.",
        ),
    ],
)
def test_a_comparison_says_what_was_measured_or_not_observed(values, margin, says):
    assert (
        comparison_sentence(NAMES, rise_times(*values, margin=margin))
        == f"The rise time {says}"
    )


def test_differences_name_the_path_and_both_values():
    found = differences({"a": {"b": 1, "c": [2]}}, {"a": {"b": None, "c": [2]}, "d": 3})
    assert list(found) == [("a.b", 1, None), ("d", "absent", 3)]
    found = differences({"a": 0.1, "b": 11}, {"a": 0.1 + 1e-15, "b": 11.0}, agree)
    assert list(found) == [("b", 11, 11.0)]
