"""Terms of the glossary are links at their first use on a page, and nowhere else."""

from built_site import parsed

from robo_genesis.site.text import glossary


def links(html, name):
    page = parsed(html, name)
    return page, page.select("a.term-link")


def test_only_first_uses_in_running_text_link_to_their_definitions(small_site):
    page, found = links(small_site, "terms")
    assert [link.get_text() for link in found] == [
        "Overshoots",
        "degree\nof freedom",
        "DOF",
    ]
    assert all(link.find_parent("p") for link in found)
    assert not page.select("h1 a.term-link, table a.term-link, code a.term-link")
    assert [link["title"] for link in found] == [
        "How far it passes, counted along its DOF.",
        *["One axis of motion."] * 2,
    ]
    assert (
        "A step is a time step." in page.article.get_text()
    )  # a term that is not linked
    entries, own = links(small_site, "glossary")
    for link in found:
        file, _, anchor = link["href"].partition("#")
        assert file == "glossary.html"
        assert entries.find(id=anchor).name == "dt"
    assert [(link.get_text(), link["href"][0]) for link in own] == [
        ("DOF", "#")
    ]  # not itself


def test_words_are_whole_and_the_longest_term_wins():
    term = glossary.Term("x", "")
    words = glossary.pattern(dict.fromkeys(["PD", "PD control", "DOF"], term))
    assert words.findall("PD  control, PDs, sub-DOF, DOF.") == ["PD  control", "DOF"]
    assert words.findall("PD\ncontrol") == ["PD\ncontrol"]
