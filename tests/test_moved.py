"""Sentences that read differently in two builds of the same pages."""

from pathlib import Path

import pytest

from robo_genesis.moved import (
    COMPUTED,
    INSERTED,
    STATUS,
    Moved,
    Sentence,
    moved_sentences,
    sentences,
)
from robo_genesis.sphinx_ledger import LEDGER

PAGE = """<html><body><nav><p>Menu 1.</p></nav><article>
<h1>Lesson</h1>
<p>It rose in <span class="measured" data-provenance="run 1234abcd">{time} s</span>. Then it
stayed. The rest holds.</p>
<ul><li>one <ul><li>inner</li></ul></li></ul>
<div class="cell_input"><pre>x = {source}</pre></div>
<div class="cell_output"><p>The overshoot goes {way} (G1 1.5 %, G2 2.5 %).</p>
<table><tr><th>case</th><th>value</th></tr><tr><td>G1</td><td><p>{cell}</p></td></tr></table>
<pre>line one
[Genesis] [04:28:32] [INFO] Scene {source} created.
[Genesis 04:39:15 WARNING] Neutral {source}.
[W 11/21/26 04:41:27.754 12581] [frontend.cpp:b@1] {source}
counted {line}</pre></div>
<p class="lesson-status">measured {date}, run {run}.</p>
<script>var n = {source};</script>
</article></body></html>"""
SAME = {
    "time": "0.31", "source": "1", "way": "up", "cell": "7.5", "line": "neutral",
    "date": "2026-11-21", "run": "0123456789abcdef" * 2,
}  # fmt: skip


def site(folder: Path, **changes: str) -> Path:
    folder.mkdir(exist_ok=True)
    values = SAME | changes
    text = PAGE
    for name, value in values.items():
        text = text.replace(f"{{{name}}}", value)
    (folder / "lab.html").write_text(text)
    return folder


def moved(tmp_path: Path, **changes: str) -> list[Moved]:
    return moved_sentences(site(tmp_path / "old"), site(tmp_path / "new", **changes))


def test_sentences_rows_and_lines_are_read_once_each_and_sources_never(tmp_path):
    site(tmp_path)
    found = [(one.text, one.kind) for one in sentences((tmp_path / "lab.html").read_text())]
    assert found == [
        ("Lesson", STATUS),
        ("It rose in 0.31 s.", INSERTED),
        ("Then it stayed.", INSERTED),
        ("The rest holds.", INSERTED),
        ("one", STATUS),
        ("inner", STATUS),
        ("The overshoot goes up (G1 1.5 %, G2 2.5 %).", COMPUTED),
        ("case | value", COMPUTED),
        ("G1 | 7.5", COMPUTED),
        ("line one", COMPUTED),
        ("counted neutral", COMPUTED),
        ("measured 2026-11-21, run 0123456789abcdef0123456789abcdef.", STATUS),
    ]


@pytest.mark.parametrize(
    ("change", "kind", "old", "new"),
    [
        ({"time": "0.32"}, INSERTED, "It rose in 0.31 s.", "It rose in 0.32 s."),
        ({"cell": "7.6"}, COMPUTED, "G1 | 7.5", "G1 | 7.6"),
        ({"line": "limits"}, COMPUTED, "counted neutral", "counted limits"),
        ({"way": "down"}, COMPUTED, "The overshoot goes up (G1 1.5 %, G2 2.5 %).",
         "The overshoot goes down (G1 1.5 %, G2 2.5 %)."),
    ],
)  # fmt: skip
def test_one_changed_value_moves_its_own_sentence_alone(tmp_path, change, kind, old, new):
    assert moved(tmp_path, **change) == [Moved("lab", kind, old, new)]


@pytest.mark.parametrize(
    "change",
    [{}, {"date": "2027-01-02"}, {"run": "fedcba9876543210" * 2}, {"source": "2"}],
)
def test_what_differs_between_any_two_runs_is_not_reported(tmp_path, change):
    assert moved(tmp_path, **change) == []


def test_a_line_that_comes_does_not_move_its_neighbours(tmp_path):
    found = moved(tmp_path, line="neutral\nmore")
    assert found == [Moved("lab", COMPUTED, "", "more")]


def test_a_page_of_one_build_alone_is_reported(tmp_path):
    (site(tmp_path / "new") / "more.html").write_text("<p>New.</p>")
    assert moved_sentences(site(tmp_path / "old"), tmp_path / "new") == [
        Moved("more", STATUS, "", "New.")
    ]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("run 7c694fce · ledger", "run 12345678 · ledger"),
        ("run | 7c694fce", "run | 0e55e7aa"),
        ("measured 2026-11-21.", "measured 2027-01-02."),
        ("from 2026-11-21 05:11:12", "from 2027-01-02 23:59:01"),
        ("at 2026-11-21T05:11:12.25Z", "at 2026-11-21T05:11:13.5Z"),
        (f"run {'0123456789abcdef' * 2}, 2026-11-21", f"run {'f' * 32}, 2027-01-02"),
    ],
)
def test_run_ids_and_moments_have_the_same_content(old, new):
    assert Sentence(old, STATUS).content == Sentence(new, STATUS).content


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("It is 0.12345678 rad.", "It is 0.87654321 rad."),
        ("12345678 steps", "87654321 steps"),
        ("they run 12345678.5 steps", "they run 87654321.5 steps"),
        ("seed | 12345678", "seed | 87654321"),
        ("sha256 7c694fce", "sha256 0e55e7aa"),
        ("from 2026-11-21 to 5", "from 2026-11-21 to 6"),
        ("2026-11-21 12 of 12", "2026-11-21 11 of 12"),
    ],
)
def test_numbers_and_digests_have_a_content_of_their_own(old, new):
    assert Sentence(old, STATUS).content != Sentence(new, STATUS).content


def test_the_ledger_repeats_what_the_report_says_elsewhere_and_is_left_out(tmp_path):
    for text, build in (("One.", "old"), ("Another.", "new")):
        page = tmp_path / build / f"{LEDGER}.html"
        page.parent.mkdir(parents=True)
        page.write_text(f"<p>{text}</p>")
        page.with_name("other-ledger.html").write_text(f"<p>{text}</p>")
    found = moved_sentences(tmp_path / "old", tmp_path / "new")
    assert found == [Moved("evidence/other-ledger", STATUS, "One.", "Another.")]
