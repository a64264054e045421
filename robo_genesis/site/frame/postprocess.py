"""Changes each written page last: it becomes accessible and light.

No script blocks a page, it loads only the files that it needs, and nothing moves or
flashes.
"""

import shutil
import subprocess
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from urllib.parse import unquote, urlsplit

from bs4 import BeautifulSoup
from sphinx.application import Sphinx

from robo_genesis.pipeline import npm
from robo_genesis.pipeline.html.checks import POLICY, POLICY_NAME
from robo_genesis.site.figures import drawings

from . import accessibility

# Jupyter Book and the theme load every script on all pages; these are needed only where
# an element has one of these classes or identifiers. No page needs `fontawesome.js`:
# the icons come from a font.
NEEDED_BY: dict[str, set[str]] = {
    "choice.js": {"choice"},
    "clipboard.min.js": {"highlight"},
    "copybutton.js": {"highlight"},
    "design-tabs.js": {"sd-tab-set"},
    "explorer.js": {"explorer"},
    "fontawesome.js": set(),
    "language_data.js": {"search-results"},
    "plot.js": {"explorer", "replay"},
    "replay.js": {"replay"},
    "review.js": {"all-questions"},
    "search-from-disk.js": {"search-results"},
    "searchindex.js": {"search-results"},
    "searchtools.js": {"search-results"},
    "stage.js": {"explorer", "replay"},
    "togglebutton.js": {"toggle"},
}

OWN_SEARCH, SEARCH = "search-from-disk.js", "searchtools.js"

# Files of the theme in `_static` that no page loads.
UNUSED = ("**/*.map", "*webpack-macros.html", "locales", "scripts/fontawesome.js*")

# The object that Sphinx's scripts set; the file `documentation_options.js` defines it.
OPTIONS = "DOCUMENTATION_OPTIONS"

# The theme's own script does the same, but only after it has loaded.
CHOOSE_THEME = """
    if (document.documentElement.dataset.mode === "auto")
      document.documentElement.dataset.theme =
        matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
  """

TITLE = "page-title"  # The anchor of a title that has no other


def finish_site(app: Sphinx, error: Exception | None) -> None:
    """Finish the pages that Sphinx has written; earlier ones have the policy already."""
    if error is None:
        site = Path(app.outdir)
        drop_unused_files(site)
        with ProcessPoolExecutor() as pool:
            list(pool.map(finish_file, site.rglob("*.html")))
        drop_unused_rules(site)


def finish_file(path: Path) -> None:
    """Finish a page of the site, unless it was finished by an earlier render."""
    html = path.read_text("utf8")
    if f'http-equiv="{POLICY_NAME}"' not in html:
        path.write_text(finish_page(html, path.parent), "utf8")


def finish_page(html: str, folder: Path) -> str:
    """Return a page as readers get it.

    Args:
        html: the page as the theme wrote it.
        folder: the folder that the page's addresses are relative to.
    """
    page = BeautifulSoup(html, "html.parser")
    accessibility.make_accessible(page)
    accessibility.stack_tables(page)
    drawings.inline_drawings(page, folder)
    drop_idle_scripts(page)
    place_search_script(page)
    defer_scripts(page)
    choose_theme(page)
    wait_for_the_title(page)
    place_images(page, folder)
    forbid_other_hosts(page)
    return str(page)


def forbid_other_hosts(page: BeautifulSoup) -> None:
    """Let the browser itself refuse whatever would be loaded from another host."""
    policy = {"http-equiv": POLICY_NAME, "content": POLICY}
    if page.head:
        page.head.insert(0, page.new_tag("meta", attrs=policy))


def drop_idle_scripts(page: BeautifulSoup) -> None:
    """Remove the scripts that this page does not need."""
    tags = page.find_all(True)
    names = {name for tag in tags for name in (*tag.get("class", ()), tag.get("id"))}
    for script in page.find_all("script", src=True):
        file = Path(urlsplit(str(script["src"])).path).name
        if not names & NEEDED_BY.get(file, names):
            script.decompose()


def place_search_script(page: BeautifulSoup) -> None:
    """Let our script for the search follow Sphinx's, and so precede the index and the query."""
    own, tools = (
        page.select_one(f"script[src*='/{name}']") for name in (OWN_SEARCH, SEARCH)
    )
    if own and tools:
        tools.insert_after(own)


def defer_scripts(page: BeautifulSoup) -> None:
    """Defer every script file until the page is parsed; the files then run in their order.

    An inline script can be deferred only as a module. A script that sets options which
    a file before it defines becomes one. The others need no file, like the theme's
    first script, which chooses light or dark before the page shows.
    """
    for script in page.find_all("script", type=None, attrs={"async": None}):
        if script.has_attr("src"):
            script["defer"] = ""
        elif OPTIONS in script.get_text():
            script["type"] = "module"


def choose_theme(page: BeautifulSoup) -> None:
    """Choose light or dark before the page shows.

    The theme starts with neither, and its style sheets have no colours or borders for
    that state: the page would change its colours and move when the deferred scripts
    run. Without scripts the page is light.
    """
    for script in page.select("head script:not([src])"):
        if "dataset.theme" in script.get_text():
            script.append(CHOOSE_THEME)
            script.find_parents("html")[0]["data-theme"] = "light"


def wait_for_the_title(page: BeautifulSoup) -> None:
    """Make a browser that supports `rel="expect"` wait for the page's title before it renders.

    The buttons of the bar above the title are aligned at its end: the first ones would
    move when the others appear.
    """
    title = page.select_one("article h1")
    if page.head and title:
        anchor = title.attrs.setdefault("id", TITLE)
        expect = {"rel": "expect", "href": f"#{anchor}", "blocking": "render"}
        page.head.append(page.new_tag("link", attrs=expect))


def place_images(page: BeautifulSoup, folder: Path) -> None:
    """Give images their size, so that nothing moves when they load, and load them when in sight.

    The first picture of a replay, the largest of the first screen, loads at once.
    """
    images = [
        image
        for image in page.find_all("img", src=True)
        if image.find_parent("article")
    ]
    for image in images:
        file = folder / unquote(urlsplit(str(image["src"])).path)
        if not image.has_attr("width") and file.is_file():
            width, height = drawings.image_size(file)
            image["width"], image["height"] = str(width), str(height)
        image["loading"], image["decoding"] = "lazy", "async"
    for image in page.select(".replay .still")[:1]:
        image["loading"], image["fetchpriority"] = "eager", "high"


def drop_unused_files(html: Path) -> None:
    """Remove the theme's files that no page of the site's folder loads."""
    for pattern in UNUSED:
        for path in list((html / "_static").glob(pattern)):
            shutil.rmtree(path) if path.is_dir() else path.unlink()


def drop_unused_rules(html: Path) -> None:
    """Remove from the theme's style sheet, 400 kB, the rules that no page or script names."""
    tool = npm.packages() / "purgecss/bin/purgecss.js"
    styles = html / "_static/styles"
    command: list[Path | str] = [npm.node(), tool]
    command += ["--css", styles / "pydata-sphinx-theme.css"]
    command += ["--content", html / "**/*.html", html / "_static/**/*.js"]
    subprocess.run([*command, "--output", styles], check=True)


def setup(app: Sphinx) -> None:
    """Register the extension; see the module's summary."""
    # After the theme, which writes the colours of code then.
    app.connect("build-finished", finish_site, priority=900)
