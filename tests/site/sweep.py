"""One visit to a page of the site: everything that the rules for every page ask is collected."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from playwright.sync_api import Browser, Page
from watching import SCRIPTS, call, drawn, foreign, settle, violations, watch

# Largest first visit before the reader asks for the viewer [bytes, compressed]. A page
# contains its drawings.
BUDGET = 560_000
MEASURE = (
    40  # Longest line of running text, in letter heights; one holds about two letters
)
MIDDLE_ROWS = "tr:nth-child(n+11):nth-last-child(n+11)"
"""Neither gone through by Tab nor looked at by axe-core: a table shows with the ten rows at either
end how it takes the focus, and what its cells are like."""
STILL = 0.01  # Largest cumulative layout shift; browsers call up to 0.1 good
AXE = {
    "runOnly": {
        "type": "tag",
        "values": [
            "wcag2a",
            "wcag2aa",
            "wcag21a",
            "wcag21aa",
            "wcag22aa",
            "best-practice",
        ],
    },
    "rules": {"target-size": {"enabled": True}},  # WCAG 2.2 AA, and off by default
    # what it fetches again cannot be fetched from disk, and no rule needs it
    "preload": False,
    "resultTypes": ["violations"],
}
COLOURS = AXE | {"runOnly": ["color-contrast", "link-in-text-block"]}
SHAPES = AXE | {"runOnly": ["scrollable-region-focusable", "target-size"]}

IN_EVERY_COLOUR = ("axe", "foreign hosts", "images", "messages", "motion", "theme")
IN_EVERY_SHAPE = (
    "focus",
    "layout shift",
    "lines",
    "scroll boxes",
    "tab order",
    "width",
)
SERVED = ("blocking scripts", "weight")
"""Of what comes from disk, the browser tells neither compressed size nor blocking."""
RULES = (*IN_EVERY_COLOUR, *IN_EVERY_SHAPE, *SERVED)


@dataclass(frozen=True, slots=True)
class Kind:
    """How all pages are visited.

    Attributes:
        rules: The rules of `RULES` that the visit looks at.
        scheme: The reader's colour scheme.
        size: Width and height of the window at first [px].
        narrow: Width at which it is looked at in detail, after the first reading [px].
        axe: What axe-core looks for with open folds, by the width of the window [px].
        widths: All widths at which nothing may stick out [px].
        large_text: Whether it is looked at in letters of twice the size, too.
    """

    rules: tuple[str, ...]
    scheme: str
    size: tuple[int, int]
    narrow: int
    axe: dict[int, dict[str, Any]]
    widths: tuple[int, ...] = ()
    large_text: bool = False


WIDTHS = (768, 1280, 1920, 3840)
ON_DISK = (*IN_EVERY_COLOUR, *IN_EVERY_SHAPE)
KINDS = {
    "light": Kind(
        RULES, "light", (1280, 800), 1280, {1280: AXE}, WIDTHS, large_text=True
    ),
    "phone": Kind(
        ON_DISK, "dark", (390, 700), 320, {320: SHAPES, 1280: COLOURS}, (390, 320)
    ),
}
"""The phone reads from disk, in the dark. Shape does not depend on the scheme, so the desktop looks
at it at widths that the phone does not have. Nothing in an article is hidden on the phone alone, so
axe-core looks there only at what depends on the shape. Colours hardly do, so the dark ones are
looked at where the phone's page has been made as wide as a desktop."""

# Pages on which axe-core looks for everything with closed folds and with large text,
# too (it skips what a closed fold hides). On the desktop, these alone are gone through
# by Tab: all pages have the same menus.
EVERY_STATE = {"index.html", "lessons/l02-life-cycle/lecture.html"}


