"""The page of reference has the marked tables of all lessons, and their links lead from there."""

from built_site import parsed


def test_marked_tables_are_below_the_title_of_their_lesson(small_site):
    page = parsed(small_site, "calls")
    titles = [title.find(string=True) for title in page.select("article h2")]
    assert titles == ["L04: Four", "L06: Six"]
    (table,) = page.select("table")
    assert table.find_parent("section")["id"] == "l06"
    assert table.td.button.get_text() == "DOF"
    assert table.td.a["href"] == "glossary.html#term-DOF"
