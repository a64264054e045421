"""Measured numbers in prose are inserted; `make lint` names those that are typed."""

import pytest

from robo_genesis.site.text.prose_numbers import typed_numbers

CELL = "```{code-cell} ipython3\n---\nalt: peaks at 3.67 rad/s\n---\nx = 0.5\n```\n"
ROLE = "{measured}`l04/lab G2.overshoot 0.5`"


@pytest.mark.parametrize(
    ("text", "typed"),
    [
        ("G2 overshoots by 0.0447 rad, under 9.81 m/s², as 1.5 was chosen.", "0.0447"),
        ("It overshoots by 0.0447rad or so, or by .0447.", ".0447, 0.0447"),
        ("It overshoots by 6e-3 or `0.0448 rad`, or 6.1E+3.", "0.0448, 6.1E+3, 6e-3"),
        (CELL + ROLE, "3.67"),  # an alternative text is prose, code and roles are not
        ("Python 3.11 to 3.13. The fall takes 3.11 s.", "3.11"),
        ("Python 3.11 fell by 3.13 m.", "3.13"),
        ("[3 to 4](page.md#v1.5) of version 1.2.3", ""),
    ],
)
def test_a_typed_measurement_is_found(tmp_path, text, typed):
    for name in ("tests/lessons/l04", "book/lessons/l04"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "tests/lessons/l04/prose_numbers.py").write_text("CONFIGURED = {'step': 1.5}")
    (tmp_path / "book/lessons/l04/lab.md").write_text(text)
    lines = typed_numbers(tmp_path / "book", tmp_path)
    assert [line.partition(". ")[0] for line in lines] == (
        [f"lessons/l04/lab.md types {typed}"] if typed else []
    )
