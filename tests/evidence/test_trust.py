"""Each rule on the page about trust is one that a spoiled bundle breaks, and the reverse."""

import re

from spoilers import CARELESS, DAMAGED

from robo_genesis.core import project

PAGE = (project.BOOK / "evidence" / "trust.md").read_text("utf8")
RULES = re.findall(r"^\| .+ \| (`.+) \|$", PAGE, re.MULTILINE)
CODES = {code for cell in RULES for code in re.findall(r"`([a-z-]+)`", cell)}

# Its test spoils the page of a bundle.
ELSEWHERE = "shown"


def test_the_codes_on_the_page_are_those_of_the_spoiled_bundles():
    tested = {code for code, _ in (DAMAGED | CARELESS).values()}
    assert tested | {ELSEWHERE} == CODES
    assert len(PAGE.split()) <= 900
