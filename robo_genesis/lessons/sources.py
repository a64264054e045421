"""What decides the outputs of one page."""

import hashlib
from collections.abc import Mapping
from pathlib import Path

from robo_genesis.core.project import ROOT
from robo_genesis.lessons.book_pages import Page, code_digest, fingerprint


def page_fingerprint(
    page: Page, root: Path = ROOT, environment: Mapping[str, str] | None = None
) -> str:
    """Return a digest of everything that decides the outputs of a page.

    Args:
        page: the executed page.
        root: the checkout.
        environment: variables, by default those of this process.

    Returns:
        20 hex digits.
    """
    parts = fingerprint([page], root, environment) + code_digest(page)
    return hashlib.sha256(parts.encode()).hexdigest()[:20]
