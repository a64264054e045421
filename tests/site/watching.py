"""What the browser tests look for on every page."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import BrowserContext, Page, Request, Route

SERVED_ONLY = {"404.html"}  # a server shows it for any address, so its own are absolute


def page_names(site: Path) -> list[str]:
    """Return the site's pages as addresses relative to its folder."""
    names = [path.relative_to(site).as_posix() for path in sorted(site.rglob("*.html"))]
    assert "index.html" in names
    return names


def watch(page: Page) -> list[str]:
    """Return a list that grows with whatever goes wrong on a page."""
    found: list[str] = []
    page.on("console", lambda m: found.append(m.text) if m.type == "error" else None)
    page.on("pageerror", lambda error: found.append(str(error)))
    page.on("requestfailed", lambda request: found.append(f"failed: {request.url}"))
    page.on("response", lambda r: found.append(f"{r.status}: {r.url}") if r.status >= 400 else None)
    return found


def drawn(page: Page) -> None:
    """Wait until a frame has been laid out, and what watches sizes has been told of it."""
    page.evaluate("""() => new Promise(done => {
      const observer = new ResizeObserver(() => { observer.disconnect(); done(); });
      observer.observe(document.body);
    })""")


@contextmanager
def only_from(context: BrowserContext, base: str) -> Iterator[list[str]]:
    """Block every address that does not begin with `base`, and collect those asked for."""
    asked: list[str] = []

    def refuse(route: Route, request: Request) -> None:
        asked.append(request.url)
        route.abort()

    context.route(lambda url: not url.startswith((base, "data:", "blob:")), refuse)
    yield asked
    context.unroute_all()
