import os

import pytest
from checkout import copy_checkout
from spoilers import CARELESS, DAMAGED, moved

from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.pipeline.bundles import verify
from robo_genesis.pipeline.bundles.verify import changed, verify_bundle


def test_an_accepted_bundle_is_recomputed_only_when_something_changed(
    folder, monkeypatch
):
    runs, recompute = [], verify.recompute
    monkeypatch.setattr(
        verify, "recompute", lambda *of: runs.append(of) or recompute(*of)
    )
    code = os.urandom(16).hex()  # in no cache
    monkeypatch.setattr(verify, "_code", lambda: code)
    accepted = verify_bundle(folder, once=True)
    assert accepted == verify_bundle(folder, once=True) == bundle.read_manifest(folder)
    assert len(runs) == 1
    _, spoil = CARELESS["a metric of another rule"]
    spoil(folder)
    for _ in range(2):  # a refusal is not kept
        with pytest.raises(BundleRefused, match=r"^metrics: "):
            verify_bundle(folder, once=True)
    assert len(runs) == 3


@pytest.mark.parametrize("how", [*DAMAGED, *CARELESS])
def test_a_spoiled_bundle_is_refused_by_its_code(folder, how):
    code, spoil = (DAMAGED | CARELESS)[how]
    there = moved(spoil(folder), folder)
    with pytest.raises(BundleRefused, match=rf"^{code}: .{{1,900}}\.$"):
        verify_bundle(there)


def test_lesson_and_page_are_the_expected_ones(folder):
    verify_bundle(folder, lesson="l04", page="lab")
    with pytest.raises(BundleRefused, match=r"^lesson: .*page is lab, expected lect"):
        verify_bundle(folder, page="lecture")


LAB = "book/lessons/l04-joint-control/lab.md"
METRICS = "robo_genesis/lessons/l04/metrics.py"
HARMLESS = [
    (LAB, "page.facts()", "page.facts()  # once"),
    (LAB, "\n# ", "\n# Another title, and "),
]


@pytest.mark.parametrize(
    ("edits", "stale"),
    [
        (HARMLESS, []),
        ([("pyproject.toml", "-world==", "-world==9.")], ["engine.version"]),
        (
            [("requirements.lock", "\nquadrants==", "\nquadrants==9.")],
            ["engine.quadrants_version"],
        ),
        ([(LAB, "page.facts()", "pass")], ["source.page"]),
        (
            [(METRICS, "velocity=qd[-1]", "velocity=abs(qd[-1])")],
            ["source.modules.lessons.l04.metrics"],
        ),
    ],
)
def test_an_edit_makes_stale_what_it_decides_and_nothing_else(
    folder, tmp_path, edits, stale
):
    checkout = copy_checkout(tmp_path / "checkout")
    for name, old, new in edits:
        source = (checkout / name).read_text("utf8")
        assert old in source
        (checkout / name).write_text(source.replace(old, new, 1), "utf8")
    found = changed(bundle.read_manifest(folder), checkout, checkout / "book")
    assert [path for path, *_ in found] == stale
