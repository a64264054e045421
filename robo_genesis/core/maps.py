"""Maps of recorded results, as `site/figures/explorer.py` shows them."""

from collections.abc import Iterable, Sequence
from typing import Any

MEASURES = False


def grid(
    caption: str,
    columns: Iterable[str],
    rows: Sequence[str],
    cells: Sequence[dict[str, Any]],
    **more: Any,
) -> dict[str, Any]:
    """Return a map.

    Args:
        caption: below it.
        columns: their labels, from the left.
        rows: their labels, from the bottom.
        cells: row by row, from the bottom; the last row may be short.
        more: further keys of the map, `label` among them.
    """
    labels = [*columns]
    n = len(labels)
    lines = [
        {"label": row, "cells": cells[k * n : (k + 1) * n]}
        for k, row in enumerate(rows)
    ]
    return more | {"caption": caption, "columns": labels, "rows": lines[::-1]}
