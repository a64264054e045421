"""The ledger and the pages agree in both directions, and what it offers is what it says."""

import hashlib
import io
import posixpath
import zipfile

import pytest
from bs4 import BeautifulSoup

from robo_genesis.lessons import LESSONS, find_lesson
from robo_genesis.pipeline.bundles.verify import verify_bundle
from robo_genesis.site.evidence.ledger_data import UNMEASURED

pytestmark = pytest.mark.engine
LEDGER = "evidence/ledger.html"
SHOWN = (
    "article :is(img, svg.drawing), .cell_output table, figure table, "
    ".evidence-panel table, .replay-block table, .printed"
)


BEGINNINGS = UNMEASURED | {"printed": "Printed by this run on "}


def place(link: str) -> tuple[str, str]:
    """Return (page, anchor) that a link of the ledger leads to."""
    address, _, anchor = link.partition("#")
    return posixpath.normpath(
        posixpath.join(posixpath.dirname(LEDGER), address)
    ), anchor


@pytest.fixture(scope="module")
def pages(parsed_pages) -> dict[str, BeautifulSoup]:
    """Every page, by its path; the ledger's own tables are not measurements."""
    return {f"{name}.html": page for name, page in parsed_pages.items()}


def test_each_figure_table_and_printed_text_has_one_row_and_each_row_its_place(pages):
    table = pages[LEDGER].select("#figures-and-tables tbody tr")
    rows = [place(row.select_one("td a")["href"]) for row in table]
    shown = set()
    for name, page in pages.items():
        for tag in page.select(
            f":is({SHOWN}):not(.course-map img)"
        ):  # a card repeats a picture
            holder = tag.find_parent("figure") or tag
            shown.add((name, holder.get("id", f"no anchor: {str(tag)[:80]}")))
    assert {*rows} == shown
    assert len(rows) == len(set(rows)) >= 25


def test_each_line_of_provenance_leads_to_the_row_that_leads_back(pages):
    rows = {row["id"]: row for row in pages[LEDGER].select("tr[id]")}
    for name, page in pages.items():
        for line in page.select(".provenance"):
            row = rows[line.select_one("a")["href"].split("#")[1]]
            target, anchor = place(row.select_one("td a")["href"])
            assert target == name
            kind, _, run = (cell.get_text(strip=True) for cell in row.select("td")[1:4])
            runs = [link.text for link in row.select("td")[3].select("a")]
            assert (runs == []) == (run == "no run") == (kind in UNMEASURED)
            assert all(f"run {run}" in line.get_text() for run in runs)
            assert line.get_text().startswith(BEGINNINGS.get(kind, "Measured on "))
            holder = line.find_parent("figure")
            assert holder is None or holder["id"] == anchor
    assert sum(len(page.select(".provenance")) for page in pages.values()) == len(rows)


def test_digests_are_those_of_the_files(site, pages):
    for row in pages[LEDGER].select("#figures-and-tables tbody tr"):
        file = (site / LEDGER).parent / row.select("td")[-1].a["href"]
        assert (
            hashlib.sha256(file.read_bytes()).hexdigest()
            == row.select_one(".digest").text
        )


def test_a_downloaded_bundle_is_accepted_and_has_the_digest_that_is_given(
    site, pages, tmp_path
):
    blocks = [b for b in pages[LEDGER].select(".run-block") if b.select("a")]
    assert len(blocks) == sum(len(find_lesson(name).pages) for name in LESSONS)
    for block in blocks:
        data = ((site / LEDGER).parent / block.a["href"]).read_bytes()
        assert hashlib.sha256(data).hexdigest() == block.select(".digest")[-1].text
        folder = tmp_path / block["id"] / "cpu"
        zipfile.ZipFile(io.BytesIO(data)).extractall(folder)
        assert verify_bundle(folder).run_id[:8] in block.text
