"""The modules behind a page, by the import statements of their sources; nothing is imported.

Two keys use them. The *evidence key* of a bundle covers the modules that measure its
numbers. The *fingerprint* of a page decides whether the page has to run again, and
covers whatever it imports.
"""

import os
import platform
from collections.abc import Callable, Iterable
from functools import cache
from itertools import accumulate
from pathlib import Path
from typing import TYPE_CHECKING

from robo_genesis.core import project
from robo_genesis.core.files import NO_SOURCE, files_below, json_digest
from robo_genesis.core.project import ROOT
from robo_genesis.evidence.bundle import sha256

from .syntax import PACKAGE, ModuleCode, read_module

if TYPE_CHECKING:  # a verification loads no Jupyter
    from .book import Page

COMPUTING = ("core", "sim", "lessons")  # The sub-packages with modules that measure


class Tree:
    """The files of the package below a folder, each looked for and read once, for several pages."""

    def __init__(self, root: Path = ROOT) -> None:
        self.root = root
        self.module: Callable[[str], Path | None] = cache(self._module)
        self.code: Callable[[Path], ModuleCode] = cache(self._code)

    def _module(self, name: str) -> Path | None:
        """Return the file of a module, None if the name is not a module."""
        base = os.path.join(
            self.root, *name.split(".")
        )  # called for thousands of names
        candidates = (f"{base}.py", os.path.join(base, "__init__.py"))
        return next((Path(path) for path in candidates if os.path.isfile(path)), None)

    def _code(self, path: Path) -> ModuleCode:
        package = ".".join(path.parent.relative_to(self.root).parts)
        return read_module(path.read_text("utf8"), package)

    def closure(
        self,
        names: Iterable[str],
        enter: Callable[[str, Path], bool] = lambda name, path: True,
    ) -> dict[str, Path]:
        """Return the package's modules behind some dotted names, directly or through others.

        Args:
            names: of modules or of something in them; others are ignored.
            enter: whether a module belongs to the result; what only others import does
                not.

        Returns:
            Module name to file, packages by their `__init__.py`.
        """
        found: dict[str, Path] = {}
        waiting = list(names)
        seen: set[str] = set()
        while waiting:
            for name in accumulate(waiting.pop().split("."), "{}.{}".format):
                path = None if name in seen else self.module(name)
                seen.add(name)
                if path is None or not enter(name, path):
                    continue
                found[name] = path
                waiting += self.code(path).imports
        return found

    def measures(self, name: str, path: Path) -> bool:
        """Whether a module belongs to evidence keys, if a measuring page uses it.

        It is in `core`, `sim` or `lessons`, it is not the `__init__.py` of a package,
        and it does not say `MEASURES = False`: such a module draws or words results,
        judges them, or holds data that `parameters()` covers.
        """
        inside = name.removeprefix(f"{PACKAGE}.").split(".")[0] in COMPUTING
        return inside and path.name != "__init__.py" and self.code(path).measures

    def data_for(self, modules: Iterable[str]) -> dict[str, str]:
        """Return digests, by names below the package, of all files that are not modules.

        They are those of `core`, `sim`, and each lesson of which there is a module. Others
        are not read, because a page that runs must read nothing of another lesson.

        Args:
            modules: dotted names.
        """
        package = self.root / PACKAGE
        names = (name.split(".") for name in modules)
        lessons = {name[2] for name in names if name[1:2] == ["lessons"] and name[2:]}
        return {
            path.relative_to(package).as_posix(): sha256(path)
            for folder in ("core", "sim", *(f"lessons/{each}" for each in lessons))
            for path in files_below(package / folder, left_out=NO_SOURCE)
            if path.suffix != ".py"
        }


def lesson_modules(lesson: str, root: Path) -> list[str]:
    """Return the modules below the folder of a lesson."""
    files = sorted((root / PACKAGE / "lessons" / lesson).rglob("*.py"))
    names = (path.relative_to(root).with_suffix("").parts for path in files)
    return [".".join(name) for name in names if all(map(str.isidentifier, name))]


def measuring_modules(
    lesson: str, imports: Iterable[str], root: Path = ROOT
) -> dict[str, str]:
    """Return the modules and data that decide what a page measures, with their digests.

    They are all modules of the lesson that measure, what the page itself imports, and
    what these import; see `Tree.measures`. The digest of a module is that of its
    syntax. With them go the data files of the lesson and of `core` and `sim`.

    Args:
        lesson: the name of its folder.
        imports: what the cells of the page import, see `Code`.
        root: the checkout.

    Returns:
        Module without the package's name, such as `core.trace`, or data file, such as
        `lessons/l04/arm.xml`, to digest.
    """
    tree = Tree(root)
    modules = tree.closure([*lesson_modules(lesson, root), *imports], tree.measures)
    return {
        name.removeprefix(f"{PACKAGE}."): tree.code(path).digest
        for name, path in sorted(modules.items())
    } | tree.data_for([*modules, f"{PACKAGE}.lessons.{lesson}"])


def running_modules(lesson: str) -> dict[str, str]:
    """Return `measuring_modules` of the page that runs in this process, as they are now.

    The build names the imports of the page in the environment.
    """
    return measuring_modules(lesson, os.environ.get(project.PAGE_IMPORTS, "").split())


def page_fingerprint(page: "Page", tree: Tree) -> str:
    """Return a digest of everything that decides the outputs of a page.

    It covers the lock, all installed versions, the version of Python, the environment
    contract, from which cell on the page is executed alone, the syntax of the page's
    cells, of the modules that they import and of the modules of its lesson, the claims
    of checks in them, and the data files of the package, except those of lessons from
    which nothing is imported.

    Args:
        page: an executed page.
        tree: the files of the checkout.

    Returns:
        20 hex digits.
    """
    own = lesson_modules(page.lesson, tree.root) if page.lesson else []
    modules = tree.closure([*page.code.imports, *own])
    code = {name: tree.code(path) for name, path in modules.items()}
    parts = {
        "lock": project.lock_digest(tree.root),
        "installed": sorted({name for _, name, _ in project.installed()}),
        "python": platform.python_version(),
        "environment": project.environment_contract(),
        "cells": page.code.digests,
        "modules": {name: [each.digest, each.claims] for name, each in code.items()},
        "data": tree.data_for(modules),
        "alone": page.alone,
    }
    return json_digest(parts)[:20]
