"""A browser that hangs does not stop the tests."""

import pytest
from browsers import answered
from playwright.sync_api import Error

pytestmark = pytest.mark.browser


def test_a_browser_that_hangs_is_killed_and_a_new_one_is_asked_once(browser):
    asked = []
    answers = iter(
        ["no_such_name", "while (true) {}", "'answer'", *["while (true) {}"] * 2]
    )

    def ask(of):
        asked.append(of)
        return of.new_page().evaluate(next(answers))

    with pytest.raises(
        Error, match="no_such_name"
    ):  # what else goes wrong is an error at once
        answered(browser, ask)
    new, answer = answered(browser, ask, patience=2)
    assert (answer, asked, browser.is_connected()) == (
        "answer",
        [browser, browser, new],
        False,
    )
    with pytest.raises(Error, match="closed"):
        answered(new, ask, patience=2)
    assert len(asked) == 5
