"""The title of a link to a term is its definition."""

from built_site import parsed


def test_a_link_to_a_term_has_its_definition_as_title(small_site):
    entries, page = parsed(small_site, "glossary"), parsed(small_site, "terms")
    links = page.select("a.term-link")
    assert [(link.get_text().split(), link["title"]) for link in links] == [
        (["Overshoots"], "How far it passes, counted along its DOF."),
        (["degree", "of", "freedom"], "One axis of motion."),
    ]
    for link in links:
        file, _, anchor = link["href"].partition("#")
        assert file == "glossary.html"
        assert entries.find(id=anchor).name == "dt"
    (own,) = entries.select("a.term-link")
    assert (own["href"][0], own["title"]) == ("#", "One axis of motion.")
