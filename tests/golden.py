"""Golden record of a refactoring: what the built book and the refusals are, and what changed.

`python tests/golden.py write FILE` records arrays, metrics and verdicts of all bundles, the codes
that refuse spoiled bundles, and the site's addresses, anchors, downloads, notebooks and texts.
`python tests/golden.py compare FILE` exits with 1 and lists the differences if there are any.
Texts are compared without run identifiers, digests, dates, run times and file sizes.
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
VERIFY = ("robo_genesis.evidence.verify", "verify_bundle")  # module and function
SPOILED = ("test_verify", "test_drop_bundles", "test_contact_bundles", "test_studied")
"""The test modules that verify spoiled bundles."""
SHOWN = 20
"""Lines of a kind or of a page that `compare` prints without `--full`."""
BLOCKS = "p, li, tr, caption, dt, dd, div, figure, figcaption, table, pre, summary, h1, h2, h3, h4"
MASKS = {
    r"\d{4}-\d\d-\d\dT[\d:.]+Z?|\b\d\d:\d\d(:\d\d)?\b": "<time>",
    r"\b\d{4}-\d\d-\d\d\b": "<date>",
    r"(?<![\d.])(?=\d*[a-f])(?=[a-f]*\d)[0-9a-f]{7,64}\b…?|(?<=\brun )\d{8}\b": "<digest>",
    r"\d[\d.,]*\s?(s|ms|µs|min)\b(?!/)": "<duration>",
    r"\d[\d.,]*\s?([kKMG]i?B|bytes)\b": "<size>",
}
Record = dict[str, dict[str, Any]]


def masked(text: str) -> str:
    text = " ".join(text.split())
    for pattern, mask in MASKS.items():
        text = re.sub(pattern, mask, text)
    return text


def bundles(book: Path) -> Record:
    record: Record = {"arrays": {}, "metrics": {}, "checks": {}}
    built = [path for path in book.rglob("manifest.json") if book / "html" not in path.parents]
    for path in sorted([*built, *(ROOT / "book" / "evidence").rglob("manifest.json")]):
        said = json.loads(path.read_text("utf8"))["predicate"]
        key = f"{'built' if path in built else 'recorded'} {said['lesson']}/{said['page']}"
        key += f"/{said['backend']['actual']}"
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


def spoiler(item: pytest.Function) -> str | None:
    """Return a test's name, or its only parameter if a table of its module has that key."""
    if not hasattr(item, "callspec"):
        return item.originalname
    values = list(item.callspec.params.values())
    tables = (table for table in vars(item.module).values() if isinstance(table, dict))
    return values[0] if len(values) == 1 and any(values[0] in table for table in tables) else None


class Tests:
    """Plugin of pytest that leaves tests without a spoiler out, and knows the running one's."""

    spoiler: str | None = None

    def pytest_collection_modifyitems(self, items: list[pytest.Function]) -> None:
        items[:] = [item for item in items if spoiler(item)]

    def pytest_runtest_setup(self, item: pytest.Function) -> None:
        self.spoiler = spoiler(item)


def refusals() -> Record:
    """Return the sorted codes by page and spoiler: as the bundle is and as it is sealed again."""
    sys.path.insert(0, str(ROOT))
    module, tests = importlib.import_module(VERIFY[0]), Tests()
    verify, codes = getattr(module, VERIFY[1]), defaultdict(list)

    def watched(folder: Path, *args: Any, **options: Any) -> Any:
        try:
            return verify(folder, *args, **options)
        except Exception as refused:
            name = f"{'/'.join(folder.parts[-3:-1])}: {tests.spoiler}"
            codes[name].append(getattr(refused, "code", repr(refused)))
            raise

    setattr(module, VERIFY[1], watched)  # before the tests import it
    files = [str(path) for name in SPOILED for path in (ROOT / "tests").rglob(f"{name}.py")]
    ended = pytest.main(["-qq", "-p", "no:cacheprovider", *files], [tests])
    if ended > pytest.ExitCode.TESTS_FAILED or len(files) < len(SPOILED):
        raise SystemExit(f"Not all spoiled bundles were verified: found {files}. Correct SPOILED.")
    return {"refusals": {name: sorted(found) for name, found in codes.items()}}


