"""What makes a page light: no script blocks it, nothing loads unused, nothing moves or flashes."""

import re
import shutil
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from urllib.parse import unquote, urlsplit

from bs4 import BeautifulSoup
from PIL import Image

# Jupyter Book and the theme put every script on all pages; these have work only where something
# matches. `fontawesome.js` has none anywhere: the icons come from a font.
NEEDED_BY = {
    "clipboard.min.js": "div.highlight",
    "copybutton.js": "div.highlight",
    "design-tabs.js": ".sd-tab-set",
    "explorer.js": ".explorer",
    "plot.js": ".explorer, .replay",
    "replay.js": ".replay",
    "fontawesome.js": None,
    "language_data.js": "#search-results",
    "search-from-disk.js": "#search-results",
    "searchindex.js": "#search-results",
    "searchtools.js": "#search-results",
    "togglebutton.js": ".toggle, .admonition.dropdown",
}

NAMED = re.compile(r"[.#]([\w-]+)")
"""Classes and identifiers in a selector."""

# Files of the theme that no page asks for; the rest are tools of its makers.
UNUSED = (
    "_static/**/*.map",
    "_static/*webpack-macros.html",
    "_static/locales",
    "_static/scripts/fontawesome.js*",
)

OPTIONS = "DOCUMENTATION_OPTIONS"
"""What Sphinx's scripts set; the file `documentation_options.js` defines it."""

CHOOSE_THEME = """
    if (document.documentElement.dataset.mode === "auto")
      document.documentElement.dataset.theme =
        matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
  """
"""What the theme's own script does, but only once it has come."""

TITLE = "page-title"
"""The anchor of a title that has none of its own."""

PIXELS = {"": 1.0, "px": 1.0, "pt": 4 / 3, "in": 96.0, "cm": 96 / 2.54, "mm": 96 / 25.4}
"""CSS pixels in one unit of length."""
LENGTH = re.compile(r"([\d.]+)([a-z]*)")


def lighten(page: BeautifulSoup, folder: Path) -> None:
    """Make one page light, in place.

    Args:
        page: the complete page as the theme wrote it.
        folder: the folder that the page's addresses are relative to.
    """
    drop_idle_scripts(page)
    defer_scripts(page)
    choose_theme(page)
    wait_for_the_title(page)
    place_images(page, folder)


def drop_idle_scripts(page: BeautifulSoup) -> None:
    """Remove the scripts that have nothing to do on this page."""
    tags = page.find_all(True)
    written = {name for tag in tags for name in (*tag.get("class", ()), tag.get("id"))}

    def matches(selector: str) -> bool:
        """Ask the page only where all names of a selector stand in it: a vain search is long."""
        named = (NAMED.findall(part) for part in selector.split(","))
        return any(written.issuperset(names) for names in named) and bool(page.select_one(selector))

    for script in page.find_all("script", src=True):
        name = Path(urlsplit(str(script["src"])).path).name
        if name in NEEDED_BY and not ((needed := NEEDED_BY[name]) and matches(needed)):
            script.decompose()


def defer_scripts(page: BeautifulSoup) -> None:
    """Let every script file wait until the page is there; they then run in their order.

    A script written in place cannot wait, unless it is a module: so is one that sets options which
    a file before it defines. The others need no file, like the theme's first, which sets light or
    dark before anything shows.
    """
    for script in page.find_all("script", type=None, attrs={"async": None}):
        if script.has_attr("src"):
            script["defer"] = ""
        elif OPTIONS in script.get_text():
            script["type"] = "module"


def choose_theme(page: BeautifulSoup) -> None:
    """Decide between light and dark before anything shows.

    The theme starts with neither, for which its style sheets have no colours, and so no borders:
    the page would change its colours and move when the deferred scripts come. Without scripts it
    is light.
    """
    for script in page.select("html > head > script:not([src])"):
        html = script.find_parents("html")[0]
        if "dataset.theme" in script.get_text():
            script.append(CHOOSE_THEME)
            html["data-theme"] = "light"


def wait_for_the_title(page: BeautifulSoup) -> None:
    """Let a browser that knows `rel="expect"` show nothing before the page's title is read.

    The bar above it has its buttons at the end of the line: half of them would be seen to move when
    the others come.
    """
    title = page.select_one("article h1")
    if page.head and title:
        anchor = title.attrs.setdefault("id", TITLE)
        expect = {"rel": "expect", "href": f"#{anchor}", "blocking": "render"}
        page.head.append(page.new_tag("link", attrs=expect))


def place_images(page: BeautifulSoup, folder: Path) -> None:
    """Give images their size, so that nothing moves when they come, and load the lower ones late.

    The first image of a page may be in sight at once, so it does not wait.
    """
    images = [image for image in page.find_all("img", src=True) if image.find_parent("article")]
    for number, image in enumerate(images):
        file = folder / unquote(urlsplit(str(image["src"])).path)
        if not image.has_attr("width") and file.is_file():
            width, height = image_size(file)
            image["width"], image["height"] = str(width), str(height)
        if number:
            image["loading"], image["decoding"] = "lazy", "async"


def image_size(file: Path) -> tuple[int, int]:
    """Return an image's width and height [CSS px].

    Raises:
        ValueError: an SVG states neither its size nor a view box.
    """
    if file.suffix != ".svg":
        with Image.open(file) as image:
            return image.size
    _, root = next(ElementTree.iterparse(file, events=["start"]))
    width, height = (LENGTH.fullmatch(root.get(name, "")) for name in ("width", "height"))
    if width and height and width[2] in PIXELS and height[2] in PIXELS:
        return _pixels(width), _pixels(height)
    box = root.get("viewBox", "").split()
    if len(box) == 4:
        return round(float(box[2])), round(float(box[3]))
    raise ValueError(f"{file.name} states no size. Give its root element a viewBox.")


def _pixels(length: re.Match[str]) -> int:
    return round(float(length[1]) * PIXELS[length[2]])


def drop_unused_files(html: Path) -> None:
    """Remove the theme's files that no page asks for.

    Args:
        html: the folder of the site.
    """
    for pattern in UNUSED:
        for path in list(html.glob(pattern)):
            shutil.rmtree(path) if path.is_dir() else path.unlink()
