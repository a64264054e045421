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
def test_a_search_from_disk_finds_other_forms_of_a_word(page, small_site):
    problems = errors(page)
    page.goto(f"{(small_site / 'search.html').as_uri()}?q=overshooting")
    results = page.locator("#search-results li > a")
    results.first.wait_for()
    assert results.first.get_attribute("href").partition(".html")[0] == "glossary"
    assert problems == []
