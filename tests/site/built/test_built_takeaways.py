"""What the lab's page offers to take away, as it stands in the built site."""

import pytest

from robo_genesis.core import project

pytestmark = pytest.mark.engine
LAB = "lessons/l04-joint-control/lab"
FOLDER = "takeaways/l04-lab"


def test_the_page_links_every_file_with_its_size(site, parsed_pages):
    links = parsed_pages[LAB].select("a.takeaway")
    files = {(site / LAB).parent.joinpath(link["href"]).resolve() for link in links}
    there = {path for path in (site / FOLDER).rglob("*") if path.is_file()}
    there |= {path for path in (site / "takeaways").iterdir() if path.is_file()}
    assert files == there
    constraints = (site / "takeaways" / "constraints.txt").read_text()
    assert constraints == (project.ROOT / "requirements.lock").read_text()
    for link in links:
        size = (site / LAB).parent.joinpath(link["href"]).stat().st_size
        assert str(link.next_sibling).startswith(f" ({max(1, round(size / 1000))} kB)")


def test_figures_are_those_of_the_page(site, parsed_pages):
    page = parsed_pages[LAB]
    figures = {figure["id"] for figure in page.select("figure[id]")}
    drawn = {path.stem: path.read_text() for path in (site / FOLDER).glob("*.svg")}
    assert drawn.keys() == figures
    assert all("<svg" in text for text in drawn.values())
    for name, text in drawn.items():
        shown = page.select_one(f"#{name} :is(img, svg)")
        image = (site / LAB).parent.joinpath(shown.get("src") or shown["data-file"])
        assert image.read_text() == text
