"""Each problem of a built site is found by its check alone."""

from pathlib import Path

import pytest

from robo_genesis.core.project import PACKAGES, ROOT
from robo_genesis.pipeline.html.checks import POLICY, run_checks

HEAD = f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">'
PAGE = "<!DOCTYPE html><html><head>{head}</head><body id='top-of-page'>{body}</body>"
GOOD = """\
<h1 id="home">Home</h1><a href="#home">self</a> <a href="sub/page.html#part">page</a>
<a href="https://example.org/away">away</a> <a href="mailto:a@example.org">mail</a>
<a href="#">top</a><link rel="canonical" href="https://a.org/">
<img src="picture.png" alt="Joint angle over time, three cases">
<pre>{eval}`x` in code is fine</pre>"""


def make_site(folder: Path, body: str = GOOD, head: str = HEAD) -> Path:
    """Write a site of three pages, and return the folder of its HTML."""
    html = folder / "html"
    (html / "sub").mkdir(parents=True)
    pages = {
        "index": PAGE.format(head=head, body=body),
        "sub/page": PAGE.format(head=HEAD, body="<p id='part'>Part</p>"),
        "sub/index": PAGE.format(head=HEAD, body="<a href='../index.html#top'>up</a>"),
    }
    for name, text in pages.items():
        (html / f"{name}.html").write_text(text)
    (html / "picture.png").touch()
    return html


def problems(html: Path, base: str = "/") -> dict[str, list[str]]:
    return {check: lines for check, lines in run_checks(html, base).items() if lines}


def test_a_good_site_passes(tmp_path):
    assert problems(make_site(tmp_path)) == {}


@pytest.mark.parametrize(
    ("body", "check", "said"),
    [
        ('<a href="gone.html">x</a>', "links", "'gone.html' leads to no file"),
        ('<a href="sub/page.html#gone">x</a>', "links", "no element of sub/page.html"),
        ('<a href="sub/">x</a>', "links", "leads to no file"),
        ('<p id="a"></p><p id="a"></p>', "anchors", "two elements have the id 'a'"),
        ('<img src="picture.png">', "alt texts", "picture.png has the alt text ''"),
        ('<img src="picture.png" alt="figure.png">', "alt texts", "'figure.png'"),
        ('<img src="picture.png" alt="picture">', "alt texts", "'picture'"),
        ('<svg class="drawing" aria-label=""></svg>', "alt texts", "alt text ''"),
        ("<p>A word[^note].</p>", "leftovers", "[^note]"),
        ("<p>{glue:text}`overshoot`</p>", "leftovers", "{glue:text}"),
        ("<p>&lt;Figure size 640x480&gt;</p>", "leftovers", "Figure size"),
        (f"<p>{ROOT}/book</p>", "private paths", str(ROOT)),
        (f"<p>{Path.home()}/a</p>", "private paths", str(Path.home())),
        (f"<p>{PACKAGES}/a.py</p>", "private paths", "names /"),
    ],
)
def test_each_problem_is_found_by_its_check_alone(tmp_path, body, check, said):
    found = problems(make_site(tmp_path, body))
    assert list(found) == [check]
    (line,) = found[check]
    assert line.startswith(("index.html: ", "html/index.html: "))
    assert said in line


def test_each_page_has_the_policy_that_forbids_other_hosts(tmp_path):
    (line,) = problems(make_site(tmp_path, head=""))["third parties"]
    assert "index.html: has no Content-Security-Policy" in line


@pytest.mark.parametrize(
    ("href", "reason"),
    [
        ("/course/sub/page.html#part", None),
        ("/course/gone.html", "leads to no file of the site."),
        ("/sub/page.html", "leads out of /course/, the path of the site."),
    ],
)
def test_addresses_from_the_root_begin_with_the_path_of_the_site(
    tmp_path, href, reason
):
    html = make_site(tmp_path, body=f'<a href="{href}">a page</a>')
    expected = {"links": [f"index.html: {href!r} {reason}"]} if reason else {}
    assert problems(html, "/course/") == expected
