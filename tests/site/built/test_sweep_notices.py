"""A home page that breaks every rule of the sweep: each rule must complain of its own."""

import random
from pathlib import Path

import pytest
from built_site import CompressingHandler, served
from sweep import BUDGET, KINDS, RULES, Visit

pytestmark = [pytest.mark.engine, pytest.mark.browser]

PIXEL = "data:image/gif;base64,R0lGODlhAQABAIAAAP///wAAACwAAAAAAQABAAACAkQBADs="
ELSEWHERE = "https://example.org/pixel.png"
SMALL = "display: block; height: 8px; width: 8px; padding: 0; overflow: hidden"

SCROLLS = "overflow-x: auto; width: 50px"
WIDE = "<span style='display: block; width: 900px'>wide</span>"


def on_load(code: str) -> str:
    return f"<script>addEventListener('load', () => {code})</script>"


# Rule, what it complains of, and the markup that breaks it, at the end of the head or
# article.
SPOILS = [
    (
        "axe",
        "image-alt",
        f"<details><summary>fold</summary><img src='{PIXEL}'></details>",
    ),
    ("axe", "color-contrast", "<p style='color: #aaa; background: #fff'>pale</p>"),
    (
        "axe",
        "target-size",
        f"<a href='#1' style='{SMALL}'>1</a><a href='#2' style='{SMALL}'>2</a>",
    ),
    (
        "blocking scripts",
        "plot.js",
        "<script src='_static/plot.js?early'></script></head>",
    ),
    (
        "focus",
        "unseen",
        "<button id='unseen' style='outline: none !important'>unseen</button>",
    ),
    ("foreign hosts", ELSEWHERE, f"<img src='{ELSEWHERE}' alt=''>"),
    ("images", "without a size", f"<img src='{PIXEL}' alt='' loading='lazy'>"),
    ("images", "loaded at once", f"<img src='{PIXEL}' alt='' width='1' height='1'>"),
    (
        "images",
        "empty",
        "<img src='missing.png' alt='' width='9' height='9' loading='lazy'>",
    ),
    (
        "images",
        "another shape",
        f"<img src='{PIXEL}' alt='' width='90' height='9' loading='lazy'>",
    ),
    (
        "layout shift",
        "<",  # the first of what moves; the browser decides which that is
        on_load(
            "requestAnimationFrame(() => {"
            " document.querySelector('article').style.marginTop = '300px'; })"
        ),
    ),
    ("lines", "long", "<p id='long' style='width: 900px; max-width: none'>long</p>"),
    ("messages", "404: ", "<script src='missing.js' defer></script>"),
    (
        "messages",
        "an uncaught error",
        "<script>throw new Error('an uncaught error')</script>",
    ),
    (
        "motion",
        "moves",
        "<p id='moves' style='transition: color 1s !important'>moves</p>",
    ),
    (
        "scroll boxes",
        "unreached",
        f"<div id='unreached' style='{SCROLLS}'>{WIDE}</div>",
    ),
    ("tab order", "tabindex", "<a href='#' tabindex='3'>first</a>"),
    ("theme", "grey", on_load("{ document.documentElement.dataset.theme = 'grey'; }")),
    ("weight", "index.html", f"<!-- {random.Random(0).randbytes(BUDGET).hex()} -->"),
    (
        "width",
        "sticks-out",
        "<p id='sticks-out' style='width: 5000px; max-width: none'>wide</p>",
    ),
    # The last, because it ends the article.
    ("axe", "region", "</article></main><p>outside of all landmarks</p>"),
]


class SpoilingHandler(CompressingHandler):
    def read(self, path: Path) -> bytes:
        data = super().read(path)
        if path.name != "index.html":
            return data
        for end in (b"</head>", b"</article>"):
            texts = [
                text
                for *_, text in SPOILS
                if (end == b"</head>") == ("</head>" in text)
            ]
            data = data.replace(end, "".join(texts).encode(), 1)
        return data


@pytest.fixture(scope="module")
def address(site):
    with served(site, SpoilingHandler) as address:
        yield address


@pytest.fixture(scope="module")
def spoiled(browser, address) -> dict[str, list[str]]:
    return Visit(browser, address, "index.html", KINDS["light"]).wrong


def test_every_rule_is_broken():
    assert {rule for rule, *_ in SPOILS} == {*RULES}


@pytest.mark.parametrize(
    ("rule", "complaint"), [(rule, text) for rule, text, _ in SPOILS]
)
def test_a_page_that_breaks_a_rule_is_noticed(spoiled, rule, complaint):
    assert [text for text in spoiled[rule] if complaint in text], spoiled[rule]
