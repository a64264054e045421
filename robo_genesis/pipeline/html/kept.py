"""The folder in which a build keeps Sphinx's doctrees and pages, and what they were made from.

The next build then reads and writes only the pages that changed. Everything else that
decides a page empties the folder. A render that did not succeed leaves a folder without
`STATE`, which the next build empties: a warning is given only when a page is read.
"""

import json
import shutil
from dataclasses import asdict, dataclass
from hashlib import sha256
from pathlib import Path

from robo_genesis.core.files import json_digest
from robo_genesis.core.project import ROOT
from robo_genesis.pipeline import up_to_date
from robo_genesis.pipeline.html.sphinx_process import read_again
from robo_genesis.pipeline.pages.book import page_files
from robo_genesis.pipeline.pages.page_folder import RECORD
from robo_genesis.pipeline.pages.page_index import PageIndex

STATE = "state.json"

# Sphinx writes this file if it found something that an incremental render could get
# wrong; see `site.frame.incremental`.
UNFIT = "unfit"


@dataclass(frozen=True, slots=True)
class State:
    """What a render reads: the digest of each page's source by name, and that of all else."""

    others: str
    pages: dict[str, str]


def read_state(book: Path, built: PageIndex, root: Path = ROOT) -> State:
    """Return the state of all that a render reads.

    Args:
        book: the folder of the pages.
        built: the executed pages. Whether this build ran them is not in the state: no
            page shows it.
        root: the checkout.
    """
    sources = page_files(book)
    pages = {
        name: sha256(path.read_bytes()).hexdigest() for name, path in sources.items()
    }
    # A page's record has digests of all files that its run left.
    records = [(folder / RECORD).read_bytes() for folder in built.folders.values()]
    runs = [
        built.model_dump(mode="json"),
        [sha256(record).hexdigest() for record in records],
    ]
    others = up_to_date.other_inputs(root, book, set(sources.values()))
    return State(json_digest(others | {"runs": runs}), pages)


def prepare(folder: Path, state: State) -> bool:
    """Empty the folder, or mark in it the pages that changed; return whether it was usable.

    The mark of success is removed. `keep` writes it again.

    Raises:
        OSError: the folder cannot be emptied.
    """
    try:
        last = State(**json.loads((folder / STATE).read_text("utf8")))
        (folder / STATE).unlink()
    except (OSError, ValueError, TypeError):
        last = State("", {})
    usable = last.others == state.others
    if not usable and folder.exists():
        shutil.rmtree(folder)
    folder.mkdir(parents=True, exist_ok=True)
    read_again(
        folder, {n for n, digest in state.pages.items() if last.pages.get(n) != digest}
    )
    return usable


def keep(folder: Path, before: State, after: State) -> None:
    """Mark a render as successful, unless an input changed meanwhile or the pages are unfit.

    Args:
        folder: the kept folder.
        before: the state from which the render began.
        after: the state now.
    """
    if before == after and not (folder / UNFIT).exists():
        (folder / STATE).write_text(json.dumps(asdict(after), indent=1) + "\n", "utf8")


def discard(folder: Path) -> None:
    """Make the next build empty the folder."""
    (folder / STATE).unlink(missing_ok=True)
