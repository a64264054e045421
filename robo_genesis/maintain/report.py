"""The refresh report: what another engine version changes in evidence and sentences."""

import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from difflib import SequenceMatcher
from itertools import groupby, zip_longest
from pathlib import Path

from bs4 import BeautifulSoup

from robo_genesis.core.document import Document, Part
from robo_genesis.core.project import STORE
from robo_genesis.evidence import report
from robo_genesis.evidence.compare import BundleComparison, compare
from robo_genesis.evidence.refusals import BundleRefused
from robo_genesis.evidence.rows import SEVERITY, worst
from robo_genesis.pipeline.pages.book import code_digest, find_pages
from robo_genesis.pipeline.pages.page_folder import (
    OUTPUTS,
    PageRefused,
    find_bundle,
    read_record,
)
from robo_genesis.pipeline.pages.store import executions, folders

Pair = tuple[str, str]

# Text that differs between any two runs of one version: run ids, digests and dates with
# times.
VOLATILE = re.compile(
    r"\brun[ |]+[0-9a-f]{8}\b(?!\.\d)|\b[0-9a-f]{32,64}\b"
    r"|\b\d{4}-\d\d-\d\d(?:[T ]\d\d:\d\d[\d:.]*Z?)?"
)
# The beginning of a log line of the engine or its compiler; bundles supply the
# warnings.
LOG = re.compile(r"\[(Genesis\b|[TDIWEC] \d\d/\d\d/)")
END = re.compile(r"(?<=[.!?])\s+(?=[^\s\d])")
BLOCKS = "p, li, tr, figcaption, caption, dt, dd, pre, h1, h2, h3, h4"
HIDDEN = "math, svg, .cell_input"
BREAK = "\x1e"

# The ledger lists digests of other pages; the costs are the times of the build itself.
LEFT_OUT = {Path("evidence", "ledger.html"), Path("performance", "costs.html")}

# How to decide about a page that failed or was refused.
RULE_OR_ENGINE = (
    "If the run obeys mechanics, our page or check expects more than the engine documents, for "
    "example an order of work within a step: correct it. If it does not, or if the interface "
    "changed: adapt the page, or keep the pin and report the change to the engine's developers."
)
NOTHING = "Nothing was found here, or the trial failed before."


@dataclass(frozen=True, slots=True)
class EngineBuild:
    """What one engine version made of a checkout.

    `bundles` is lesson/page/backend → folder of each page that was executed. `site` is
    the folder of the HTML, which a refused build lacks.
    """

    version: str
    bundles: dict[str, Path]
    site: Path


@dataclass(frozen=True, slots=True)
class Refresh:
    """The comparison of two builds of one checkout, each with its engine version.

    `missing` is lesson/page/backend → why its bundles were not compared; `changed` holds
    (page, old, new) of each changed sentence, see `changed_sentences`. `failed` says what
    failed and what to do; what was not reached is empty then. `pages` is the name of each
    page that is not accepted → `failed` or `refused`, and why.
    """

    versions: Pair
    comparisons: tuple[BundleComparison, ...] = ()
    missing: dict[str, str] = field(default_factory=dict)
    changed: tuple[tuple[str, str, str], ...] = ()
    failed: tuple[str, ...] = ()
    pages: Mapping[str, Pair] = field(default_factory=dict)

    @property
    def state(self) -> str:
        """The worst state of a page; a page that one build lacks cannot be compared."""
        lacking = [SEVERITY[-1]] if self.missing or self.failed else []
        return worst([comparison.state for comparison in self.comparisons] + lacking)


def read_build(root: Path, version: str, site: Path) -> EngineBuild:
    """Return what an engine version has built in a checkout that pins it, refused or not.

    Args:
        root: the checkout.
        version: of the engine.
        site: the folder of the HTML.
    """
    bundles = {}
    for page in find_pages(root / "book"):
        for folder in folders(executions(root / ".cache" / STORE, page)):
            with suppress(PageRefused):  # it is not of a build of today
                record = read_record(folder)
                bundle = find_bundle(folder / OUTPUTS)
                current = record.engine == version and record.code == code_digest(page)
                if bundle and current:
                    bundles[f"{page.lesson}/{page.page}/{bundle.name}"] = bundle
                    break
    return EngineBuild(version, bundles, site)


