"""Files to download from a lab, and the commands that run it: ```` ```{takeaways} l04/lab ````.

```` ```{run-commands} ```` shows the commands for any lab, `{run-commands} install` the
first. The files are written into the site while the page is read, so that the page can
show their sizes.
"""

import re
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.config import Config
from sphinx.errors import ConfigError
from sphinx.util.osutil import relative_uri

from robo_genesis.core.project import solutions_shown
from robo_genesis.pipeline.pages.book import Page, find_pages
from robo_genesis.site.evidence.plain_nodes import bullets
from robo_genesis.site.pages import PageDirective
from robo_genesis.site.takeaways.files import (
    Takeaways,
    run_commands,
    system,
    write_takeaways,
)

TAKEAWAYS = "takeaways"  # Folder of the site
ADDRESS = re.compile(r"https://(?P<host>[\w.-]+)/(?P<name>[\w.-]+/[\w.-]+)")

# Returns the link to a file with an optional text, and its size.
Link = Callable[..., list[nodes.Node]]


class TakeawaysBox(PageDirective):
    """Show how to run a lab at home, and list its measured files for download."""

    required_arguments = 1

    def shown(self) -> list[nodes.Node]:
        """Return the box and the list."""
        page, files = (
            self.page(self.arguments[0]),
            Path(self.env.app.outdir) / TAKEAWAYS,
        )
        self.env.note_dependency(self.env.doc2path(page.docname, base=False))
        found = write_takeaways(page, files, self.config)
        links = partial(
            link, relative_uri(f"{self.env.docname}.html", TAKEAWAYS), files
        )
        return [self.box(found, links), *self.downloads(found, links)]

    def page(self, name: str) -> Page:
        """Return the page that `lesson/page` names."""
        pages = {f"{p.lesson}/{p.page}": p for p in find_pages(Path(self.env.srcdir))}
        if name not in pages:
            known = ", ".join(sorted(pages.keys() - {"None/None"}))
            raise LookupError(f"there is no page {name!r}. Choices: {known}.")
        return pages[name]

    def box(self, found: Takeaways, links: Link) -> nodes.Node:
        """Return what to download and the commands that run the lab."""
        commands = "\n".join(found.commands)
        box = nodes.admonition(
            "", nodes.title("", "Run it yourself"), classes=["run-it-yourself"]
        )
        box += self.parse_text_to_nodes(
            f"On {system()}: save these three files in one folder."
        )
        box += bullets(
            (*links(found.student), ", the lab without outputs or solutions"),
            (
                *links(found.wheel),
                ", the course's package, which brings the pinned engine",
            ),
            (
                *links(found.constraints),
                ", the versions with which the course was built",
            ),
        )
        box += self.parse_text_to_nodes("In that folder:")
        box += nodes.literal_block(commands, commands, language="bash")
        box += self.parse_text_to_nodes(
            "The first command downloads the engine and Torch, which takes minutes. The first "
            "cell checks the engine's version and says what to do if yours differs. In its first "
            "run the engine compiles its kernels, which takes minutes too."
        )
        if offer := codespace(self.config.course_repository):
            box += self.parse_text_to_nodes(offer)
        return box

    def downloads(self, found: Takeaways, links: Link) -> Iterable[nodes.Node]:
        """Return the list of the files of this run."""
        yield from self.parse_text_to_nodes(
            "Results of the run on this page, for your own tools:"
        )
        tables: list[str | nodes.Node] = []
        for case, table, archive in found.arrays:
            tables += [
                f"{case} ",
                *links(table, "CSV"),
                " and ",
                *links(archive, "npz"),
                "; ",
            ]
        figures = [part for path in found.figures for part in (*links(path), ", ")]
        left_out = "" if solutions_shown() else ", without the solutions"
        yield bullets(
            (*links(found.executed), ", the notebook as it ran" + left_out),
            (
                "arrays of each case: ",
                *tables,
                "their units are in the CSV's head and in ",
                *links(found.units),
            ),
            ("figures: ", *figures[:-1]),
        )


class RunCommands(PageDirective):
    """Show the commands that run a lab, for a page that belongs to no lab."""

    optional_arguments = 1

    def shown(self) -> list[nodes.Node]:
        """Return the block of code."""
        lines = run_commands(self.config.torch_index)
        if self.arguments not in ([], ["install"]):
            raise ValueError("write nothing or install.")
        if self.arguments:
            lines = lines[:-1]
        text = "\n".join(lines)
        return [nodes.literal_block(text, text, language="bash")]


def link(base: str, files: Path, file: Path, text: str = "") -> list[nodes.Node]:
    """Return a link to a downloadable file, and its size.

    Args:
        base: address of the files on the site, relative to the page.
        files: the folder of these files in the site.
        file: one of them.
        text: of the link, by default the file's name.
    """
    address = f"{base}/{file.relative_to(files).as_posix()}"
    reference = nodes.reference(
        "", text or file.name, internal=True, refuri=address, classes=["takeaway"]
    )
    return [reference, nodes.Text(f" ({max(1, round(file.stat().st_size / 1000))} kB)")]


def require_address(app: Sphinx, config: Config) -> None:
    """Require the address of a repository, or none.

    Raises:
        ConfigError: the given address is not valid.
    """
    given = config.course_repository
    if given and not ADDRESS.fullmatch(given):
        raise ConfigError(
            f"course_repository={given!r} in _config.yml is not valid. Give an address like "
            "https://github.com/OWNER/NAME, without a slash at its end, or leave it empty."
        )


def codespace(repository: str) -> str:
    """Return Markdown that offers a codespace of a repository on GitHub, nothing for another one.

    Args:
        repository: its address, empty if none is configured.
    """
    found = ADDRESS.fullmatch(repository)
    if found is None or found["host"] != "github.com":
        return ""
    return (
        f"Without Linux: [open the course in a codespace](https://codespaces.new/{found['name']}), "
        "a virtual machine at GitHub with the container of the labs. It needs an account there. We "
        "have not tried it; the page “Running a lab” has the steps."
    )


def setup(app: Sphinx) -> None:
    """Register the directives and their settings."""
    app.add_config_value("torch_index", "", "env", str)
    app.add_config_value("course_repository", "", "env", str)
    app.connect("config-inited", require_address)
    app.add_directive("takeaways", TakeawaysBox)
    app.add_directive("run-commands", RunCommands)
