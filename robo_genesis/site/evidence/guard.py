"""The role `{guard}`: the check that guards the sentence in front of it.

| in a page | means |
|---|---|
| {guard}`near_coulomb` | the check of this page |
| {guard}`l04/lab saturation` | the check of another page |

It shows nothing. A check that the page does not have, or that did not pass, stops the build.
"""

from docutils import nodes
from sphinx.application import Sphinx

from robo_genesis.core import project
from robo_genesis.evidence import bundle
from robo_genesis.pipeline.pages.built import measuring_page, page_outputs
from robo_genesis.site.pages import PageRole


class Guard(PageRole):
    """Require that the named check passed."""

    def shown(self) -> list[nodes.Node]:
        """Return nothing."""
        place, _, check = self.text.rpartition(" ")
        require_passed(place or measuring_page(self.env.docname), check)
        return []


def require_passed(lesson_page: str, check: str) -> None:
    """Require that a check of a page passed.

    Raises:
        LookupError: the page has no such check; the message lists those that it has.
        ValueError: the check failed, or the page has no bundle that can be read.
    """
    folder = page_outputs(lesson_page) / project.BUILD_BACKEND
    found = {c.name: c for c in bundle.read_manifest(folder).predicate.checks}
    if check not in found:
        raise LookupError(f"{lesson_page} has no check {check!r}. Choices: {', '.join(found)}.")
    if not found[check].passed:
        raise ValueError(f"the check {check} of {lesson_page} found {found[check].found}.")


def setup(app: Sphinx) -> None:
    """Register the role."""
    app.add_role("guard", Guard())
