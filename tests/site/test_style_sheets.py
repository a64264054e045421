"""The theme's sheets keep what a page or a script can use, and lose the rest."""

import pytest

from robo_genesis.site import style_sheets

SHEET = """\
.used > a, .unused > a { color: red }
#by-id { color: red }
.added-by-script.show { color: red }
.unused { color: red }
#unused-id { color: red }
details[open] > summary { color: red }
"""


@pytest.fixture
def trimmed(tmp_path):
    sheet = tmp_path / "_static/styles/pydata-sphinx-theme.css"
    sheet.parent.mkdir(parents=True)
    sheet.write_text(SHEET)
    (sheet.parent / "own.css").write_text(SHEET)
    (tmp_path / "_static/menu.js").write_text('menu.classList.add("added-by-script", "show");')
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep/page.html").write_text('<p class="other used">unused</p><b id="by-id"></b>')
    style_sheets.trim_sheets(tmp_path)
    return tmp_path


def test_rules_for_names_that_no_page_and_no_script_has_go(trimmed):
    text = (trimmed / style_sheets.SHEETS[0]).read_text()
    assert "unused" not in text
    for kept in (".used > a", "#by-id", ".added-by-script.show", "details[open] > summary"):
        assert f"{kept} {{ color: red }}" in text


def test_other_sheets_are_not_changed(trimmed):
    assert (trimmed / "_static/styles/own.css").read_text() == SHEET


def test_a_second_run_changes_nothing(trimmed):
    before = (trimmed / style_sheets.SHEETS[0]).read_text()
    style_sheets.trim_sheets(trimmed)
    assert (trimmed / style_sheets.SHEETS[0]).read_text() == before


def test_a_failing_tool_is_named_with_its_output(tmp_path, monkeypatch):
    (tmp_path / "_static").mkdir()
    (tmp_path / "_static/sphinx-design.min.css").write_text(".a { color: red }")
    monkeypatch.setattr(style_sheets, "PURGE", "purgecss/bin/missing.js")
    with pytest.raises(style_sheets.ProjectError, match=r"PurgeCSS failed:[\s\S]*missing\.js"):
        style_sheets.trim_sheets(tmp_path)
