"""Each page of the site is visited on a desktop and on a dark phone; then the rules ask.

The spoiled home page in `test_sweep_notices.py` proves that each rule can fail.
"""

import functools
import time
from collections.abc import Callable
from dataclasses import replace

import pytest
from browsers import answered
from built_site import CompressingHandler, served
from sweep import EVERY_STATE, IN_EVERY_COLOUR, KINDS, STILL, Kind, Visit
from watching import SCRIPTS, SERVED_ONLY, call, page_names

pytestmark = [pytest.mark.engine, pytest.mark.browser]


# Its results come one after the other, so they move the page and weigh what all pages
# weigh.
FOUND = "search.html?q=joint"


def of(kind: Kind, name: str) -> Kind:
    return replace(kind, rules=IN_EVERY_COLOUR) if name == FOUND else kind


@pytest.fixture(scope="module")
def visits(browser, site, unpacked):
    """Visit all pages in a way of `KINDS`: out of the archive on the phone, else from a server."""
    names = [*page_names(site), FOUND]
    assert {*names} > EVERY_STATE
    with served(site, CompressingHandler) as address:

        @functools.cache
        def visited(way: str) -> dict[str, Visit]:
            disk = unpacked.as_uri() if way == "phone" else address
            found, last = {}, browser
            for name in names:
                base = address if name in SERVED_ONLY else disk
                visit = functools.partial(
                    Visit, base=base, name=name, kind=of(KINDS[way], name)
                )
                last, found[name] = answered(last, visit)
            return found

        yield visited


WAYS = [(name, rule) for name, kind in KINDS.items() for rule in kind.rules]


@pytest.mark.parametrize(("way", "rule"), WAYS)
def test_every_page_obeys(visits: Callable[[str], dict[str, Visit]], way, rule):
    wrong = {name: visit.wrong.get(rule, []) for name, visit in visits(way).items()}
    assert {name: complaints for name, complaints in wrong.items() if complaints} == {}


# Each has formulas, a replay or a part that a script adds on the first screen.
EARLY = ("l03-rigid-bodies/deeper-energy", "l05-kinematics-and-cameras/lecture")


@pytest.mark.parametrize("name", EARLY)
def test_nothing_moves_when_the_site_s_own_files_arrive_late(browser, site, name):
    def late(route):
        time.sleep(0.2)
        route.continue_()

    with served(site) as address, browser.new_page() as page:
        page.route("**/_static/**", late)
        page.add_init_script(path=SCRIPTS / "watch_shifts.js")
        page.goto(f"{address}/lessons/{name}.html")
        call(page, "read")
        shifts = page.evaluate("allShifts()")
        assert sum(value for value, _ in shifts) < STILL, shifts
