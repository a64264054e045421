"""A page runs the scripts that the course knows; each other way to run one is named and refused."""

import base64
import hashlib

import pytest

from robo_genesis.pipeline.html import scripts
from robo_genesis.pipeline.html.checks import Site, run_checks

KNOWN = "let known = 1;"
PAGE = "<!DOCTYPE html><html><head>{head}</head><body><article>{body}</article></body></html>"


@pytest.fixture
def site(tmp_path, monkeypatch):
    digest = hashlib.sha256(KNOWN.encode()).hexdigest()[:16]
    monkeypatch.setattr(scripts, "KNOWN", {digest: "of this test"})
    for folder in ("_static", "_downloads", "replay", "sub"):
        (tmp_path / folder).mkdir()
    for name in ("_static/a.js", "searchindex.js"):
        (tmp_path / name).touch()
    model = base64.b64encode(b"glTF").decode()
    line = f'(globalThis.replayModels ??= {{}})["replay-a"] = "{model}";\n'
    (tmp_path / "replay/a.js").write_text(line)
    (tmp_path / "index.html").write_text(PAGE.format(head="", body=""))
    return tmp_path


def problems(site, body="", head="", name="index.html") -> list[str]:
    (site / name).write_text(PAGE.format(head=head, body=body))
    (found,) = [
        check for check in run_checks(Site(site, "/course/")) if check.name == "scripts"
    ]
    return list(found.problems)


@pytest.mark.parametrize(
    "body",
    [
        f"<script>{KNOWN}</script>",
        "<script type=\"module\">DOCUMENTATION_OPTIONS.pagename = 'index';</script>",
        '<script type="application/json">{"a": [1, "b"]}</script>',
        '<script defer="" src="_static/a.js?v=1"></script><script src="searchindex.js"></script>',
        '<script src="/course/_static/a.js"></script>',
        '<div data-model="replay/a.js"></div>',
        '<button onclick="window.print()">Print</button>',
        '<img alt="a &lt;script&gt; in words" src="a.png"><p>javascript and onclick= in words</p>',
        "<svg><image xlink:href='data:image/png;base64,iVBORw0KGgo='/></svg>",
        '<meta http-equiv="content-type" content="text/html">',
    ],
)
def test_scripts_of_the_theme_and_of_the_course_are_known(site, body):
    assert problems(site, body) == []


@pytest.mark.parametrize(
    ("body", "said"),
    [
        (
            "<script>alert(1)</script>",
            "is not known: 'alert(1)'. If it is new in the theme",
        ),
        ("<script/x>alert(1)</script>", "is not known"),
        (
            "<script>DOCUMENTATION_OPTIONS.pagename = 'index';alert(1);</script>",
            "is not known",
        ),
        (f"<svg><g><svg:script>{KNOWN}</svg:script></g></svg>", "inside a drawing"),
        (
            '<script type="text/javascript">alert(1)</script>',
            "has the type 'text/javascript'",
        ),
        ('<script type="application/json">alert(1)</script>', "not plain JSON"),
        ('<script type="application/json">["<!--<script>"]</script>', "not plain JSON"),
        (
            '<script type="application/json" src="_static/a.js"></script>',
            "has the type",
        ),
        ('<script src="_static/../_downloads/a.js"></script>', "is not known"),
        ('<script src="//example.org/_static/a.js"></script>', "is not known"),
        ('<script src="/_static/a.js"></script>', "'/_static/a.js' is not known"),
        ('<script src="_static/a.js">alert(1)</script>', "is not known"),
        ('<img src="a.png" alt="<script>alert(1)</script>">', "has 1 times '<script'"),
        ("<!-- <script>alert(1)</script> -->", "has 1 times '<script'"),
        (
            '<p title="</noscript><img src=x onerror=alert(1)>">x</p>',
            "a tag contains '<'",
        ),
        ("<!--> <img src=x onerror=alert(1)> -->", "a comment ends early"),
        ("<!-- a --!> <img src=x onerror=alert(1)> -->", "early"),
        ('<img src="a.png" alt="a" onerror="alert(1)">', "onerror='alert(1)'"),
        (
            '<button onclick="window.print();alert(1)">x</button>',
            "<button> has onclick=",
        ),
        ('<a onclick="window.print()">x</a>', "<a> has onclick="),
        ('<a href=" JaVa&#10;Script:alert(1)">x</a>', "can run script"),
        ('<svg><a xlink:href="javascript:alert(1)">x</a></svg>', "can run script"),
        (
            '<svg><set attributeName="href" to="javascript:alert(1)"/></svg>',
            "can run script",
        ),
        ('<a href="data:image/svg+xml;base64,PHN2Zz4=">x</a>', "can run script"),
        ('<iframe src="sub/"></iframe>', "<iframe> is not allowed"),
        ('<iframe srcdoc="&lt;script&gt;alert(1)"></iframe>', "a document of its own"),
        (
            "<svg><foreignObject></foreignObject></svg>",
            "<foreignobject> is not allowed",
        ),
        ('<base href="https://example.org/">', "<base> is not allowed"),
        (
            '<meta http-equiv="Refresh" content="0; url=a.html">',
            "<meta> leads to another page",
        ),
        (
            '<div class="replay" data-viewer="_downloads/a.js"></div>',
            "is not a script of replay/",
        ),
    ],
)
def test_every_other_way_to_run_script_is_refused(site, body, said):
    found = problems(site, body)
    assert [
        line for line in found if line.startswith("index.html: ") and said in line
    ], found


def test_a_script_in_the_head_and_of_another_page_is_named_with_its_page(site):
    head = "<script>DOCUMENTATION_OPTIONS.pagename = 'sub/a';</script>"
    assert problems(site, head=head, name="sub/a.html") == []
    (line,) = problems(site, head="<script>alert(1)</script>", name="sub/b.html")
    assert line.startswith("sub/b.html: the inline script ")


SVG = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:x="http://www.w3.org/1999/xlink">{}</svg>'


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("_downloads/a.js", "", "the build writes no such script"),
        ("replay/model-viewer.js", "alert(1)", "the build writes no such script"),
        (
            "replay/b.js",
            '(globalThis.replayModels ??= {})["a"] = "YQ==";\nalert(1)\n',
            "no such",
        ),
        ("_downloads/a.xhtml", "", "may run script in it"),
        ("a.HTML", "", "may run script in it"),
        (
            "a.svg",
            SVG.format(
                '<s:script xmlns:s="http://www.w3.org/2000/svg">alert(1)</s:script>'
            ),
            "contains a script",
        ),
        ("a.svg", SVG.format('<g onload="alert(1)"/>'), "<g> has onload="),
        ("a.svg", SVG.format('<a x:href="javascript:alert(1)"/>'), "can run script"),
        (
            "a.svg",
            '<!DOCTYPE svg [<!ENTITY a "b">]>' + SVG.format("&a;"),
            "declares entities",
        ),
        (
            "a.svg",
            '<?xml-stylesheet href="a.xsl"?>' + SVG.format(""),
            "declares entities",
        ),
        ("a.svg", "<svg><p></svg>", "is not XML"),
    ],
)
def test_other_files_that_a_browser_could_run_are_refused(site, name, content, said):
    (site / name).write_text(content)
    (line,) = problems(site)
    assert line.startswith(f"{name}: ")
    assert said in line


def test_plain_drawings_and_a_sitemap_are_no_problem(site):
    (site / "a.svg").write_text(f'<?xml version="1.0"?>{SVG.format("<g/>")}')
    (site / "sitemap.xml").write_text("<urlset/>")
    assert problems(site) == []
