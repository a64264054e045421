"""The role `{guard}`: the check that guards the sentence in front of it.

| in a page | means |
|---|---|
| {guard}`near_coulomb` | the check of this page |
| {guard}`l04/lab saturation` | the check of another page |

It shows nothing. A check that the page does not have, or that did not pass, stops the build.
"""

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxRole

from robo_genesis.core import project
from robo_genesis.evidence import bundle
from robo_genesis.pipeline.pages.built import measuring_page, page_outputs


class Guard(SphinxRole):
    """Require that the named check passed."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        """Return nothing, or an error with the name, the choices or the values."""
        place, _, check = self.text.rpartition(" ")
        try:
            problem = problem_of(place or measuring_page(self.env.docname), check)
        except bundle.BundleRefused as error:
            problem = str(error)
        if problem:
            return [], [self.inliner.reporter.error(f"guard: {problem}", line=self.lineno)]
        return [], []


def problem_of(lesson_page: str, check: str) -> str | None:
    """Return why a check of a page guards nothing, None if it passed.

    Raises:
        BundleRefused: the page has no bundle that can be read.
    """
    folder = page_outputs(lesson_page) / project.BUILD_BACKEND
    found = {c.name: c for c in bundle.read_manifest(folder).predicate.checks}
    if check not in found:
        return f"{lesson_page} has no check {check!r}. Choices: {', '.join(found)}."
    if not found[check].passed:
        return f"the check {check} of {lesson_page} found {found[check].found}."
    return None


def setup(app: Sphinx) -> None:
    """Register the role."""
    app.add_role("guard", Guard())
