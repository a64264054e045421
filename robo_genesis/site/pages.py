"""Directives and roles of pages, whose refusals are errors of the build with page and line."""

from pathlib import Path

from docutils import nodes
from sphinx.util.docutils import SphinxDirective, SphinxRole


class _OfPage:
    """What a page can write."""

    def shown(self) -> list[nodes.Node]:
        """Return its nodes.

        Raises:
            LookupError, ValueError: it cannot show what the page asks for.
        """
        raise NotImplementedError


class PageDirective(_OfPage, SphinxDirective):
    """A directive; what it cannot show is an error of the build."""

    @property
    def book(self) -> Path:
        """The folder of the pages."""
        return Path(self.env.srcdir)

    def run(self) -> list[nodes.Node]:
        """Return the directive's nodes."""
        try:
            return self.shown()
        except (LookupError, ValueError) as error:
            raise self.error(
                f"{' '.join([self.name, *self.arguments])}: {error}"
            ) from error


class PageRole(_OfPage, SphinxRole):
    """A role; what it cannot show is an error of the build."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        """Return the role's nodes."""
        try:
            return self.shown(), []
        except (LookupError, ValueError) as error:
            message = f"{self.name}: {error}"
            return [], [self.inliner.reporter.error(message, line=self.lineno)]
