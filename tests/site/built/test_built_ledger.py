"""Each item of a page leads to its run in the ledger, whose bundle is what the ledger says."""

import hashlib
import io
import zipfile

import pytest

from robo_genesis.lessons import LESSONS, find_lesson
from robo_genesis.pipeline.bundles.verify import verify_bundle
from robo_genesis.site.evidence.provenance import MEASURED, PRINTED, WITHOUT_RUN

pytestmark = pytest.mark.engine
LEDGER = "evidence/ledger"
SHOWN = (
    "article :is(img, svg.drawing), .cell_output table, figure table, "
    ".evidence-panel table, .replay-block table, .printed"
)


@pytest.fixture(scope="module")
def blocks(parsed_pages):
    """The ledger's entry of each run, by its anchor."""
    return {block["id"]: block for block in parsed_pages[LEDGER].select(".run-block")}


def test_each_figure_table_and_printed_text_has_a_line_that_leads_to_its_run(
    parsed_pages, blocks
):
    for name, page in parsed_pages.items():
        items = page.select(f":is({SHOWN}):not(.course-map img)")
        lines = page.select(".provenance")
        holders = {id(item.find_parent("figure") or item) for item in items}
        assert len(lines) == len(holders), name
        for line in lines:
            text = line.get_text(strip=True)
            if text in WITHOUT_RUN.values():
                assert not line.a
                continue
            assert text.startswith((MEASURED, PRINTED)), name
            block = blocks[line.a["href"].split("#")[1]]
            assert f"run {block.td.find_next('td').text}" in text


def test_a_downloaded_bundle_is_accepted_and_has_the_digest_that_is_given(
    site, blocks, tmp_path
):
    accepted = [block for block in blocks.values() if block.select("a")]
    assert len(accepted) == sum(len(find_lesson(name).pages) for name in LESSONS)
    for block in accepted:
        data = ((site / LEDGER).parent / block.a["href"]).read_bytes()
        assert hashlib.sha256(data).hexdigest() == block.select(".digest")[-1].text
        folder = tmp_path / block["id"] / "cpu"
        zipfile.ZipFile(io.BytesIO(data)).extractall(folder)
        assert verify_bundle(folder).run_id[:8] in block.text
