import ast
import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from robo_genesis.evidence import bundle, traces, verify
from robo_genesis.evidence.bundle import BundleRefused
from robo_genesis.evidence.verify import verify_bundle


def edit(folder, name, change):
    """Change the JSON of one file in place."""
    path = folder / name
    value = json.loads(path.read_text("utf8"))
    change(value)
    path.write_text(json.dumps(value), "utf8")


def predicate(**values):
    return lambda folder: edit(folder, "manifest.json", lambda m: m["predicate"].update(values))


def part(name, **values):
    """Change one record of the predicate."""
    return lambda folder: edit(
        folder, "manifest.json", lambda m: m["predicate"][name].update(values)
    )


def keyed(spoil):
    """Spoil, then make the evidence key right again."""

    def change(manifest):
        manifest["predicate"]["evidence_key"] = bundle.evidence_key(manifest["predicate"])

    def both(folder):
        spoil(folder)
        edit(folder, "manifest.json", change)

    return both


def sealed(spoil):
    """Spoil, then list every file with its digest, as a careful forger would."""

    def both(folder):
        spoil(folder)
        files = sorted(p for p in folder.rglob("*") if p.is_file() and p.name != "manifest.json")
        subject = [
            {"name": p.relative_to(folder).as_posix(), "digest": {"sha256": bundle.sha256(p)}}
            for p in files
        ]
        edit(folder, "manifest.json", lambda m: m.update(subject=subject))

    return both


def flip_byte(folder):
    data = bytearray((folder / "log.txt").read_bytes())
    data[0] ^= 1
    (folder / "log.txt").write_bytes(data)


def cut_archive(folder):
    path = folder / "arrays" / "G1.npz"
    path.write_bytes(path.read_bytes()[:-500])


def repeat_key(folder):
    path = folder / "manifest.json"
    path.write_text(path.read_text("utf8").replace('"seed"', '"seed": 0, "seed"', 1), "utf8")


def nan_seed(folder):
    edit(folder, "manifest.json", lambda m: m["predicate"].update(seed=float("nan")))


def nan_metric(folder):
    edit(folder, "metrics.json", lambda m: m["G1"]["overshoot"].update(value=float("nan")))


def metric(**values):
    return lambda folder: edit(
        folder, "metrics.json", lambda m: m["G2"]["overshoot"].update(values)
    )


def add_subject(name):
    def change(manifest):
        manifest["subject"].append({"name": name, "digest": {"sha256": "0" * 64}})

    return lambda folder: edit(folder, "manifest.json", change)


def link_out(folder):
    outside = shutil.move(folder / "log.txt", folder.parent / "log.txt")
    (folder / "log.txt").symlink_to(outside)


def fail_check(folder):
    edit(folder, "manifest.json", lambda m: m["predicate"]["checks"][3].update(passed=False))


def parameter(folder):
    edit(folder, "manifest.json", lambda m: m["predicate"]["parameters"].update(stepped_joint="j"))


def module(folder):
    edit(
        folder,
        "manifest.json",
        lambda m: m["predicate"]["source"]["modules"].update(metrics="0" * 64),
    )


def rewrite(**values):
    """Write one case's archive anew, some arrays changed by their functions."""

    def change(folder):
        path = folder / "arrays" / "G1.npz"
        with np.load(path) as archive:
            kept = {**archive}
        kept |= {name: changed(kept[name]) for name, changed in values.items()}
        np.savez_compressed(path, **kept)

    return change


def nan_at_the_end(array):
    changed = np.array(array)
    changed[-1, 0] = np.nan
    return changed


def slower(array):
    return (np.array(array) * 0.5).astype(array.dtype)


def frame(run_id=None):
    """Write the first frame anew, stamped with another run or with none."""

    def change(folder):
        path = folder / "frames" / "initial.png"
        with Image.open(path) as picture:
            copy = picture.copy()
        stamp = PngInfo()
        if run_id:
            stamp.add_text("run_id", run_id)
        copy.save(path, pnginfo=stamp)

    return change


