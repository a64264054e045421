"""Ways to spoil the bundle in a folder; a spoiler returns the folder if it moved it."""

import json
from functools import partial, reduce
from operator import getitem
from pathlib import Path

import numpy as np
from lessons import changed_runs as changes

from robo_genesis.core.trace import Trace
from robo_genesis.evidence import bundle
from robo_genesis.evidence.bundle import ARRAYS, LOG, MANIFEST, METRICS
from robo_genesis.evidence.reader import from_bundle
from robo_genesis.lessons.l04.pages import LAB

FIELDS = {field: name for field, (name, *_) in Trace.arrays().items()}
CHECKS = [check.__name__ for check in LAB.checks]

TORCH = {
    "amdgpu": {
        "torch_version": "2.13.0+rocm7.1",
        "hip_version": "7.1.25424",
        "cuda_version": None,
    },
    "cuda": {
        "torch_version": "2.13.0+cu130",
        "hip_version": None,
        "cuda_version": "13.0",
    },
}


def edit(folder, name, change):
    """Change the JSON of one file in place, also to values that the recorder does not write."""
    path = folder / name
    value = json.loads(path.read_text("utf8"))
    change(value)
    path.write_text(json.dumps(value), "utf8")


def editing(name):
    return lambda change: lambda folder: edit(folder, name, change)


manifest, metrics = editing(MANIFEST), editing(METRICS)


def put(file, /, *path, **values):
    """Write values into the object at a path in a file; a function gets the old value."""

    def change(content):
        place = reduce(getitem, path, content)
        place |= {n: v(place[n]) if callable(v) else v for n, v in values.items()}

    return editing(file)(change)


def pop(file, *path):
    """Remove the entry at a path in a file."""
    return editing(file)(
        lambda content: reduce(getitem, path[:-1], content).pop(path[-1])
    )


facts = part = partial(put, MANIFEST)
modules = partial(facts, "source", "modules")
check = partial(facts, "checks")
joint = partial(put, ARRAYS, "joints")
case = partial(put, ARRAYS, "cases")
coords = partial(put, ARRAYS, "coords")
metric = partial(put, METRICS, "G2", "overshoot")


def remove(name):
    return lambda folder: (folder / name).unlink()


def write(name, content):
    return lambda folder: (folder / name).write_text(content, "utf8")


def both(*spoilers):
    def change(folder):
        for spoil in spoilers:
            folder = moved(spoil(folder), folder)
        return folder

    return change


def moved(returned, folder):
    """Return where a bundle is after a spoiler, of which few move it."""
    return returned if isinstance(returned, Path) else folder


def filed_as(name):
    return lambda folder: folder.rename(folder.with_name(name))


def seal(folder):
    """List every file with its digest and compute the key, as a recorder with a fault would."""

    def change(content):
        content["files"] = bundle.list_files(folder)
        content["evidence_key"] = bundle.evidence_key(content)

    edit(folder, MANIFEST, change)


def on(actual, **changed):
    """Turn the CPU's bundle into one that an accelerator would have left, sealed, then changed."""
    found = {"actual": actual, "actual_at_end": actual, "arch": actual}
    found |= {"torch_device": "cuda", "requested": "auto", "driver": "6.16"}
    return both(
        part("backend", device_name="a GPU", **found, **TORCH[actual]),
        part("render", vendor="AMD", renderer="AMD Radeon (radeonsi)", software=False),
        filed_as(actual),
        seal,
        part("backend", **changed),
    )


def in_archive(name, change):
    """Change the arrays of one case in place, by their names."""

    def spoil(folder):
        path = folder / "arrays" / f"{name}.npz"
        with np.load(path) as stored:
            values = {array: np.array(stored[array]) for array in stored}
        change(values)
        np.savez(path, **values)

    return spoil


def rewrite(name="G1", **fields):
    """Change some fields of one case by their functions."""
    named = {FIELDS[field]: change for field, change in fields.items()}
    return in_archive(
        name,
        lambda arrays: arrays.update(
            {array: change(arrays[array]) for array, change in named.items()}
        ),
    )


def checked_again(folder):
    """Make the recorded checks those of the arrays and joints, failures included."""
    run = from_bundle(folder, bundle.read_manifest(folder), bundle.read_metrics(folder))
    facts(checks=[outcome.record() for outcome in run.outcomes()])(folder)


failing = both(put(METRICS, "model", "links", value=12), checked_again)
"""A run that fails a check of its own, as it would have been measured."""

older_engine = both(part("engine", version="1.2.0"), seal)
older_compiler = both(part("engine", quadrants_version="1.2.9"), seal)
drop_case = both(remove("arrays/G3.npz"), pop(ARRAYS, "cases", "G3"))

# Name → the code that refuses the bundle, and the spoiler. The first table is of damage
# after the recording; in the second, the recorder or the code of the course had a fault.
DAMAGED = {
    "no manifest": ("missing-file", remove(MANIFEST)),
    "an unknown field": ("bad-schema", facts(state="verified")),
    "a later form": ("schema", facts(schema_version=4)),
    "an earlier form": ("older-schema", write(MANIFEST, '{"predicate": {}}')),
    "no log": ("files", remove(LOG)),
    "an extra file": ("files", write("frames/third.png", "x")),
    "another log": ("digest", write(LOG, "x")),
    "another key": ("key", facts(evidence_key="0" * 64)),
    "another found value": ("checks", check(0, "found", luck=1)),
}
CARELESS = {
    "another lesson": ("lesson", facts(lesson="l99")),
    "a page that the book lacks": ("lesson", facts(page="exam")),
    "a CPU's run in the folder of a GPU": ("backend", filed_as("amdgpu")),
    "another backend at the end": ("backend", part("backend", actual_at_end="cuda")),
    "cpu requested, amdgpu found": ("backend", on("amdgpu", requested="cpu")),
    "a Torch without HIP": ("torch", on("amdgpu", hip_version=None)),
    "a Torch that fell back to the CPU": ("torch", on("amdgpu", torch_device="cpu")),
    "a patched engine": ("engine-files", part("engine", files_match_wheel=False)),
    "an older engine": ("stale", older_engine),
    "an older compiler": ("stale", older_compiler),
    "other parameters": ("stale", part("parameters", stepped_joint="joint2")),
    "another module": ("stale", modules(metrics="0" * 64)),
    "no page digest": ("stale", part("source", page=None)),
    "a dropped case": ("cases", drop_case),
    "a wrong unit": (
        "labels",
        case("G2", "variables", "q_rad_or_m", unit=["deg"] * 9),
    ),
    "an archive that is none": ("bad-array", write("arrays/G1.npz", "x")),
    "arrays of Python's objects": ("bad-array", rewrite(q=lambda q: q.astype(object))),
    "arrays that are not finite": (
        "bad-trace",
        rewrite(q=changes.put((-1, 0), np.nan)),
    ),
    "a link elsewhere": ("failed", rewrite(link_pos=changes.put((5, 1, 2), 0.1))),
    "a frame that is no picture": ("frames", write("frames/final.png", "x")),
    "a frame too few": ("frames", remove("frames/final.png")),
    "frames without a camera": ("frames", part("render", mode="skip")),
    "a metric of another rule": ("metrics", metric(value=0.0)),
    "a check left out": ("checks", pop(MANIFEST, "checks", -1)),
    "a failed check": ("failed", failing),
}
CARELESS = {name: (code, both(spoil, seal)) for name, (code, spoil) in CARELESS.items()}
SPOILED = DAMAGED | CARELESS
