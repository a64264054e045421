"""Golden record of a refactoring: what the built book and the refusals are, and what changed.

`python tests/golden.py write FILE` records arrays, metrics and verdicts of all bundles, the codes
that refuse spoiled bundles, and the site's addresses, anchors, downloads, notebooks and texts.
`python tests/golden.py compare FILE` exits with 1 and lists the differences if there are any.
Run identifiers, digests, dates, times of day and file sizes are masked in texts. Times in seconds
are not: all of those on the pages are simulated, or were measured apart from the build.
"""

import argparse
import difflib
import hashlib
import importlib
import json
import re
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bs4 import BeautifulSoup, Tag

ROOT = Path(__file__).resolve().parents[1]
VERIFY = ("robo_genesis.pipeline.bundles.verify", "verify_bundle")  # module and function
SPOILED = ("pipeline/bundles/test_verify.py", "lessons/*/test_*bundles.py")  # patterns below tests
SHOWN = 20  # lines of a kind, or of a page, that are printed without --full
BLOCKS = "p, li, tr, caption, dt, dd, div, figure, figcaption, table, pre, summary, h1, h2, h3, h4"
MASKS = {
    r"\[I \d\d/\d\d/\d\d [\d:.]+ \d+\]|\d{4}-\d\d-\d\dT[\d:.]+Z?|\b\d\d:\d\d:\d\d\b": "<time>",
    r"\b\d{4}-\d\d-\d\d\b": "<date>",
    r"<[0-9a-f]{7}>": "<entity>",  # of the engine's log
    r"(?<![\w.])(?=\d*[a-f])(?=[a-f]*\d)[0-9a-f]{7,64}\b…?|(?<![\w.])\d{8}\b(?!\.\d)": "<digest>",
    r"About \d+ min to read: [\d,]+ words": "<reading time>",
    r"\d[\d.,]*\s?([kKMG]i?B|bytes)\b": "<size>",
}
Record = dict[str, dict[str, Any]]


def masked(text: str) -> str:
    for pattern, mask in MASKS.items():
        text = re.sub(pattern, mask, text)
    return text


def bundles(book: Path) -> Record:
    record: Record = {"arrays": {}, "metrics": {}, "checks": {}}
    built = [path for path in book.rglob("manifest.json") if book / "html" not in path.parents]
    for path in sorted([*built, *(ROOT / "book" / "evidence").rglob("manifest.json")]):
        said = json.loads(path.read_text("utf8"))["predicate"]
        key = f"{'built' if path in built else 'recorded'} {said['lesson']}/{said['page']}/"
        key += said["backend"]["actual"]
        record["checks"] |= {f"{key} {check['name']}": check["passed"] for check in said["checks"]}
        for group, items in json.loads(path.with_name("metrics.json").read_text("utf8")).items():
            for name, metric in items.items():
                record["metrics"][f"{key} {group}.{name}"] = f"{metric['value']} {metric['unit']}"
        for case in sorted(path.parent.rglob("*.npz")):
            with np.load(case) as stored:
                for name, array in stored.items():
                    digest = hashlib.sha256(array.tobytes()).hexdigest()
                    found = f"{array.dtype.str} {array.shape} {digest}"
                    record["arrays"][f"{key} {case.stem}.{name}"] = found
    return record


def refusals() -> Record:
    """Return the sorted codes by page and spoiler: as the bundle is and as it is sealed again.

    A spoiler is a test's only parameter, as a key of a table, or a test without parameters.
    """
    sys.path.insert(0, str(ROOT))
    module = importlib.import_module(VERIFY[0])
    verify, codes = getattr(module, VERIFY[1]), defaultdict(list)

    class Tests:
        def pytest_collection_modifyitems(self, items: list[pytest.Function]) -> None:
            items[:] = [item for item in items if self.spoils(item)]

        def given(self, item: pytest.Function) -> list[Any]:
            return list(item.callspec.params.values()) if hasattr(item, "callspec") else []

        def spoils(self, item: pytest.Function) -> bool:
            tables = [table for table in vars(item.module).values() if isinstance(table, dict)]
            given = self.given(item)
            return not given or (len(given) == 1 and any(given[0] in table for table in tables))

        def pytest_runtest_setup(self, item: pytest.Function) -> None:
            self.spoiler = (self.given(item) or [item.originalname])[0]

        def verify(self, folder: Path, *args: Any, **options: Any) -> Any:
            try:
                return verify(folder, *args, **options)
            except Exception as refused:
                name = f"{'/'.join(Path(folder).parts[-3:-1])}: {self.spoiler}"
                codes[name].append(getattr(refused, "code", repr(refused)))
                raise

    tests = Tests()
    setattr(module, VERIFY[1], tests.verify)  # before the tests import it
    files = [str(path) for name in SPOILED for path in sorted((ROOT / "tests").glob(name))]
    ended = pytest.main(["-qq", "-rN", "-p", "no:cacheprovider", *files], [tests])
    if ended > pytest.ExitCode.TESTS_FAILED or len(files) < len(SPOILED):
        raise SystemExit(f"Not all spoiled bundles were verified: found {files}. Correct SPOILED.")
    return {"refusals": {name: sorted(found) for name, found in codes.items()}}


