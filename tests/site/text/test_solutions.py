"""A site without solutions shows nothing of a run that is itself an answer."""

from types import SimpleNamespace

import pytest
from docutils import nodes
from docutils.utils import new_document

from robo_genesis.site.text.solutions import ANSWER, LeaveOutSolutions


@pytest.mark.parametrize(
    ("page", "solutions", "left"),
    [
        (ANSWER, "0", ["text"]),
        (ANSWER, "1", ["text", "output"]),
        ("lab", "0", ["text", "output"]),
    ],
)
def test_outputs_of_an_answer_are_left_out(monkeypatch, page, solutions, left):
    monkeypatch.setenv("SOLUTIONS", solutions)
    document = new_document("page")
    document.settings.env = SimpleNamespace(docname=f"lessons/l08-x/{page}")
    output = nodes.container("", nodes.paragraph("", "output"), classes=["cell_output"])
    document += [nodes.paragraph("", "text"), output]
    LeaveOutSolutions(document).apply()
    assert [of.astext() for of in document.findall(nodes.paragraph)] == left
