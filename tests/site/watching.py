"""What the browser tests look for on every page."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from playwright.sync_api import BrowserContext, Page, Request, Route

from robo_genesis.build import npm

RUN_AXE = """([part, options]) => axe.run(part, options).then(({ violations, passes }) => [
  violations.flatMap(rule => rule.nodes.map(node => `${rule.id}: ${node.target.join(" ")}`)),
  passes.length,
])"""
SERVED_ONLY = {"404.html"}  # a server shows it for any address, so its own are absolute


def page_names(site: Path) -> list[str]:
    """Return the site's pages as addresses relative to its folder."""
    names = [path.relative_to(site).as_posix() for path in sorted(site.rglob("*.html"))]
    assert "index.html" in names
    return names


def errors(page: Page) -> list[str]:
    """Return a list that grows with the errors of a page's scripts."""
    found: list[str] = []
    page.on("console", lambda m: found.append(m.text) if m.type == "error" else None)
    page.on("pageerror", lambda error: found.append(str(error)))
    return found


def watch(page: Page) -> list[str]:
    """Return a list that grows with whatever goes wrong on a page."""
    found = errors(page)
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


def violations(page: Page, part: str = "html", **options: Any) -> list[str]:
    """Return what axe-core finds in a part of a page."""
    page.add_script_tag(path=npm.packages() / "axe-core" / "axe.min.js")
    found, passed = page.evaluate(RUN_AXE, [part, options])
    assert passed > 10
    return found
