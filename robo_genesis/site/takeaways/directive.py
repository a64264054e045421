"""Files to download from a lab, and the commands that run it: ```` ```{takeaways} ````.

```` ```{run-commands} ```` shows the commands for any lab, `{run-commands} install` all
but the last, `{run-commands} check` the one that checks downloads. The files are written
into the site while the page is read, so that the page can show their sizes.
"""

from collections.abc import Callable
from pathlib import Path

from docutils import nodes
from markupsafe import Markup
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.util.osutil import relative_uri

from robo_genesis.core.markup import filled
from robo_genesis.core.project import solutions_shown
from robo_genesis.pipeline.pages.book import find_pages
from robo_genesis.site.pages import PageDirective

from .files import check_command, run_commands, system, write_takeaways

TAKEAWAYS = "takeaways"  # Folder of the site
GITHUB = "https://github.com/"


class TakeawaysBox(PageDirective):
    """Show how to run this lab at home, and list its measured files for download."""

    def shown(self) -> list[nodes.Node]:
        """Return the box and the list."""
        pages = find_pages(self.book)
        page = next(page for page in pages if page.docname == self.env.docname)
        files = write_takeaways(page, folder(self.env), self.config)
        repository = self.config.course_repository
        text = filled(
            Path(__file__).with_name("box.md"),
            files=files,
            link=links(self.env),
            system=system(),
            solutions=solutions_shown(),
            codespace=repository.startswith(GITHUB) and repository.removeprefix(GITHUB),
        )
        return self.parse_text_to_nodes(text)


class RunCommands(PageDirective):
    """Show the commands that run a lab, for a page that belongs to no lab."""

    optional_arguments = 1

    def shown(self) -> list[nodes.Node]:
        """Return the block of code."""
        commands = run_commands(self.config.torch_index)
        if self.arguments == ["install"]:
            commands = commands[:-1]
        elif self.arguments:
            commands = (check_command(folder(self.env)),)
        text = "\n".join(commands)
        return [nodes.literal_block(text, text, language="bash")]


def folder(env: BuildEnvironment) -> Path:
    """Return the folder of the site with the files that readers download."""
    return Path(env.app.outdir) / TAKEAWAYS


def links(env: BuildEnvironment) -> Callable[..., Markup]:
    """Return a function that links a file from the page that is read, with its size.

    It takes the file, and the text of the link, by default the file's name.
    """
    base = relative_uri(f"{env.docname}.html", TAKEAWAYS)
    link = Markup('<a class="takeaway reference internal" href="{}/{}">{}</a> ({} kB)')

    def linked(file: Path, text: str = "") -> Markup:
        size = max(1, round(file.stat().st_size / 1000))
        place = file.relative_to(folder(env)).as_posix()
        return link.format(base, place, text or file.name, size)

    return linked


def setup(app: Sphinx) -> None:
    """Register the directives and their settings."""
    app.add_config_value("torch_index", "", "env", str)
    app.add_config_value("course_repository", "", "env", str)
    app.add_directive("takeaways", TakeawaysBox)
    app.add_directive("run-commands", RunCommands)
