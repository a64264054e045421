"""Search also finds a long name by its end: `control_force` finds `get_dofs_control_force`.

Sphinx's index contains whole words. Its script searches for parts of words only where
no page has the whole word. Words that only ask are not searched for: a page must have
all words.
"""

import re

from sphinx.application import Sphinx
from sphinx.search.en import SearchEnglish

ASKING = "can do does how i my should what when where which who why you your"


class SearchNames(SearchEnglish):
    """English, with the ends of names that are joined by underscores."""

    stopwords = SearchEnglish.stopwords | set(ASKING.split())

    def split(self, input: str) -> list[str]:
        """Return the words of a text, each name followed by its shorter and shorter ends."""
        return [part for word in super().split(input) for part in ends(word)]


def ends(word: str) -> list[str]:
    """Return a word, and the rest of it after each underscore."""
    starts = [0, *(match.end() for match in re.finditer("_+", word))]
    return [word[at:] for at in starts if word[at:]]


def setup(app: Sphinx) -> None:
    """Replace Sphinx's English."""
    app.add_search_language(SearchNames)
