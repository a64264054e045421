"""What a page's sets of compiled kernels cost: ```` ```{kernel-costs} l04/lecture ````.

The figures are those that `make costs` kept. Where they are missing, or no longer of this engine,
lock or page, the page says so and names the command.
"""

from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robo_genesis import kept, kernel_costs, tables
from robo_genesis.kernel_costs import COMMAND, Costs
from robo_genesis.pages import Page, find_pages


class KernelCosts(SphinxDirective):
    """Show each set of kernels of a page, why it is one of its own, and its seconds."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return the table and its origin; a page without marked cells is an error."""
        book = Path(self.env.srcdir)
        try:
            page = marked_page(book, self.arguments[0])
            costs = kernel_costs.read_costs(book, page)
        except (LookupError, kept.KeptError) as error:
            raise self.error(f"kernel-costs: {error}") from error
        self.env.note_dependency(str(kernel_costs.record_file(book, page)))
        return self.parse_text_to_nodes(costs_text(page, costs))


def marked_page(book: Path, name: str) -> Page:
    """Return the page `lesson/page` of a book.

    Raises:
        LookupError: it has no cell with the option `kernels`; the message lists the pages that do.
    """
    marked = {f"{p.lesson}/{p.page}": p for p in find_pages(book) if kernel_costs.set_names(p)}
    if name not in marked:
        known = ", ".join(marked) or "none"
        raise LookupError(f"{name} marks no cell with `kernels`. Pages that do: {known}.")
    return marked[name]


def costs_text(page: Page, costs: Costs | None) -> str:
    """Return the table in Markdown, and where its figures are from or how to make them."""
    names = kernel_costs.set_names(page)
    if costs is None or len(costs.sets) != len(names):
        rows = [{"set of kernels": name, "seconds": "not measured"} for name in names]
        return f"{tables.markdown(rows)}\nOne command measures them:\n\n    {COMMAND}\n"
    rows = [
        {
            "set of kernels": name,
            "cold [s]": f"{cost.cold:.1f}",
            "warm [s]": f"{cost.warm:.1f}",
            "cold / warm": f"{cost.cold / max(cost.warm, 0.1):.1f}",
        }
        for name, cost in zip(names, costs.sets, strict=True)
    ]
    reason = kernel_costs.stale(costs, page)
    origin = (
        f"Measured by `{COMMAND}` on {costs.date} with Genesis {costs.engine} on a machine of "
        f"{costs.cores} cores, one run each."
    )
    if reason:
        origin = f"**Stale**: {reason}. `{COMMAND}` measures anew. {origin}"
    return f"{tables.markdown(rows)}\n{origin}\n"


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive."""
    app.add_directive("kernel-costs", KernelCosts)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
