"""Sphinx, loaded once, for `make live`: each line of its input is a build of some changed pages.

It answers each with a line of JSON: the warnings and errors, none if the build succeeded, and
whether this process ends, because Sphinx cannot build again after an exception.
"""

import io
import json
import sys
import traceback
from pathlib import Path

from jupyter_book.config import get_final_config
from sphinx.application import Sphinx

from robo_genesis.pipeline.command import ANSI, collect_rarely
from robo_genesis.pipeline.html.kept import read_again


def load(book: Path, folder: Path, complaints: io.StringIO) -> Sphinx:
    """Return Sphinx with the book's configuration, as Jupyter Book loads it.

    Args:
        book: folder of the pages.
        folder: of the output.
        complaints: gets warnings and errors.
    """
    toc = str(book / "_toc.yml")
    given = {"external_toc_path": toc, "nitpicky": True, "latex_individualpages": False}
    config, _ = get_final_config(
        user_yaml=book / "_config.yml", cli_config=given, sourcedir=book, use_external_toc=True
    )
    output = folder / "_build"
    return Sphinx(
        book, None, output / "html", output / ".doctrees", "html", config,
        status=None, warning=complaints, keep_going=True,
    )  # fmt: skip


def build(app: Sphinx, complaints: io.StringIO) -> list[str]:
    """Build what changed; return the warnings and errors.

    Raises:
        Exception: any that an extension raises.
    """
    complaints.seek(0)
    complaints.truncate()
    vars(app.env)["_pickled_doctree_cache"].clear()
    vars(app.env).pop("master_doctree", None)
    app.build()
    found = ANSI.sub("", complaints.getvalue()).splitlines()
    if found:  # what was not written correctly is written again
        vars(app.env).pop("robo_genesis_shown", None)
    return list(dict.fromkeys(line for line in found if line.strip()))


def main() -> None:
    """Build once for each line of the input; a line is a list of pages to read again."""
    collect_rarely()
    book, folder = map(Path, sys.argv[1:])
    answers, sys.stdout = sys.stdout, sys.stderr
    complaints, again = io.StringIO(), set[str]()
    app = None
    for line in sys.stdin:
        again |= set(json.loads(line))
        try:
            app = app or load(book, folder, complaints)
            read_again(folder, again)
            found = build(app, complaints)
        except Exception as error:  # the author's page may raise anything
            traceback.print_exc()
            said = [f"{type(error).__name__}: {error}"]
            print(json.dumps({"said": said, "ended": True}), file=answers, flush=True)
            return
        again = again if found else set()
        print(json.dumps({"said": found, "ended": False}), file=answers, flush=True)


if __name__ == "__main__":
    main()
