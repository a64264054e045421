import pytest
from watching import errors

from robo_genesis.site.frame.search import SearchNames


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("reads joint4", ["reads", "joint4"]),
        ("set_dofs_kp()", ["set_dofs_kp", "dofs_kp", "kp"]),
        ("__init__", ["__init__", "init__"]),
        ("q_", ["q_"]),
    ],
)
def test_a_name_is_found_by_its_ends(text, found):
    assert SearchNames({}).split(text) == found


@pytest.mark.browser
@pytest.mark.parametrize(
    ("query", "first"),
    [
        ("overshot", "glossary"),  # which has overshoot
        ("joint’s szep", "described"),  # both words, one of them with a wrong letter
        ("Why does a word lead?", "lessons/l06-six/lecture"),
        ("word", "described"),  # by its title's place in the alphabet
    ],
)
def test_a_letter_may_be_wrong_and_a_question_leads_to_a_lecture(
    page, small_site, query, first
):
    problems = errors(page)
    page.goto(f"{(small_site / 'search.html').as_uri()}?q={query}")
    results = page.locator("#search-results li > a")
    results.first.wait_for()
    assert results.first.get_attribute("href").partition(".html")[0] == first
    assert problems == []
