"""The outputs of a page whose cells are not those of its last run."""

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_notebook

from robo_genesis.pipeline.pages.page_folder import NOTEBOOK
from robo_genesis.pipeline.pages.page_index import (
    LAST_OUTPUTS,
    PageIndex,
    executed_notebook,
    measuring_page,
)


@pytest.mark.parametrize(
    ("now", "counts"),
    [
        ("abxc", [1, 2, None, 3]),
        ("bc", [2, 3]),
        ("axc", [1, 2, 3]),
        ("axyc", [1, None, None, 3]),
    ],
    ids=["added", "removed", "changed", "changed and added"],
)
def test_a_cell_gets_the_outputs_of_the_cell_with_its_source(
    tmp_path, monkeypatch, now, counts
):
    ran = [new_code_cell(name, execution_count=k) for k, name in enumerate("abc", 1)]
    nbformat.write(new_notebook(cells=ran), tmp_path / NOTEBOOK)
    told = PageIndex(folders={"page": tmp_path}).write(tmp_path / "told")
    for name, value in (told | {LAST_OUTPUTS: "1"}).items():
        monkeypatch.setenv(name, value)
    page = new_notebook(cells=[new_code_cell(name) for name in now])
    found = executed_notebook("page", page).cells
    assert [cell.source for cell in found] == list(now)
    assert [cell.execution_count for cell in found] == counts


def test_a_page_without_a_bundle_guards_nothing_by_itself(tmp_path, monkeypatch):
    pages = PageIndex(
        folders={"lab": tmp_path / "lab", "text": tmp_path / "text"},
        outputs={"l04/lab": tmp_path / "lab/outputs"},
    )
    monkeypatch.setenv(*pages.write(tmp_path / "told").popitem())
    assert measuring_page("lab") == "l04/lab"
    for name in ("text", "gone"):
        with pytest.raises(LookupError, match=f"{name} measures nothing"):
            measuring_page(name)
