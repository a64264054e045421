"""A new process of Python: its output, and errors that say how it ended."""

import pytest

from robo_genesis.sim.fresh_process import StartError, run_python


def test_it_prints_with_the_changed_environment():
    code = "import os; print(os.environ['GIVEN'])"
    assert run_python(["-c", code], {"GIVEN": "a value"}) == "a value\n"


@pytest.mark.parametrize(
    ("code", "message"),
    [
        ("", "exit status 0, expected 0 or 2 and some output"),
        (
            "print('begun'); nothing",
            r"status 1, expected 0 or 2 (.|\n)*begun\n(.|\n)*NameError",
        ),
    ],
)
def test_another_status_or_no_output_is_an_error_with_the_last_lines(code, message):
    assert (
        run_python(["-c", "print('broken'); raise SystemExit(2)"], {}, (0, 2))
        == "broken\n"
    )
    with pytest.raises(StartError, match=message):
        run_python(["-c", code], {}, (0, 2))
