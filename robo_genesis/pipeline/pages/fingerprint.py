"""The fingerprint of a page: a digest of everything that decides its outputs."""

import platform
from collections.abc import Mapping
from functools import lru_cache

from robo_genesis.core.files import derived_value, json_digest
from robo_genesis.core.project import (
    environment_contract,
    installed_packages,
    lock_digest,
)
from robo_genesis.pipeline.pages.book import Page
from robo_genesis.pipeline.pages.sources import Tree, lesson_modules
from robo_genesis.pipeline.pages.syntax import (
    claims_in,
    syntax_digest,
)


def page_fingerprint(page: Page, tree: Tree, environment: Mapping[str, str] | None = None) -> str:
    """Return a digest of everything that decides the outputs of a page.

    It covers the lock, all installed versions, the version of Python, the environment contract,
    whether the page is executed alone, the syntax of the page's cells, of the modules that they
    import and of the modules of its lesson, the claims of checks in them, and the data files of the
    package, except those of other lessons.

    Args:
        page: an executed page.
        tree: the files of the checkout.
        environment: variables, by default those of this process.

    Returns:
        20 hex digits.
    """
    own = lesson_modules(page.lesson, tree.root) if page.lesson else []
    modules = tree.closure([*page.code.imports, *own])
    parts = {
        "lock": lock_digest(tree.root),
        "installed": _installed(),
        "python": platform.python_version(),
        "environment": environment_contract(environment),
        "cells": page.code.digests,
        "modules": {name: syntax_digest(tree.text(path)) for name, path in modules.items()},
        "claims": {name: claims_in(tree.text(path)) for name, path in modules.items()},
        "data": tree.data_for(page.lesson),
        "alone": page.alone,
    }
    return json_digest(parts)[:20]


@lru_cache(maxsize=1)
def _installed() -> list[str]:
    names: list[str] = derived_value("packages", None, installed_packages)
    return names
