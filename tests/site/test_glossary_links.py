"""Terms of the glossary are links at their first use on a page, and nowhere else."""

import pytest
from built_site import parsed
from tiny_book import make_book

from robo_genesis.pipeline.html.render import render
from robo_genesis.pipeline.html.sphinx_process import SphinxProcess
from robo_genesis.pipeline.pages.built import BuiltPages
from robo_genesis.site.text import glossary

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

step
time step
  What one call of the solver covers.
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

A step is a time step.
"""
FORMS = "forms: {DOF: [DOFs], overshoot: [overshoots]}\nunlinked: [step, time step]\n"


@pytest.fixture(scope="module")
def html(tmp_path_factory):
    folder = tmp_path_factory.mktemp("terms")
    book = make_book(folder, glossary=GLOSSARY, page=PAGE)
    (book / glossary.FORMS).write_text(FORMS)
    sphinx = SphinxProcess(book, folder / "render.log")
    return render(sphinx, folder / "staging", BuiltPages()).html


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


def test_a_term_can_be_left_unlinked(html):
    page, found = links(html, "page")
    assert "A step is a time step." in page.article.get_text()
    assert not [link for link in found if "step" in link.get_text()]