SPOILERS = {
    "no manifest": ("missing-file", lambda f: (f / "manifest.json").unlink()),
    "a key twice": ("bad-json", repeat_key),
    "NaN in the manifest": ("bad-json", nan_seed),
    "NaN in the metrics": ("bad-json", sealed(nan_metric)),
    "an unknown field": ("bad-schema", predicate(mood="good")),
    "a missing field": ("bad-schema", lambda f: edit(
        f, "manifest.json", lambda m: m["predicate"].pop("warnings"))),
    "a number as text": ("bad-schema", predicate(seed="0")),
    "an unknown backend": ("bad-schema", part("backend", actual="tpu")),
    "another schema": ("schema", keyed(predicate(schema_version=2))),
    "another lesson": ("lesson", keyed(predicate(lesson="l05"))),
    "another seed, old key": ("key", predicate(seed=1)),
    "another key": ("key", predicate(evidence_key="0" * 64)),
    "a flipped byte": ("digest", flip_byte),
    "a missing file": ("files", lambda f: (f / "arrays" / "G1.npz").unlink()),
    "an extra file": ("files", lambda f: (f / "extra.txt").write_text("x")),
    "an extra picture": ("files", lambda f: shutil.copy(
        f / "frames" / "final.png", f / "frames" / "third.png")),
    "a listed path above": ("path", add_subject("../cpu/log.txt")),
    "a listed absolute path": ("path", add_subject("/etc/hostname")),
    "a link out of the bundle": ("path", link_out),
    "another engine": ("stale", keyed(part("engine", version="1.4.5"))),
    "other parameters": ("stale", keyed(parameter)),
    "another module": ("stale", keyed(module)),
    "a patched engine": ("engine-files", part("engine", files_match_wheel=False)),
    "another backend than the folder": ("backend", part(
        "backend", actual="cuda", actual_at_end="cuda")),
    "another backend at the end": ("backend", part("backend", actual_at_end="cuda")),
    "a camera without frames": ("frames", sealed(lambda f: shutil.rmtree(f / "frames"))),
    "a frame without a stamp": ("frames", sealed(frame())),
    "a frame of another run": ("frames", sealed(frame("f" * 32))),
    "frames without a camera": ("frames", part("render", mode="skip")),
    "a cut archive": ("bad-array", sealed(cut_archive)),
    "arrays of another type": ("bad-array", sealed(
        rewrite(q_rad_or_m=lambda a: a.astype(np.float64)))),
    "arrays that are not finite": ("bad-trace", sealed(rewrite(q_rad_or_m=nan_at_the_end))),
    "a case that is missing": ("cases", sealed(lambda f: edit(
        f, "arrays.json", lambda a: a["cases"].pop("G3")))),
    "an edited metric": ("metrics", sealed(metric(value=0.0))),
    "a metric of another unit": ("metrics", sealed(metric(unit="degree"))),
    "a metric of another class": ("metrics", sealed(metric(**{"class": "performance"}))),
    "a metric that is missing": ("metrics", sealed(lambda f: edit(
        f, "metrics.json", lambda m: m["G1"].pop("rise_time")))),
    "a metric too many": ("metrics", sealed(lambda f: edit(
        f, "metrics.json", lambda m: m["G1"].update(grace=m["G1"]["overshoot"])))),
    "a group that is missing": ("metrics", sealed(lambda f: edit(
        f, "metrics.json", lambda m: m.pop("G1")))),
    "a group too many": ("metrics", sealed(lambda f: edit(
        f, "metrics.json", lambda m: m.update(G4={})))),
    "an edited count": ("metrics", sealed(lambda f: edit(
        f, "metrics.json", lambda m: m["model"]["links"].update(value=12)))),
    "edited arrays": ("metrics", sealed(rewrite(qd_rad_s_or_m_s=slower))),
    "a failed check": ("checks", fail_check),
    "a check left out": ("checks", lambda f: edit(
        f, "manifest.json", lambda m: m["predicate"]["checks"].pop())),
    "no check": ("checks", predicate(checks=[])),
}  # fmt: skip


def codes(module):
    """Every code that a module can refuse with, from its source."""
    calls = (n for n in ast.walk(ast.parse(Path(module.__file__).read_text())) if
             isinstance(n, ast.Call) and isinstance(n.func, ast.Name))  # fmt: skip
    return {
        call.args[0].value
        for call in calls
        if call.func.id in ("BundleRefused", "_expect") and isinstance(call.args[0], ast.Constant)
    }


def test_every_code_has_a_spoiler():
    every = codes(bundle) | codes(traces) | codes(verify)
    assert {code for code, _ in SPOILERS.values()} | {"run-id"} == every


def test_a_sound_bundle_is_accepted(folder):
    assert verify_bundle(folder) == bundle.read_manifest(folder)


def test_sealing_alone_changes_nothing(folder):
    keyed(sealed(lambda f: None))(folder)
    verify_bundle(folder)


@pytest.mark.parametrize("how", SPOILERS)
def test_a_spoiled_bundle_is_refused_with_its_code(folder, how):
    code, spoil = SPOILERS[how]
    spoil(folder)
    with pytest.raises(BundleRefused) as caught:
        verify_bundle(folder)
    assert caught.value.code == code
    assert str(caught.value).startswith(f"{code}: ")


def test_the_run_is_the_expected_one(folder):
    run_id = bundle.read_manifest(folder).predicate.run_id
    verify_bundle(folder, run_id)
    with pytest.raises(BundleRefused, match=r"^run-id: .*Execute the page again"):
        verify_bundle(folder, "f" * 32)


@pytest.mark.parametrize("name", ["cuda", "amdgpu", "CPU"])
def test_a_renamed_folder_relabels_nothing(folder, name):
    with pytest.raises(BundleRefused, match=r"^backend: "):
        verify_bundle(folder.rename(folder.with_name(name)))


NONSENSE = {
    "metrics without the model": lambda f: edit(f, "metrics.json", lambda m: m.pop("model")),
    "metrics as a list": lambda f: (f / "metrics.json").write_text("[]"),
    "a count as a number alone": lambda f: edit(
        f, "metrics.json", lambda m: m["model"].update(links=11)),
    "arrays without DOF names": lambda f: edit(
        f, "arrays.json", lambda a: a["coords"].pop("dof")),
    "arrays without joint4": lambda f: edit(
        f, "arrays.json", lambda a: a["coords"].update(dof=["joint1"])),
    "a frame that is no picture": lambda f: (f / "frames" / "final.png").write_text("x"),
    "arrays outside the bundle": lambda f: (
        shutil.copytree(f / "arrays", f.parent / "elsewhere"),
        edit(f, "arrays.json", lambda a: a["cases"]["G1"].update(file="../elsewhere/G1.npz")),
    ),
}  # fmt: skip


@pytest.mark.parametrize("how", NONSENSE)
def test_nonsense_is_refused_and_stops_nobody(folder, how):
    sealed(NONSENSE[how])(folder)
    with pytest.raises(BundleRefused):
        verify_bundle(folder)
