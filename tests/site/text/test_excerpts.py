"""Excerpts show what code does; what its docstrings say is in the prose around them."""

import pytest

from robo_genesis.site.text.excerpts import without_docstrings

FUNCTION = '''\
    def first(x):
        """Return one.

        Args:
            x: anything.
        """

        text = """kept"""
        return 1  # a comment
'''


@pytest.mark.parametrize(
    ("code", "shown"),
    [
        (FUNCTION, FUNCTION[:18] + FUNCTION[FUNCTION.index("        text") :]),
        ('A = 1\n"""What A is."""\nB = 2\n', "A = 1\nB = 2\n"),
        (
            'class A:\n    """Doc."""\n\n    b: int\n    """Doc."""\n',
            "class A:\n    b: int\n",
        ),
        (
            'def empty():\n    """Only this."""\n',
            'def empty():\n    """Only this."""\n',
        ),
        ("cut = (\n", "cut = (\n"),
    ],
)
def test_docstrings_are_left_out_and_other_lines_stay(code, shown):
    assert without_docstrings(code) == shown
