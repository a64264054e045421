"""What the browser tests look for on a page."""

from pathlib import Path
from typing import Any

from playwright.sync_api import Page, Request, expect

from robo_genesis.pipeline import npm

SCRIPTS = Path(__file__).with_name(
    "scripts"
)  # Functions that tests call in a page, a file each

RUN_AXE = """([part, options]) => axe.run(part, options).then(({ violations, passes }) => [
  violations.flatMap(rule => rule.nodes.map(node => `${rule.id}: ${node.target.join(" ")}`)),
  passes.length,
])"""
SERVED_ONLY = {"404.html"}  # a server shows it for any address, so its own are absolute
THEME_WAITS = 300
"""How long after a change the theme looks again which boxes scroll [ms of the page's clock]."""


def page_names(site: Path) -> list[str]:
    """Return the site's pages as addresses relative to its folder."""
    names = [path.relative_to(site).as_posix() for path in sorted(site.rglob("*.html"))]
    assert "index.html" in names
    return names


def call(page: Page, script: str, *argument: Any) -> Any:
    """Call the function of a file in a page."""
    return page.evaluate((SCRIPTS / f"{script}.js").read_text(), *argument)


def errors(page: Page) -> list[str]:
    """Return a list that grows with the errors of a page's scripts."""
    found: list[str] = []
    page.on("console", lambda m: found.append(m.text) if m.type == "error" else None)
    page.on("pageerror", lambda error: found.append(str(error)))
    return found


def watch(page: Page) -> list[str]:
    """Return a list that grows with whatever goes wrong on a page."""
    found = errors(page)

    def note(request: Request) -> None:
        if (
            request.failure != "net::ERR_ABORTED"
        ):  # as a request of the page that was left is
            found.append(f"failed: {request.url}, {request.failure}")

    page.on("requestfailed", note)
    page.on(
        "response",
        lambda r: found.append(f"{r.status}: {r.url}") if r.status >= 400 else None,
    )
    return found


def foreign(page: Page, base: str) -> list[str]:
    """Return a list that grows with the addresses asked for that do not begin with `base`."""
    asked: list[str] = []
    own = (base, "data:", "blob:")
    page.on("request", lambda r: None if r.url.startswith(own) else asked.append(r.url))
    return asked


def drawn(page: Page) -> None:
    """Wait until a frame has been laid out, and what watches sizes knows it, at most 5 s."""
    page.evaluate("""() => new Promise(done => {
      setTimeout(done, 5000);
      const observer = new ResizeObserver(() => { observer.disconnect(); done(); });
      observer.observe(document.body);
    })""")


def settle(page: Page) -> None:
    """Let our script and then the theme mark the boxes that scroll, as they do after a change.

    The page's clock must be installed.
    """
    drawn(page)
    page.clock.run_for(THEME_WAITS)


def violations(page: Page, part: str = "html", **options: Any) -> list[str]:
    """Return what axe-core finds in a part of a page."""
    if not page.evaluate("'axe' in window"):
        page.add_script_tag(path=npm.packages() / "axe-core" / "axe.min.js")
    found, passed = page.evaluate(RUN_AXE, [part, options])
    assert passed
    return found


def readout(page: Page, block: str, values: str = "dd") -> dict[str, str]:
    """Return the terms and values that a block shows."""
    terms, found = (
        page.locator(f"{block} {tag}").all_inner_texts() for tag in ("dt", values)
    )
    return dict(zip(terms, found, strict=True))


def show_all(page: Page, replay: str = ".replay") -> None:
    """Show a blind replay without an answer, also one that a question hides, and the whole runs."""
    hiding = f".choice:has(+ .after-answer):has(~ * {replay})"
    for answer in page.locator(f"{hiding} summary").all():
        answer.click()
    # The browser tells later that a fold has opened: until then, nothing after it shows.
    waiting = page.locator(f"{hiding}:not(.answered)")
    expect(waiting).to_have_count(0, timeout=120_000)
    for button in (f"{replay} .veil button", f"{replay} .rest"):
        for found in page.locator(button).all():
            if found.is_visible():
                found.click()


def show_model(page: Page, replay: str = ".replay") -> None:
    """Show all of a replay, load the model with the first Play, and pause if it still plays."""
    show_all(page, replay)
    play = page.locator(f"{replay} .play")
    play.click()
    page.locator(replay).get_by_text("Turn the view").wait_for(timeout=120_000)
    play.evaluate("play => { if (play.textContent === 'Pause') play.click(); }")
    assert play.inner_text() == "Play"


def choose(page: Page, case: str, sample: int, replay: str = ".replay"):
    """Bring a replay to a sample, as a reader does: picker, then slider."""
    page.locator(f"{replay} input[value={case}]").check()
    slider = page.locator(f"{replay} input[type=range]")
    slider.fill(str(sample))
    # Of a run that shows in part, the slider ends before the last sample.
    assert slider.input_value() == str(sample)
    return slider
