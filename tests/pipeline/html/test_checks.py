from pathlib import Path

import pytest

from robo_genesis.pipeline.html.checks import QUOTING, Site, run_checks

PAGE = "<!DOCTYPE html><html><head>{head}</head><body><article id='top-of-page'>{body}</article>"
GOOD = """\
<h1 id="home">Home</h1><a href="#home">self</a> <a href="sub/page.html#part">page</a>
<a href="https://example.org/away">away</a> <a href="mailto:a@example.org">mail</a>
<a href="#">top</a> <a href="sub/">folder</a>
<img src="picture.png" alt="Joint angle over time, three cases">
<pre>{eval}`x` in code is fine</pre>"""
GOOD += "".join(
    f"<ul class='a {name}'><li>{{a}}`b` $$ [[1 2]]</li></ul>" for name in QUOTING
)


def make_site(folder: Path, body: str = GOOD, head: str = "") -> Path:
    (folder / "sub").mkdir()
    (folder / "index.html").write_text(PAGE.format(head=head, body=body))
    (folder / "sub/page.html").write_text(
        PAGE.format(head="", body="<p id='part'>Part</p>")
    )
    (folder / "sub/index.html").write_text(
        PAGE.format(head="", body="<a href='../#top'>up</a>")
    )
    (folder / "picture.png").touch()
    (folder / "style.css").write_text(
        "/* url(https://a.org/x) */ p { src: url(picture.png) }"
    )
    return folder


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
    make_site(tmp_path, body=f'<a href="{href}">a page</a>')
    links = run_checks(Site(tmp_path, "/course/"))[0]
    assert links.problems == ((f"index.html: {href!r} {reason}",) if reason else ())


def problems(folder: Path) -> dict[str, tuple[str, ...]]:
    return {
        check.name: check.problems
        for check in run_checks(Site(folder))
        if check.problems
    }


def test_a_good_site_passes_and_everything_was_looked_at(tmp_path):
    checks = {check.name: check for check in run_checks(Site(make_site(tmp_path)))}
    assert [*checks] == ["links", "alt texts", "third parties", "scripts", "leftovers"]
    assert not any(check.problems for check in checks.values())
    assert checks["links"].count == 7
    assert checks["alt texts"].count == 1


LINKED = (
    ('<a href="gone.html">x</a>', "'gone.html' leads to no file"),
    ('<a href="sub/page.html#gone">x</a>', "names no element of sub/page.html"),
    ('<a href="../outside.html">x</a>', "leads to no file"),
    (
        '<img srcset="picture.png 1x, gone.png 2x" alt="A picture">',
        "'gone.png' leads to no",
    ),
    ('<p style="background: url(gone.svg)">x</p>', "'gone.svg' leads to no file"),
)
ALT_TEXTS = ("", 'alt=""', 'alt="figure.png"', 'alt="picture"')
LOADED = (
    '<script src="https://cdn.example.org/x.js"></script>',
    '<link rel="stylesheet" href="https://fonts.example.org/a.css">',
    "<style>@import 'https://fonts.example.org/a.css';</style>",
    '<script>const url = "https://unpkg.com/thebe@0.8.2/lib/index.js"</script>',
    '<img src="https://img.example.org/a.png" alt="A picture of it">',
)
MARKUP = (
    '<div class="system-message">Unknown role</div>',
    "<p>{glue:text}`overshoot`</p>",
    r"<p>\(x = 1\)</p>",
    "<p>&lt;Figure size 640x480 with 1 Axes&gt;</p>",
)


@pytest.mark.parametrize(
    ("body", "check", "said"),
    [
        *((body, "links", said) for body, said in LINKED),
        *(
            (f'<img src="picture.png" {alt}>', "alt texts", "has the alt text")
            for alt in ALT_TEXTS
        ),
        (
            '<svg class="drawing" aria-label=""></svg>',
            "alt texts",
            "has the alt text ''",
        ),
        *((body, "third parties", "") for body in LOADED),
        *((body, "leftovers", "") for body in MARKUP),
    ],
)
def test_each_problem_is_found_by_its_check_alone(tmp_path, body, check, said):
    found = problems(make_site(tmp_path, body))
    if check == "third parties":
        found.pop("scripts", None)  # it knows none of these scripts and frames
    assert list(found) == [check]
    (line,) = found[check]
    assert line.startswith("index.html: ")
    assert said in line


def test_style_sheets_and_script_files_are_searched(tmp_path):
    site = make_site(tmp_path)
    (site / "style.css").write_text("@import url('https://fonts.googleapis.com/css');")
    (site / "theme.js").write_text(
        'load("https://cdn.jsdelivr.net/x.js"); // "https://a.org/"'
    )
    assert problems(site)["third parties"] == (
        "style.css: https://fonts.googleapis.com/css",
        "theme.js: https://cdn.jsdelivr.net/x.js",
    )


def test_links_that_browsers_do_not_load_are_no_request(tmp_path):
    head = '<link rel="canonical" href="https://example.org/"><meta content="https://example.org">'
    assert problems(make_site(tmp_path, head=head)) == {}
