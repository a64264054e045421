"""The configuration that Jupyter Book makes of a book's `_config.yml`, as Sphinx takes it."""

from pathlib import Path
from typing import Any

from jupyter_book.config import get_final_config

# The order of the course's own style sheets; a later one overrides an earlier one.
SHEETS = [
    f"{name}.css"
    for name in (
        "print",
        "calm",
        "course",
        "explorer",
        "replay",
        "look",
        "plot",
        "home",
        "icons",
    )
]


def configuration(book: Path) -> dict[str, Any]:
    """Return the values of `conf.py`.

    Args:
        book: the folder of the pages.
    """
    given = {
        "external_toc_path": str(book / "_toc.yml"),
        "nitpicky": True,
        "latex_individualpages": False,
    }
    config, _ = get_final_config(
        user_yaml=book / "_config.yml",
        cli_config=given,
        sourcedir=book,
        use_external_toc=True,
    )
    config["html_css_files"] = SHEETS
    return config
