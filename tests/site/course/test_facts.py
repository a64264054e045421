"""The time and the description of a page."""

from types import SimpleNamespace

import pytest
from built_site import parsed
from docutils import nodes
from docutils.core import publish_doctree

from robo_genesis.core.project import ROOT, engine_pin
from robo_genesis.site.course import facts, sizes


def test_minutes_are_shown_with_their_parts():
    shown = "61 min (45 reading, 16 code and questions)"
    assert str(sizes.Minutes(45, 16)) == shown


def test_a_page_has_both_and_the_home_page_no_time(small_site):
    page, home = parsed(small_site, "described"), parsed(small_site, "index")
    time = page.select_one("h1 + p.page-facts")
    assert time.get_text() == "About 1 min to read."
    assert time.a["href"] == "times.html#minutes"
    assert not home.select(".page-facts")
    (tag,) = page.select('meta[name="description"]')
    assert tag["content"].startswith("A joint’s step & more. word")
    assert tag["content"].endswith("word …")
    assert len(tag["content"]) <= facts.DESCRIPTION


REPOSITORIES = [
    ("", 0),
    ("https://gitlab.com/a/course", 0),
    ("https://github.com/a/course", 1),
]


@pytest.mark.parametrize(("repository", "offered"), REPOSITORIES)
def test_feedback_goes_to_the_form_of_a_repository_on_github(repository, offered):
    config = SimpleNamespace(root_doc="index", course_repository=repository)
    metadata = {"l04/lab": {facts.MINUTES: "1 min"}}
    env = SimpleNamespace(metadata=metadata, domaindata={"std": {"anonlabels": {}}})
    keep = {"doctitle_xform": False}
    document = publish_doctree("Title\n=====\n\nText.", settings_overrides=keep)
    facts.add_facts(SimpleNamespace(config=config, env=env), document, "l04/lab")
    links = [node.astext() for node in document.findall(nodes.raw)]
    assert len(links) == offered
    form = (
        f"issues/new?template={facts.FORM}&amp;page=l04%2Flab%2C+Genesis+{engine_pin()}"
    )
    assert all(f"{repository}/{form}" in link for link in links)
    assert (ROOT / ".github/ISSUE_TEMPLATE" / facts.FORM).is_file()


def test_a_row_shows_a_rounded_time(small_site):
    table = parsed(small_site, "times").select_one("tbody")
    assert [
        [c.get_text(strip=True) for c in row.select("td")] for row in table.select("tr")
    ] == [
        ["Page", "3", "15.6"],
        ["Other", "1", "2.0"],
    ]
