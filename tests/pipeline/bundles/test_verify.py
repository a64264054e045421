import ast
import os
import re
import shutil
from pathlib import Path

import pytest
from checkout import copy_checkout
from spoilers import SPOILED, TORCH, both, moved, on, packages, part, predicate, seal
from tiny_book import commit, git

import robo_genesis
from robo_genesis.core.checks import FAILED
from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.pipeline.bundles import verify
from robo_genesis.pipeline.bundles.verify import changed, verify_bundle

READERS = ("evidence/*.py", "pipeline/bundles/*.py", "sim/**/*.py")
OF_BODIES = {"contact", "second-engine"}  # the tests of L03 spoil its runs


def codes():
    """Every code that the readers can refuse with, from their source."""
    package = Path(robo_genesis.__file__).parent
    trees = [
        ast.parse(file.read_text("utf8"))
        for name in READERS
        for file in package.glob(name)
    ]
    return {
        call.args[0].value
        for tree in trees
        for call in ast.walk(tree)
        if isinstance(call, ast.Call)
        and isinstance(call.func, ast.Name)
        and call.func.id
        in ("BundleRefused", "expect", "expect_equal", "unexpected", "broken", "apart")
        and isinstance(call.args[0], ast.Constant)
    }


def test_every_code_has_a_spoiler():
    reached = {code for *both, _ in SPOILED.values() for code in both if code}
    apart = {
        "run-id",
        "copy",
        "commit",
    } | OF_BODIES  # these need a second run, or a repository
    assert reached | apart == codes() | {FAILED}


def test_an_accepted_bundle_is_recomputed_only_when_something_changed(
    folder, monkeypatch
):
    recomputed, recompute = [], verify.recompute

    def counted(*given):
        recomputed.append(given)
        return recompute(*given)

    monkeypatch.setattr(verify, "recompute", counted)
    accepted = verify_bundle(folder, once=True)
    assert accepted == verify_bundle(folder) == bundle.read_manifest(folder)
    recomputed.clear()  # another test may have had the same bundle accepted
    assert verify_bundle(folder, once=True) == accepted
    assert recomputed == []
    with pytest.raises(BundleRefused, match="run_id"):
        verify_bundle(folder, "0" * 32, once=True)
    code = os.urandom(16)  # in no cache
    monkeypatch.setattr(verify, "_code", lambda: code)
    verify_bundle(folder, once=True)
    assert len(recomputed) == 1
    (folder / "metrics.json").write_text(
        (folder / "metrics.json").read_text().replace("1", "2", 1)
    )
    seal(folder)
    for _ in range(2):  # a refusal is not kept
        with pytest.raises(BundleRefused):
            verify_bundle(folder, once=True)
    assert len(recomputed) == 3


@pytest.mark.parametrize(
    ("change", "actual"),
    [
        (lambda folder: folder, "cpu"),
        (on("amdgpu"), "amdgpu"),
        (on("cuda"), "cuda"),
        (both(part("backend", **TORCH["cuda"]), packages(torch="2.13.0")), "cpu"),
    ],
)
def test_a_sound_bundle_of_each_backend_is_accepted(folder, change, actual):
    there = moved(change(folder), folder)
    accepted = verify_bundle(there)
    assert accepted == bundle.read_manifest(there)
    assert accepted.predicate.backend.actual == actual


def refusal(folder):
    with pytest.raises(BundleRefused) as caught:
        verify_bundle(folder)
    said = str(caught.value)
    assert re.fullmatch(rf"{caught.value.code}: .{{1,880}}\.", said)
    return caught.value.code, "expected" in said


@pytest.mark.parametrize("how", SPOILED)
def test_a_spoiled_bundle_is_refused_also_after_digests_and_key_were_made_right(
    folder, how
):
    code, sealed, spoil = SPOILED[how]
    there = moved(spoil(folder), folder)
    found, says_what_is_valid = refusal(there)
    assert found == code
    assert says_what_is_valid or code == "bad-schema"
    if sealed and (there / "manifest.json").exists():
        seal(there)
        assert refusal(there)[0] == sealed


def test_run_lesson_and_page_are_the_expected_ones(folder):
    verify_bundle(
        folder, bundle.read_manifest(folder).predicate.run_id, lesson="l04", page="lab"
    )
    with pytest.raises(BundleRefused, match=r"^run-id: .*Execute the page again"):
        verify_bundle(folder, "f" * 32)
    with pytest.raises(
        BundleRefused, match=r"^lesson: .*page is lab, expected lecture"
    ):
        verify_bundle(folder, page="lecture")


@pytest.fixture
def checkout(tmp_path):
    """A copy of the checkout, to change."""
    return copy_checkout(tmp_path / "checkout")


LAB = "book/lessons/l04-joint-control/lab.md"
SPEC, METRICS, CLAIMS = (
    f"robo_genesis/lessons/l04/{n}.py" for n in ("spec", "metrics", "checks")
)
HARMLESS = [
    (LAB, "page.facts()", "page.facts()  # once"),
    (LAB, "\n# ", "\n# Another title, and "),
    (METRICS, "Share of the step that counts", "The share that counts"),
    (CLAIMS, "Start, target, gains", "Start, gains, target"),
    (SPEC, '"rad": (1e-4, 1e-3)', '"rad": (1e-3, 1e-2)'),
    ("robo_genesis/core/plotting.py", '"""\n', '"""\n\nMORE = 1\n'),
]
UNKNOWN = "1" * 40
MEASURED = (METRICS, "float(qd[-1])", "float(abs(qd[-1]))")


def edit(checkout, name, old, new):
    """Edit a file of a checkout."""
    source = (checkout / name).read_text("utf8")
    assert old in source
    (checkout / name).write_text(source.replace(old, new, 1), "utf8")


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
        ([MEASURED], ["source.modules.lessons.l04.metrics"]),
    ],
)
def test_an_edit_makes_stale_what_it_decides_and_nothing_else(
    folder, checkout, edits, stale
):
    for change in edits:
        edit(checkout, *change)
    found = changed(bundle.read_manifest(folder), checkout, checkout / "book") or []
    assert [path for path, *_ in found] == stale


def test_a_commit_is_older_than_the_run_and_has_its_code(folder, checkout, tmp_path):
    gpu = on("amdgpu")(Path(shutil.copytree(folder, tmp_path / "gpu" / "cpu")))
    edit(checkout, *MEASURED)
    commit(checkout)
    other = git(checkout, "rev-parse", "HEAD").strip()
    edit(checkout, METRICS, *MEASURED[:0:-1])
    commit(checkout)
    head = git(checkout, "rev-parse", "HEAD").strip()

    def verified(at, named, dirty=False, **times):
        predicate(git={"commit": named, "dirty": dirty}, **times)(at)
        verify_bundle(at, root=checkout, book=checkout / "book")

    for at in (folder, gpu):
        verified(at, head)
        verified(at, other, dirty=True)
        with pytest.raises(
            BundleRefused, match=rf"^commit: .*{other} is source\.modules\."
        ):
            verified(at, other)
    edit(checkout, *HARMLESS[0])
    verified(folder, head)
    verified(folder, UNKNOWN)  # as of a student's own clone
    with pytest.raises(BundleRefused, match=r"^commit: .*expected one in the history"):
        verified(gpu, UNKNOWN, dirty=True)
    (checkout / ".git" / "shallow").write_text(f"{head}\n")
    verified(gpu, UNKNOWN)
    with pytest.raises(BundleRefused, match=r"^time: .*expected after its commit"):
        verified(
            folder, head, started="2020-01-01T00:00:00Z", ended="2020-01-01T00:00:00Z"
        )
