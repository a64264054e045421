"""Changes to a page after the theme wrote it, on small pages."""

import pytest
from bs4 import BeautifulSoup
from PIL import Image

from robo_genesis.site.frame.postprocess import finish_page

HEAD = """\
<script data-cfasync="false">document.documentElement.dataset.mode = "auto";</script>
<script src="documentation_options.js?v=1"></script>
<script>var option = 1;</script>
<script>DOCUMENTATION_OPTIONS.pagename = "page";</script>
<script src="scripts/fontawesome.js" defer></script>
<script src="explorer.js"></script>
<script src="other.js" type="module"></script>"""


def page(tmp_path, body: str, head: str = "") -> BeautifulSoup:
    html = f"<!DOCTYPE html><html><head>{head}</head><body>{body}</body></html>"
    return BeautifulSoup(finish_page(html, tmp_path), "html.parser")


EXPLORERS = [
    ("<p>Text</p>", []),
    ('<div class="explorer"></div>', [("explorer.js", True, None)]),
]


@pytest.mark.parametrize(("body", "explorer"), EXPLORERS)
def test_script_files_wait_and_what_needs_them_waits_behind_them(
    tmp_path, body, explorer
):
    scripts = page(tmp_path, body, HEAD).select("script")
    how = [(s.get("src"), s.has_attr("defer"), s.get("type")) for s in scripts]
    assert how == [
        (None, False, None),
        ("documentation_options.js?v=1", True, None),
        (None, False, None),
        (None, False, "module"),
        *explorer,
        ("other.js", False, "module"),
    ]


def test_light_or_dark_is_decided_by_the_script_in_the_head(tmp_path):
    theme = '<script>document.documentElement.dataset.theme = "auto";</script>'
    found = page(tmp_path, "<script>1</script>", theme)
    assert found.html["data-theme"] == "light"  # for a reader without scripts
    first, second = (script.get_text() for script in found.select("script"))
    assert "matchMedia" in first
    assert second == "1"


@pytest.mark.parametrize(
    ("given", "anchor"), [("", "page-title"), (" id='index'", "index")]
)
def test_a_page_is_first_shown_with_its_title(tmp_path, given, anchor):
    found = page(tmp_path, f"<article><h1{given}>Title</h1></article>")
    (link,) = found.select("head > link[rel=expect][blocking=render]")
    assert (link["href"], found.h1["id"]) == (f"#{anchor}", anchor)


def test_images_get_their_size_and_wait_until_they_are_in_sight(tmp_path):
    Image.new("RGB", (30, 20)).save(tmp_path / "a b.png")
    frame = (
        '<svg xmlns="http://www.w3.org/2000/svg" width="9" height="6"><image/></svg>'
    )
    (tmp_path / "x.svg").write_text(frame)
    body = (
        '<article><img src="a%20b.png"/><img src="x.svg"/><img src="x.svg" width="9"/>'
    )
    images = page(tmp_path, body).select("img")
    sizes = [(i["width"], i.get("height"), i["loading"]) for i in images]
    assert sizes == [("30", "20", "lazy"), ("9", "6", "lazy"), ("9", None, "lazy")]


def test_a_drawing_without_a_size_is_named(tmp_path):
    (tmp_path / "x.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"/>')
    with pytest.raises(ValueError, match=r"x\.svg states no size"):
        page(tmp_path, '<article><img src="x.svg"/></article>')


def test_controls_are_named_by_what_they_show_and_the_sidebar_is_a_landmark(tmp_path):
    found = page(
        tmp_path,
        '<button class="search-button-field" aria-label="Search">Search <kbd>K</kbd></button>'
        '<details class="hide"><summary aria-label="Toggle hidden content">Show source</summary>'
        '</details><button aria-label="Color mode"><i class="fa-solid fa-sun"></i></button>'
        '<div id="pst-primary-sidebar"><nav class="bd-docs-nav"><ul><li><a href="#">L04: joints</a>'
        "<details><summary><i class='fa-solid fa-chevron-down'></i></summary></details></li></ul>",
    )
    labels = [tag.get("aria-label") for tag in found.select("button, summary")]
    assert labels == [None, None, "Color mode", "Pages below L04: joints"]
    assert found.select_one("i")["aria-hidden"] == "true"
    assert found.select_one("[role=complementary]")["aria-label"] == "Course"


def test_markup_outside_of_what_is_mended_comes_through(tmp_path):
    body = "<pre>\n  two\n\n lines &lt; three</pre><math><mi>x</mi></math><p>a<br/>b — c</p>"
    assert body in finish_page(
        f"<!DOCTYPE html><html><body>{body}</body></html>", tmp_path
    )