def site(html: Path) -> Record:
    record: Record = {"addresses": {}, "anchors": {}, "notebooks": {}, "texts": {}}
    downloads: Counter[str] = Counter()
    for path in sorted(path for path in html.rglob("*") if path.is_file()):
        name = path.relative_to(html).as_posix()
        if name.startswith(("_static/", "_sources/")):
            continue
        if path.suffix == ".html":
            page = BeautifulSoup(path.read_bytes(), "html.parser")
            record["addresses"][name] = True
            anchors = (tag for tag in page.select("[id]") if not tag.find_parent("svg"))
            record["anchors"] |= {f"{name}#{tag['id']}": True for tag in anchors}
            record["texts"][name] = sentences(page.select_one("article") or page)
            continue
        downloads[masked(name)] += 1
        if path.suffix == ".ipynb":
            cells = json.loads(path.read_text("utf8"))["cells"]
            texts = (f"[{cell['cell_type']}]\n{''.join(cell['source'])}" for cell in cells)
            record["notebooks"][path.name] = [masked(s) for t in texts for s in t.splitlines()]
    return record | {"downloads": dict(downloads)}


def sentences(article: Tag) -> list[str]:
    """Return an article's masked text by sentences, rows of tables and lines of code."""
    for unread in article.select("script, style"):
        unread.decompose()
    for picture in article.select("img[alt]"):
        picture.replace_with(f" [{picture['alt']}] ")
    for lines in article.select("pre"):
        lines.string = lines.get_text().replace("\n", "\0")
    for cell in article.select("td, th"):
        cell.append(" |")
    for block in article.select(BLOCKS):
        block.insert_before("\0")
        block.insert_after("\0")
    blocks = (masked(block) for block in article.get_text().split("\0"))
    return [s for block in blocks for s in re.split(r"(?<=[.?!]) (?=[A-Z])", block) if s]


def differences(old: Record, new: Record, shown: int | None) -> Iterator[str]:
    """Yield for each group that differs what was removed, added and changed."""
    for group in sorted({*old, *new}):
        before, after = old.get(group, {}), new.get(group, {})
        both = [key for key in before if key in after and before[key] != after[key]]
        lines = cut([f"  removed {key}" for key in before if key not in after], shown)
        lines += cut([f"  added {key}" for key in after if key not in before], shown)
        lines += cut([f"  {key}{change(before[key], after[key], shown)}" for key in both], shown)
        yield from [f"{group}:", *lines] if lines else []


def change(old: Any, new: Any, shown: int | None) -> str:
    if not isinstance(old, list):
        return f": {old} -> {new}"
    diff = list(difflib.unified_diff(old, new, lineterm="", n=0))[2:]
    return "\n".join(["", *cut([f"    {line}" for line in diff if line[0] != "@"], shown)])


def cut(lines: list[str], shown: int | None) -> list[str]:
    rest = len(lines[shown:]) if shown else 0
    return [*lines[:shown], f"    ... {rest} more (--full)"] if rest else lines


def recorded(book: Path) -> Record:
    """Return the record of a built book and of this checkout's refusals."""
    html = book.resolve() / "html"
    if not (html / "index.html").is_file():
        raise SystemExit(f"{html} is not a built site. Run `make book`, or name another --book.")
    inode = html.stat().st_ino
    record = bundles(html.parent) | site(html)
    if (book / "html").stat().st_ino != inode:
        raise SystemExit(f"{book} was replaced while it was read. Run this command again.")
    return record | refusals()


def main() -> int:
    parser = argparse.ArgumentParser(description=str(__doc__).partition("\n")[0])
    parser.add_argument("action", choices=("write", "compare"))
    parser.add_argument("file", type=Path, help="the record")
    parser.add_argument("--book", type=Path, default=ROOT / "book/_build", help="the built book")
    parser.add_argument("--full", action="store_true", help="print all differences")
    options = parser.parse_args()
    old = json.loads(options.file.read_text("utf8")) if options.action == "compare" else None
    new = recorded(options.book)
    if old is None:
        options.file.write_text(json.dumps(new, indent=1, ensure_ascii=False), "utf8")
    found = list(differences(new if old is None else old, new, None if options.full else SHOWN))
    print(*found or [", ".join(f"{len(new[group])} {group}" for group in new)], sep="\n")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