def site(html: Path) -> Record:
    record: Record = {group: {} for group in ("addresses", "anchors", "notebooks", "texts")}
    record["downloads"] = Counter()
    for path in sorted(path for path in html.rglob("*") if path.is_file()):
        name = path.relative_to(html).as_posix()
        if name.startswith(("_static/", "_sources/")):
            continue
        if path.suffix == ".html":
            page = BeautifulSoup(path.read_bytes(), "html.parser")
            record["addresses"][name] = True
            anchors = (tag for tag in page.select("[id]") if not tag.find_parent("svg"))
            record["anchors"] |= {masked(f"{name}#{tag['id']}"): True for tag in anchors}
            record["texts"][name] = sentences(page.select_one("article") or page)
            continue
        record["downloads"][masked(name)] += 1
        if path.suffix == ".ipynb":
            cells = json.loads(path.read_text("utf8"))["cells"]
            texts = (f"[{cell['cell_type']}]\n{''.join(cell['source'])}" for cell in cells)
            record["notebooks"][path.name] = [masked(s) for t in texts for s in t.splitlines()]
    return record


def sentences(article: Tag) -> list[str]:
    """Return an article's masked text by sentences, rows of tables and lines of code."""
    for unread in article.select(
        "script, style, .headerlink, .page-history li, #time-of-each-page table"
    ):
        unread.decompose()
    for picture in article.select("img[alt], svg[aria-label]"):
        picture.replace_with(f" [{picture.get('alt') or picture['aria-label']}] ")
    for lines in article.select("pre"):
        lines.string = lines.get_text().replace("\n", "\0")
    for cell in article.select("td, th"):
        cell.append(" |")
    for block in article.select(f":is({BLOCKS}):not(:is(td, th) *)"):
        block.insert_before("\0")
        block.insert_after("\0")
    blocks = (masked(" ".join(block.split())) for block in article.get_text().split("\0"))
    return [s for block in blocks for s in re.split(r"(?<=[.?!]) (?=[A-Z])", block) if s]


def differences(old: Record, new: Record, shown: int | None) -> Iterator[str]:
    """Yield for each group that differs what was removed, added and changed."""
    for group in sorted({*old, *new}):
        before, after = old.get(group, {}), new.get(group, {})
        both = [key for key in before if key in after and before[key] != after[key]]
        lines = cut([f"  removed {key}" for key in before if key not in after], shown)
        lines += cut([f"  added {key}" for key in after if key not in before], shown)
        lines += cut(
            [f"  changed {key}{change(before[key], after[key], shown)}" for key in both], shown
        )
        yield from [f"{group}:", *lines] if lines else []


def change(old: Any, new: Any, shown: int | None) -> str:
    if not isinstance(old, list):
        return f": {old} -> {new}"
    diff = list(difflib.unified_diff(old, new, lineterm="", n=0))[2:]
    return "\n".join(["", *cut([f"    {line}" for line in diff if line[0] != "@"], shown)])


def cut(lines: list[str], shown: int | None) -> list[str]:
    rest = len(lines[shown:]) if shown else 0
    return [*lines[:shown], f"    ... {rest} more (--full)"] if rest else lines


def main() -> int:
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("action", choices=("write", "compare"))
    parser.add_argument("file", type=Path, help="the record")
    parser.add_argument("--book", type=Path, default=ROOT / "book/_build", help="the built book")
    parser.add_argument("--full", action="store_true", help="print all differences")
    options = parser.parse_args()
    old = json.loads(options.file.read_text("utf8")) if options.action == "compare" else None
    html = options.book.resolve() / "html"
    if not (html / "index.html").is_file():
        parser.error(f"{html} is not a built site. Run `make book`, or name another --book.")
    inode = html.stat().st_ino
    new = bundles(html.parent) | site(html)
    if (options.book / "html").stat().st_ino != inode:
        parser.error(f"{options.book} was replaced while it was read. Run this command again.")
    new |= refusals()
    if old is None:
        options.file.write_text(json.dumps(new, indent=1, ensure_ascii=False), "utf8")
    found = list(differences(new if old is None else old, new, None if options.full else SHOWN))
    counts = ", ".join(f"{len(new[group])} {group}" for group in new)
    print(*found or [f"{'Written' if old is None else 'No differences'}: {counts}."], sep="\n")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
