"""Search also finds a long name by its end: `control_force` finds `get_dofs_control_force`.

Sphinx's index contains whole words. Its script searches for parts of words only where
no page has the whole word.

The index of an incremental build is made equal to that of a build from nothing.
"""

import re
from collections.abc import Iterable
from typing import Any

from sphinx.application import Sphinx
from sphinx.search.en import SearchEnglish
from sphinx.util.index_entries import split_index_msg


class SearchNames(SearchEnglish):
    """English, with the ends of names that are joined by underscores."""

    def split(self, input: str) -> list[str]:
        """Return the words of a text, each name followed by its shorter and shorter ends."""
        return [part for word in super().split(input) for part in ends(word)]


def ends(word: str) -> list[str]:
    """Return a word, and the rest of it after each underscore."""
    starts = [0, *(match.end() for match in re.finditer("_+", word))]
    return [word[at:] for at in starts if word[at:]]


def complete_index(app: Sphinx) -> list[Any]:
    """Correct the index of a build that writes only some pages.

    Sphinx then keeps words that no page has any more, and loses the entries of the
    general index that are on the other pages.
    """
    indexer: Any = vars(app.builder)["indexer"]
    for words in (indexer._mapping, indexer._title_mapping):
        for word in [word for word, pages in words.items() if not pages]:
            del words[word]
    general = app.env.domaindata["index"]["entries"]
    indexer._index_entries.clear()
    indexer._index_entries.update(
        {page: found_entries(general[page]) for page in sorted(general)}
    )
    return []


def found_entries(
    entries: Iterable[tuple[str, str, str, str, str | None]],
) -> list[Any]:
    """Return a page's entries of the general index as the index of the search has them."""
    found = {
        (text, target or "", main)
        for kind, value, target, main, _ in entries
        for text in split_index_msg(kind, value)
    }
    return sorted(found)


def setup(app: Sphinx) -> None:
    """Replace Sphinx's English, and correct its index."""
    app.connect("html-collect-pages", complete_index)
    app.add_search_language(SearchNames)
