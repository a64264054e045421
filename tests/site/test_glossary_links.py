"""Terms of the glossary are links at their first use on a page, and nowhere else."""

import pytest
from built_site import parsed
from tiny_book import make_book

from robo_genesis.build.built_pages import BuiltPages
from robo_genesis.build.site.render import RenderError, render
from robo_genesis.site import glossary

GLOSSARY = """\
# Glossary

```{glossary}
DOF
degree of freedom
  One axis of motion. It may turn or slide.

overshoot
  How far it passes, counted along its DOF.

PD control
  A law with two gains.
```
"""
PAGE = """\
# Overshoot and DOF

The `DOF` of [an overshoot](glossary.md) is $DOF$.

| DOF |
| :--- |
| overshoot |

Overshoots count as overshoot; a
degree
of freedom is a DOF, two are DOFs. A non-DOF, an *overshoot* more.
"""
FORMS = "forms: {DOF: [DOFs], overshoot: [overshoots]}\nunlinked: []\n"


@pytest.fixture(scope="module")
def html(tmp_path_factory):
    return build(tmp_path_factory.mktemp("terms"))


def build(folder, forms=FORMS):
    book = make_book(folder, glossary=GLOSSARY, page=PAGE)
    (book / glossary.FORMS).write_text(forms)
    return render(book, folder / "staging", BuiltPages(), folder / "render.log")


def links(html, name):
    page = parsed(html, name)
    return page, page.select("a.term-link")


def test_only_first_uses_in_running_text_link_to_their_definitions(html):
    page, found = links(html, "page")
    assert [link.get_text() for link in found] == ["Overshoots", "degree\nof freedom", "DOF"]
    assert all(link.find_parent("p") for link in found)
    assert not page.select("h1 a.term-link, table a.term-link, code a.term-link")
    assert [link["title"] for link in found] == [
        "How far it passes, counted along its DOF.", *["One axis of motion."] * 2,
    ]  # fmt: skip
    entries, _ = links(html, "glossary")
    for link in found:
        file, _, anchor = link["href"].partition("#")
        assert file == "glossary.html"
        assert entries.find(id=anchor).name == "dt"


def test_a_definition_links_other_terms_but_not_itself(html):
    _, found = links(html, "glossary")
    assert [link.get_text() for link in found] == ["DOF"]
    assert found[0]["href"].startswith("#")
    assert found[0].find_parent("dd").find_previous("dt").get_text().startswith("overshoot")


def test_words_are_whole_and_the_longest_term_wins():
    term = glossary.Term("x", "")
    words = glossary.pattern(dict.fromkeys(["PD", "PD control", "DOF"], term))
    assert words.findall("PD  control, PDs, sub-DOF, DOF.") == ["PD  control", "DOF"]
    assert words.findall("PD\ncontrol") == ["PD\ncontrol"]


def test_a_book_without_glossary_has_no_links(tmp_path):
    book = make_book(tmp_path, page="# Page\n\nAn overshoot.\n")
    html = render(book, tmp_path / "staging", BuiltPages(), tmp_path / "render.log")
    assert links(html, "page")[1] == []


def test_declared_names_that_are_not_in_the_glossary_fail_the_build(tmp_path):
    with pytest.raises(RenderError) as caught:
        build(tmp_path, "forms: {gain: [gains]}\nunlinked: [force]")
    for name in ("gain", "force"):
        message = f"glossary_forms.yml names '{name}', which is not in the glossary"
        assert message in str(caught.value)


def test_a_term_can_be_left_unlinked(tmp_path):
    html = build(tmp_path, "forms: {}\nunlinked: [DOF, degree of freedom]\n")
    assert [link.get_text() for link in links(html, "page")[1]] == ["overshoot"]
