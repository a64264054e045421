"""Solutions and answers, which `SOLUTIONS=0` leaves out of the site.

They are left out of pages and search index, and of the executed notebooks. The pages' sources,
which contain them, are not published. A question that the page itself marks keeps its feedback.
"""

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.config import Config
from sphinx.transforms import SphinxTransform

from robo_genesis.core.project import solutions_shown
from robo_genesis.site.takeaways.plain_markdown import ANSWER, SOLUTION

TAG = f"tag_{SOLUTION}"
"""The class that a code cell has from its tag."""


class LeaveOutSolutions(SphinxTransform):
    """Remove cells and folds that contain a solution, before anything refers to them."""

    default_priority = 200

    def apply(self, **kwargs: object) -> None:
        """Remove them from the page."""
        for node in [node for node in self.document.findall(nodes.container) if is_solution(node)]:
            node.parent.remove(node)


def is_solution(node: nodes.Element) -> bool:
    """Whether a container is a code cell or a fold that contains a solution."""
    classes = {*node["classes"], *node.get("container_classes", ())}
    is_answer = node.get("design_component") == "dropdown" and ANSWER.match(node[0].astext())
    return bool(classes & {SOLUTION, TAG} or is_answer)


def hide_sources(app: Sphinx, config: Config) -> None:
    """Publish no page's source."""
    config.html_copy_source = False
    config.html_theme_options["use_download_button"] = False  # it leads to the source


def setup(app: Sphinx) -> None:
    """Register what leaves the solutions out, if they are not shown."""
    if not solutions_shown():
        app.add_transform(LeaveOutSolutions)
        app.connect("config-inited", hide_sources)
