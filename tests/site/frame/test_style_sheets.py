"""The joined sheet keeps what a page or a script can use, and loses the rest of the theme."""

from bs4 import BeautifulSoup

from robo_genesis.site.frame import style_sheets

SHEET = """\
.used > a, .unused > a { color: red }
#by-id { color: red }
.added-by-script.show { color: red }
.unused { color: red }
#unused-id { color: red }
details[open] > summary { color: red }
"""
FIRST, THEME, OWN = "_static/basic.css", style_sheets.SHEETS[1], "_static/course.css"


def test_the_joined_sheet_keeps_order_addresses_and_used_rules(tmp_path):
    (tmp_path / "_static/styles").mkdir(parents=True)
    (tmp_path / THEME).write_text(SHEET + ".used { src: url(../vendor/a.woff2) }")
    (tmp_path / FIRST).write_text(".used { background: url('file.png') url(data:x) }")
    (tmp_path / OWN).write_text(".unused { color: blue }")
    (tmp_path / "_static/menu.js").write_text(
        'menu.classList.add("added-by-script", "show");'
    )
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep/page.html").write_text(
        '<p class="other used">unused</p><b id="by-id"></b>'
    )
    style_sheets.join_sheets(tmp_path)
    joined = (tmp_path / style_sheets.JOINED).read_text()
    theme, own = joined.split(".unused { color: blue }")
    assert own == ""
    assert "unused" not in theme
    for kept in (
        ".used > a",
        "#by-id",
        ".added-by-script.show",
        "details[open] > summary",
    ):
        assert f"{kept} {{ color: red }}" in theme
    assert joined.index("url('../file.png')") < joined.index("url(../vendor/a.woff2)")
    assert "url(data:x)" in joined


def test_a_page_has_one_link_and_keeps_the_sheets_that_are_not_joined():
    names = [style_sheets.IMPORTING, *style_sheets.SHEETS, "_static/math.css"]
    links = "".join(f'<link rel="stylesheet" href="../{name}?v=1"/>' for name in names)
    page = BeautifulSoup(f"<head>{links}</head>", "html.parser")
    style_sheets.link_joined(page)
    found = [link["href"] for link in page.select("link")]
    assert [address.partition("?")[0] for address in found] == [
        f"../{style_sheets.JOINED}",
        "../_static/math.css",
    ]
