"""Files that directives write for their page, beside its HTML: each one belongs to its page."""

from pathlib import Path

from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment

REPLAYS, TAKEAWAYS = "replay", "takeaways"
"""Folders of such files in the site."""


def folders(app: Sphinx) -> tuple[Path, Path]:
    """Return where the files of replays and takeaways are."""
    html = Path(app.outdir)
    return html / REPLAYS, html / TAKEAWAYS


def note_files(env: BuildEnvironment, *files: Path) -> None:
    """Note that the page that is read writes some files."""
    noted: dict[str, set[str]] = vars(env).setdefault("robo_genesis_files", {})
    noted.setdefault(env.docname, set()).update(map(str, files))


def forget_files(app: Sphinx, env: BuildEnvironment, page: str) -> None:
    """Forget the files of a page that is read again."""
    vars(env).setdefault("robo_genesis_files", {}).pop(page, None)


def remove_others(app: Sphinx, env: BuildEnvironment) -> list[str]:
    """Remove the files that no page writes any more, and folders that become empty."""
    noted = set().union(*vars(env).get("robo_genesis_files", {}).values())
    for folder in folders(app):
        for path in sorted(folder.rglob("*"), reverse=True):
            if path.is_file() and str(path) not in noted:
                path.unlink()
        for path in sorted([*folder.rglob("*/"), folder], reverse=True):
            if path.is_dir() and not any(path.iterdir()):
                path.rmdir()
    return []


def setup(app: Sphinx) -> None:
    """Register the steps."""
    app.connect("env-purge-doc", forget_files)
    app.connect("env-updated", remove_others)
