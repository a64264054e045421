"""Search finds a long name by its end, too: `control_force` finds `get_dofs_control_force`.

Sphinx's index holds whole words, and its script looks for parts of them only where no page has the
word itself.
"""

import re
from typing import Any

from sphinx.application import Sphinx
from sphinx.search.en import SearchEnglish


class SearchNames(SearchEnglish):
    """English, with the ends of names that are joined by underscores."""

    def split(self, input: str) -> list[str]:
        """Return the words of a text, each name followed by its shorter and shorter ends."""
        return [part for word in super().split(input) for part in ends(word)]


def ends(word: str) -> list[str]:
    """Return a word, and what remains of it after each underscore."""
    starts = [0, *(match.end() for match in re.finditer("_+", word))]
    return [word[at:] for at in starts if word[at:]]


def setup(app: Sphinx) -> dict[str, Any]:
    """Put it in the place of Sphinx's English."""
    app.add_search_language(SearchNames)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