class Visit:
    """One page, opened once, and whatever is wrong on it by rule.

    Attributes:
        wrong: Complaints by rule; each rule of the visit's kind is there.
    """

    def __init__(self, browser: Browser, base: str, name: str, kind: Kind) -> None:
        self.kind, self.every_state = kind, name in EVERY_STATE
        self.wrong: dict[str, list[str]] = {rule: [] for rule in kind.rules}
        size = dict(zip(("width", "height"), kind.size, strict=True))
        page = browser.new_page(viewport=size, color_scheme=kind.scheme)
        self.wrong["messages"], self.wrong["foreign hosts"] = (
            watch(page),
            foreign(page, base),
        )
        page.add_init_script(path=SCRIPTS / "watch_shifts.js")
        page.goto(f"{base}/{name}")
        if "?q=" in name:
            page.wait_for_selector("#search-results li a")
        self._arrive(page)
        page.emulate_media(reduced_motion="reduce")
        page.clock.install()  # it runs as ever, and can be put forward
        self._resize(page, kind.narrow)
        self.note("motion", call(page, "moving"))
        call(page, "one_of_each")
        self._with_closed_folds(page)
        self._with_open_folds(page)
        page.close()

    def note(self, rule: str, complaints: Iterable[str], state: str = "") -> None:
        if rule in self.wrong:
            self.wrong[rule] += [
                f"{state}: {text}" if state else text for text in complaints
            ]

    def _resize(self, page: Page, width: int) -> None:
        page.set_viewport_size({"width": width, "height": self.kind.size[1]})
        settle(page)

    def _arrive(self, page: Page) -> None:
        """Note what the first visit costs; then read to the end."""
        if "weight" in self.wrong:
            page.wait_for_load_state("networkidle")
        theme = page.evaluate("document.documentElement.dataset.theme")
        self.note("theme", [] if theme == self.kind.scheme else [f"shown in {theme}"])
        loaded = call(page, "loaded")
        weights = {entry["name"]: entry["bytes"] for entry in loaded}
        self.note("weight", [str(weights)] if sum(weights.values()) > BUDGET else [])
        blocking = [entry["name"] for entry in loaded if entry["blocking"]]
        self.note(
            "blocking scripts", [file for file in blocking if not file.endswith(".css")]
        )
        self.note(
            "blocking scripts",
            [] if blocking else ["not even a style sheet: is it told?"],
        )
        if "layout shift" in self.wrong:
            call(page, "read")
            shifts = page.evaluate("allShifts()")
            moved = sum(value for value, _ in shifts) > STILL
            self.note("layout shift", map(str, shifts) if moved else [])
        self.note("images", call(page, "images"))

    def _with_closed_folds(self, page: Page) -> None:
        self.note("tab order", call(page, "tab_order"))
        if "focus" in self.wrong and (self.every_state or self.kind.narrow < 768):
            hidden = f"{MIDDLE_ROWS} {{ display: none !important }}"
            without = page.add_style_tag(content=hidden)
            settle(page)
            self.note("focus", focus_complaints(page))
            without.evaluate("style => style.remove()")
            settle(page)
        if self.every_state:
            self.note("axe", violations(page, **AXE), "folds closed")
        if self.kind.large_text:
            page.evaluate("document.documentElement.style.fontSize = '200%'")
            settle(page)
            wide = page.evaluate("document.documentElement.scrollWidth > innerWidth")
            self.note("width", ["wider than the window"] if wide else [], "large text")
            if self.every_state:
                self.note("axe", violations(page, **AXE), "large text")
            page.evaluate("document.documentElement.style.fontSize = '100%'")

    def _with_open_folds(self, page: Page) -> None:
        page.evaluate(
            "document.querySelectorAll('details').forEach(fold => { fold.open = true; })"
        )
        for _ in range(
            5
        ):  # on a busy machine the browser tells the page late that a box has grown
            settle(page)
            if not (unmarked := call(page, "scroll_boxes")):
                break
        self.note("scroll boxes", unmarked)
        for width in self.kind.widths:
            page.set_viewport_size({"width": width, "height": self.kind.size[1]})
            drawn(page)
            layout = call(page, "layout", MEASURE)
            self.note(
                "width",
                ["wider than the window"] if layout["wide"] else [],
                f"{width} px",
            )
            self.note("width", layout["out"], f"{width} px")
            self.note("lines", layout["long"], f"{width} px")
        page.eval_on_selector_all(
            MIDDLE_ROWS, "rows => rows.forEach(row => row.remove())"
        )
        for width, options in self.kind.axe.items():
            self._resize(page, width)
            self.note("axe", violations(page, **options), f"{width} px")


def focus_complaints(page: Page) -> list[str]:
    """Press Tab until the focus leaves the page or comes back; return the stops not seen."""
    call(page, "note_focus")
    for _ in range(100):
        for _ in range(15):
            page.keyboard.press("Tab")
        if page.evaluate("stops.ended === true"):
            break
    else:
        return ["Tab does not come to an end"]
    stops = page.evaluate("stops")
    page.evaluate("document.activeElement.blur()")
    page.evaluate("scrollTo({ top: 0, behavior: 'instant' })")
    complaints = [
        stop["what"] for stop in stops if not (stop["outlined"] and stop["seen"])
    ]
    if len(stops) < 5 or "Skip to main content" not in stops[0]["what"]:
        complaints.append(f"begins with {stops[:1]}, and has {len(stops)} stops")
    return complaints