def compare_builds(old: EngineBuild, new: EngineBuild) -> Refresh:
    """Compare what two engine versions made of one checkout."""
    comparisons = []
    alone = sorted(old.bundles.keys() ^ new.bundles.keys())
    missing = dict.fromkeys(alone, "In one build only.")
    for name in sorted(old.bundles.keys() & new.bundles.keys()):
        try:
            comparisons.append(compare(old.bundles[name], new.bundles[name]))
        except BundleRefused as error:
            missing[name] = str(error)
    versions = old.version, new.version
    changed = changed_sentences(old.site, new.site, versions)
    sentences = tuple(changed) if new.site.is_dir() else ()
    return Refresh(versions, tuple(comparisons), missing, sentences)


def changed_sentences(
    old: Path, new: Path, versions: Pair
) -> Iterator[tuple[str, str, str]]:
    """Yield (page, old, new) of each sentence that changed between two builds' folders of HTML.

    One of the texts is empty if the other has no counterpart. The pages' sources are
    the same, so a changed sentence contains a measured or computed value. A sentence in
    which only the engine's version differs is left out.
    """
    own = "|".join(map(re.escape, versions))
    volatile = re.compile(rf"{VOLATILE.pattern}|(?<![\d.])(?:{own})(?![\d.]*\d)")
    names = {
        page.relative_to(site) for site in (old, new) for page in site.rglob("*.html")
    }
    for name in sorted(names - LEFT_OUT):
        was, now = (list(sentences(site / name)) for site in (old, new))
        before, after = (
            [volatile.sub("…", text) for text in page] for page in (was, now)
        )
        matcher = SequenceMatcher(None, before, after, autojunk=False)
        for tag, a, b, c, d in matcher.get_opcodes():
            if tag != "equal":
                for pair in zip_longest(was[a:b], now[c:d], fillvalue=""):
                    yield name.with_suffix("").as_posix(), *pair


def sentences(page: Path) -> Iterator[str]:
    """Yield the sentences of a page's article, none if the page does not exist.

    A table row counts as one sentence, as does a line of printed output.
    """
    soup = BeautifulSoup(
        page.read_text("utf8") if page.is_file() else "", "html.parser"
    )
    article = soup.select_one("article") or soup
    for hidden in article.select(HIDDEN):
        hidden.decompose()
    for cell in article.select("th, td"):
        cell.string = f"{cell.get_text(' ', strip=True)} | "
    for output in article.select("pre"):
        output.string = output.get_text().replace("\n", BREAK)
    for block in article.select(BLOCKS):
        block.insert(0, BREAK)
        block.append(BREAK)
    for piece in article.get_text().split(BREAK):
        text = " ".join(piece.split())
        yield from (s for s in END.split(text) if s and not LOG.match(text))


def summary(refresh: Refresh) -> str:
    """Return the result in one line."""
    result = refresh.failed[0] if refresh.failed else refresh.state.capitalize()
    return f"{result}; changed sentences: {len(refresh.changed)}"


def document(refresh: Refresh) -> Document:
    """Return the whole report."""
    title = f"Engine {' → '.join(refresh.versions)}"
    return Document(title, f"{summary(refresh)}.", list(_parts(refresh)))


def _parts(refresh: Refresh) -> Iterator[Part]:
    """Yield the parts of the report.

    The part of the pages has one row for each. Rows that are equal are counted there
    and left out below: most of several thousand rows are.
    """
    if refresh.failed:
        what, remedy = refresh.failed
        reasons = [(page, *reason) for page, reason in refresh.pages.items()]
        head = ("page", "result", "reason")
        yield Part(what, [head, *reasons], remarks=[remedy, RULE_OR_ENGINE])
    rows = [("page", "result", "rows")]
    for one in refresh.comparisons:
        name = f"{one.new.lesson} {one.new.page}"
        rows.append((name, one.state, report.verdict(one)))
    rows += [(name, SEVERITY[-1], why) for name, why in refresh.missing.items()]
    yield Part("Pages", rows, NOTHING)
    for one in refresh.comparisons:
        table = report.changes(one)
        if one.remarks or len(table) > 1:
            yield Part(report.title(one), table, remarks=one.remarks)
    for page, changed in groupby(refresh.changed, key=lambda one: one[0]):
        sentences = [("old", "new"), *(one[1:] for one in changed)]
        yield Part(f"Sentences of {page}", sentences)
