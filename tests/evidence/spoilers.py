"""Bundles spoiled in one way each, with the code that refuses them.

`SPOILED` is name → (code as it is, code after digests and key were made right again, spoiler).
A spoiler changes the bundle in a folder; it returns the folder where it moved it.
"""

import io
import json
import os
import shutil
import struct
import warnings
import zipfile
import zlib
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from robo_genesis.core.experiment import Experiment
from robo_genesis.core.scene import CAMERA_RES
from robo_genesis.evidence import bundle, bundle_files, npz_archive, trace_files
from robo_genesis.evidence.fields import LINE_LIMIT
from robo_genesis.evidence.npz_archive import UNPACKED_LIMIT
from robo_genesis.evidence.picture_file import read_picture, write_picture
from robo_genesis.evidence.reader import from_bundle
from robo_genesis.lessons.l04 import LAB
from robo_genesis.lessons.l04 import spec as l04


def edit(folder, name, change):
    """Change the JSON of one file in place."""
    path = folder / name
    value = json.loads(path.read_text("utf8"))
    change(value)
    path.write_text(json.dumps(value), "utf8")


def manifest(change):
    return lambda folder: edit(folder, "manifest.json", change)


def predicate(**values):
    return manifest(lambda m: m["predicate"].update(values))


def part(name, **values):
    """Change one record of the predicate."""
    return manifest(lambda m: m["predicate"][name].update(values))


def modules(**digests):
    """Change or add digests of modules."""
    return manifest(lambda m: m["predicate"]["source"]["modules"].update(digests))


def seal(folder):
    """List every file with its digest and make the key right, as a careful forger would."""
    found = sorted(p for p in folder.rglob("*") if p.is_file() and p.name != "manifest.json")
    subject = [
        {"name": p.relative_to(folder).as_posix(), "digest": {"sha256": bundle.sha256(p)}}
        for p in found
    ]

    def change(m):
        m["subject"] = subject
        m["predicate"]["evidence_key"] = bundle.evidence_key(m["predicate"])

    edit(folder, "manifest.json", change)


def both(*spoilers):
    def change(folder):
        for spoil in spoilers:
            folder = moved(spoil(folder), folder)
        return folder

    return change


def moved(returned, folder):
    """Return where a bundle stands after a spoiler, of which few move it."""
    return returned if isinstance(returned, Path) else folder


def text(name, old, new):
    """Replace text in a file, every occurrence."""

    def change(folder):
        path = folder / name
        before = path.read_bytes()
        assert old.encode() in before
        path.write_bytes(before.replace(old.encode(), new.encode()))

    return change


def long_log(line):
    """Add one long line, which a pattern that backtracks would search for seconds."""

    def change(folder):
        with (folder / "log.txt").open("a", encoding="utf8") as stream:
            stream.write("INFO " + line * (LINE_LIMIT // len(line) + 1))

    return change


def nested(levels):
    """Return lists in lists."""
    value = []
    for _ in range(levels - 1):
        value = [value]
    return value


def many_lines(folder):
    """Add a warning of two million lines."""
    with (folder / "log.txt").open("a", encoding="utf8") as stream:
        stream.write("WARNING \n" + "\n" * 2_000_000)


def log(old, new):
    return text("log.txt", old, new)


# --- accelerators ---------------------------------------------------------------------------

TORCH = {
    "amdgpu": {"torch_version": "2.13.0+rocm7.1", "hip_version": "7.1.25424", "cuda_version": None},
    "cuda": {"torch_version": "2.13.0+cu130", "hip_version": None, "cuda_version": "13.0"},
}


def on(actual):
    """Turn the CPU's bundle into one that an accelerator would have left, sealed."""
    torch = {"torch_device": "cuda", **TORCH[actual]}

    def change(folder):
        part("backend", actual=actual, actual_at_end=actual, arch=actual, **torch)(folder)
        part("backend", requested="auto", driver="6.16", device_name="a GPU")(folder)
        part("render", vendor="AMD", renderer="AMD Radeon (radeonsi)", software=False)(folder)
        log("[a CPU] with backend gs.cpu", f"[a GPU] with backend gs.{actual}")(folder)
        log("INFO Software rendering context detected. Shadows not supported.\n", "")(folder)
        there = folder.rename(folder.with_name(actual))
        seal(there)
        return there

    return change


def own_run_id(folder):
    """Give a bundle another run id, in its frames, too."""
    predicate(run_id="d" * 32)(folder)
    for path in (folder / "frames").glob("*.png"):
        _, frame = read_picture(path, CAMERA_RES)
        write_picture(path, frame, "d" * 32)


def last_bit(array):
    return np.nextafter(array, np.float32(np.inf))


def measured_elsewhere(folder):
    """Make a bundle that of another run, with an array of each case that differs a little."""
    own_run_id(folder)
    name = NAMES["internal_force"]
    for path in (folder / "arrays").glob("*.npz"):
        with np.load(path) as archive:
            kept = {**archive}
        np.savez_compressed(path, **(kept | {name: last_bit(kept[name])}))


# --- files ----------------------------------------------------------------------------------


def flip_byte(folder):
    data = bytearray((folder / "metrics.json").read_bytes())
    data[data.index(b"0.")] ^= 1
    (folder / "metrics.json").write_bytes(data)


def add_subject(name):
    entry = {"name": name, "digest": {"sha256": "0" * 64}}
    return manifest(lambda m: m["subject"].append(entry))


def repeat_subject(change):
    def repeat(m):
        entry = dict(m["subject"][0])
        m["subject"].append(entry | {"name": change(entry["name"])})

    return manifest(repeat)


def link_out(folder):
    outside = shutil.move(folder / "log.txt", folder.parent / "log.txt")
    (folder / "log.txt").symlink_to(outside)


def link_folder(folder):
    elsewhere = folder.rename(folder.with_name("elsewhere"))
    folder.symlink_to(elsewhere)


def pad(name):
    """Make a file too long for its kind."""

    def change(folder):
        limit = bundle_files.SIZE_LIMITS.get(name, bundle_files.OTHER_LIMIT)
        with (folder / name).open("ab") as stream:
            stream.truncate(limit + 1)

    return change


def crowd(folder):
    for number in range(bundle_files.ENTRIES_LIMIT):
        (folder / f"{number}.txt").touch()


# --- arrays ---------------------------------------------------------------------------------

G1 = "arrays/G1.npz"
NAMES = {field: name for field, (name, *_) in trace_files.FIELDS.items()}


def rewrite(**fields):
    """Write one case's archive anew, some fields changed by their functions."""

    def change(folder):
        path = folder / G1
        with np.load(path) as archive:
            kept = {**archive}
        kept |= {NAMES[field]: changed(kept[NAMES[field]]) for field, changed in fields.items()}
        np.savez_compressed(path, **kept)

    return change


def described(folder):
    """Describe the arrays of G1 as they are now."""
    with np.load(folder / G1) as archive:
        found = {name: (list(a.shape), str(a.dtype)) for name, a in archive.items()}

    def change(arrays):
        for name, variable in arrays["cases"]["G1"]["variables"].items():
            variable["shape"], variable["dtype"] = found[name]

    edit(folder, "arrays.json", change)


def measured_again(folder):
    """Make metrics.json what the arrays now give."""
    arrays = bundle.read_arrays(folder)
    found = {case: trace_files.read_trace(folder, arrays, case) for case in arrays.cases}
    records = Experiment(LAB, found, [], {"model": l04.EXPECTED_MODEL}, {}, True).records()
    (folder / "metrics.json").write_text(json.dumps(records), "utf8")


def checked_again(folder):
    """Make the recorded checks those of the arrays and joints, failures included."""
    run = from_bundle(folder, bundle.read_manifest(folder), bundle.read_metrics(folder))
    predicate(checks=[outcome.record() for outcome in run.outcomes()])(folder)


def arrays(change):
    return lambda folder: edit(folder, "arrays.json", change)


def joint(index, **values):
    """Change one record of the joint map."""
    return arrays(lambda a: a["joints"][index].update(values))


def joints(change):
    return arrays(lambda a: change(a["joints"]))


def as_revolute(folder):
    """Call the first finger revolute, in the joint map and in every unit."""
    joint(7, type="REVOLUTE", unit="rad")(folder)

    def change(arrays):
        of_type = [record["type"] for record in arrays["joints"]]
        for case in arrays["cases"].values():
            for name, variable in case["variables"].items():
                if isinstance(variable["unit"], list):
                    variable["unit"] = trace_files.dof_units(name, of_type)

    edit(folder, "arrays.json", change)


def changed_at(index, value):
    def change(array):
        array = np.array(array)
        array[index] = value
        return array

    return change


def short(array):
    return np.array(array[:61] if len(array) == 121 else array[:60] if len(array) == 120 else array)


def member(name, data):
    """Replace one member of the archive by other bytes."""

    def change(folder):
        path = folder / G1
        with zipfile.ZipFile(path) as archive:
            kept = {item: archive.read(item) for item in archive.namelist()}
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            for item, content in (kept | {name: data}).items():
                archive.writestr(item, content)

    return change


def pickled(folder):
    stream = io.BytesIO()
    np.save(stream, np.full((121, 9), None), allow_pickle=True)
    member("q_rad_or_m.npy", stream.getvalue())(folder)


def packed_as(change):
    """Write the archive of G1 anew, in the recorder's form, after a change of its members."""

    def spoil(folder):
        path = folder / G1
        names = [name for name, *_ in trace_files.FIELDS.values()]
        members = list(npz_archive._members(path.read_bytes(), names))
        path.write_bytes(npz_archive._archive(change(members)))

    return spoil


def first_file(change):
    """Change the npy file of the first array, and pack it with a right checksum."""

    def spoil(members):
        file = change(zlib.decompress(members[0].packed, wbits=-zlib.MAX_WBITS))
        return [deflated(members[0].name, file), *members[1:]]

    return packed_as(spoil)


def deflated(name, file):
    packing = zlib.compressobj(wbits=-zlib.MAX_WBITS)
    packed = packing.compress(file) + packing.flush()
    return npz_archive.Member(name, zlib.crc32(file), len(file), packed)


def first_packed(**changes):
    """Change fields of the first member; headers and directory agree with them."""

    def spoil(members):
        values = {name: new(getattr(members[0], name)) for name, new in changes.items()}
        return [replace(members[0], **values), *members[1:]]

    return packed_as(spoil)


def bytes_of(name, change):
    """Change the bytes of a file."""

    def spoil(folder):
        path = folder / name
        path.write_bytes(change(path.read_bytes()))

    return spoil


def comment(folder):
    with zipfile.ZipFile(folder / G1, "a") as archive:
        archive.comment = b"luck"


def hidden_member(folder):
    """Add a member, then take its entry out of the directory."""
    path = folder / G1
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr("hidden.npy", b"x")
        archive.filelist.pop()
        archive.NameToInfo.pop("hidden.npy")
        archive._didModify = True


def stored(folder):
    """Write the archive without packing its members."""
    with np.load(folder / G1) as archive:
        kept = {**archive}
    np.savez(folder / G1, **kept)


def header(shape):
    """Write an array that is nothing but its header."""
    text = b"{'descr': '<f4', 'fortran_order': False, 'shape': " + shape + b"\n"
    return member("q_rad_or_m.npy", b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text)


def member_twice(folder):
    with zipfile.ZipFile(folder / G1, "a") as archive:
        data = archive.read("t_s.npy")
        with warnings.catch_warnings(action="ignore"):
            archive.writestr("t_s.npy", data)


def cut_archive(folder):
    path = folder / G1
    path.write_bytes(path.read_bytes()[:-500])


def drop_case(folder):
    (folder / "arrays" / "G3.npz").unlink()
    edit(folder, "arrays.json", lambda a: a["cases"].pop("G3"))


def variable(**values):
    return arrays(lambda a: a["cases"]["G2"]["variables"]["q_rad_or_m"].update(values))


# --- metrics, checks, frames ----------------------------------------------------------------


def metrics(change):
    return lambda folder: edit(folder, "metrics.json", change)


def metric(**values):
    return metrics(lambda m: m["G2"]["overshoot"].update(values))


def check(index, **values):
    return manifest(lambda m: m["predicate"]["checks"][index].update(values))


def by_name(manifest, name):
    """Return the values that a check found."""
    checks = manifest["predicate"]["checks"]
    return next(check["found"] for check in checks if check["name"] == name)


def found(name, label, value):
    """Write one value that a check found."""
    return manifest(lambda m: by_name(m, name).update({label: value}))


def found_times(name, label, factor):
    """Multiply one value that a check found."""

    def change(m):
        of = by_name(m, name)
        of[label] *= factor

    return manifest(change)


all_passed = manifest(lambda m: [check.update(passed=True) for check in m["predicate"]["checks"]])


def frame(name="initial", size=None, run_id=None, copy_of=None):
    """Write a frame anew: of another size, stamp or content."""

    def change(folder):
        path = folder / "frames" / f"{name}.png"
        with Image.open(folder / "frames" / f"{copy_of or name}.png") as picture:
            copy, own = picture.copy(), picture.info.get("run_id")
        stamp = PngInfo()
        if run_id != "":
            stamp.add_text("run_id", run_id or own)
        (copy.resize(size) if size else copy).save(path, pnginfo=stamp)

    return change


INITIAL = "frames/initial.png"


def png_chunk(kind, content=b""):
    body = kind + content
    return struct.pack(">I", len(content)) + body + struct.pack(">I", zlib.crc32(body))


def chunk(kind, content=b"", before=b"IDAT"):
    """Add a chunk to a frame, before the first one of another kind."""

    def change(data):
        place = data.index(before) - 4
        return data[:place] + png_chunk(kind, content) + data[place:]

    return bytes_of(INITIAL, change)


def pixels(change):
    """Change the packed bytes of the pixels of a frame."""

    def spoil(data):
        place, packed = 8, b""
        while place < len(data):
            length = int.from_bytes(data[place : place + 4])
            if data[place + 4 : place + 8] == b"IDAT":
                packed += data[place + 8 : place + 8 + length]
            place += 12 + length
        begin = data.index(b"IDAT") - 4
        return data[:begin] + png_chunk(b"IDAT", change(packed)) + png_chunk(b"IEND")

    return bytes_of(INITIAL, spoil)


def animated(folder):
    """Make a frame an animation whose second picture is hidden from most readers."""
    with Image.open(folder / INITIAL) as picture:
        copy, own = picture.copy(), picture.info["run_id"]
    stamp = PngInfo()
    stamp.add_text("run_id", own)
    other = Image.new("RGB", copy.size, "red")
    copy.save(folder / INITIAL, pnginfo=stamp, save_all=True, append_images=[other])


def as_mode(mode, **options):
    """Write a frame with other pixels than 8 bits each of RGB."""

    def change(folder):
        with Image.open(folder / INITIAL) as picture:
            copy, own = picture.convert(mode), picture.info["run_id"]
        stamp = PngInfo()
        stamp.add_text("run_id", own)
        copy.save(folder / INITIAL, pnginfo=stamp, **options)

    return change


def off_law(array):
    return np.array(array * np.float32(0.9))


FAILING = {
    "two joints on one DOF": joint(1, dof_idx_local=0),
    "a target outside its limits": joint(3, upper=-1.9),
    "a joint without a limit": joint(0, lower=None),
}
"""Runs that fail a check of their own, as they would have been measured."""


def failing(how, *more):
    """Fail a check, and say so."""
    return both(FAILING[how], checked_again, *more)


TEXTS = [
    ("backend", name)
    for name in ("device_name", "driver", "torch_version", "hip_version", "cuda_version", "arch")
]
TEXTS += [("render", "renderer"), ("engine", "version"), ("host", "os")]
ODD = {
    "two lines": "<script>\nalert(1)</script>",
    "a control character": "\x1b[2Jx",
    "a separator of lines": "a\u2028b",
    "a reversed direction": "a\u202eb",
    "201 characters": "x" * 201,
}
"""Text that no page and no terminal may show."""

SPOILED = {
    # Form of the files, before anything is believed.
    "no manifest": ("missing-file",) * 2 + (lambda f: (f / "manifest.json").unlink(),),
    "a link instead of a file": ("path", "path", link_out),
    "a link instead of the folder": ("path", "path", link_folder),
    "a pipe among the files": ("path", "path", lambda f: os.mkfifo(f / "pipe")),
    "a manifest that is too long": ("too-big", None, pad("manifest.json")),
    "a log that is too long": ("too-big", "too-big", pad("log.txt")),
    "an archive that is too long": ("too-big", "too-big", pad(G1)),
    "too many files": ("too-big", "too-big", crowd),
    "a key twice": ("bad-json", None, text("manifest.json", '"seed"', '"seed": 0, "seed"')),
    "a key twice in the metrics": (
        "digest", "bad-json", text("metrics.json", '"model"', '"model": {}, "model"')),
    "a byte order mark": ("bad-json", None, lambda f: (f / "manifest.json").write_bytes(
        b"\xef\xbb\xbf" + (f / "manifest.json").read_bytes())),
    "NaN in the manifest": ("bad-json", None, predicate(seed=float("nan"))),
    "infinity in the parameters": ("bad-json", None, text(
        "manifest.json", '"settling_band_rad": 0.01', '"settling_band_rad": 1e999')),
    "half a character": ("bad-json", None, predicate(command="\ud800")),
    "a number beyond JSON": ("bad-json", None, predicate(seed=2**60)),
    "a manifest too deep": ("bad-json", None, lambda f: (f / "manifest.json").write_text(
        "[" * 200_000)),
    "NaN in the metrics": ("digest", "bad-json", metric(value=float("nan"))),
    "an unknown field": ("bad-schema", "bad-schema", predicate(mood="good")),
    "a missing field": ("bad-schema", "bad-schema", manifest(
        lambda m: m["predicate"].pop("warnings"))),
    "a number as text": ("bad-schema", "bad-schema", predicate(seed="0")),
    "an unknown backend": ("bad-schema", "bad-schema", part("backend", actual="tpu")),
    "metrics as a list": ("digest", "bad-schema", lambda f: (f / "metrics.json").write_text("[]")),
    "a newer schema": ("schema", "schema", predicate(schema_version=3)),
    "an older schema": ("older-schema", "older-schema", predicate(schema_version=1)),
    "an older schema of other fields": ("older-schema", None, manifest(lambda m: m.update(
        predicateType="urn:robo-genesis:evidence:v1", predicate={"backend": "cpu"}))),
    "an older type of a newer schema": ("schema", "schema", manifest(lambda m: (
        m.update(predicateType="urn:robo-genesis:evidence:v1"),
        m["predicate"].update(schema_version=3)))),
    "a schema below all": ("schema", "schema", predicate(schema_version=-1)),
    "a type of no number": ("schema", "schema", manifest(
        lambda m: m.update(predicateType="urn:robo-genesis:evidence:v0x"))),
    "a schema that is true": ("bad-schema", "bad-schema", predicate(schema_version=True)),
    "a newer schema of other fields": ("schema", None, manifest(
        lambda m: m.update(predicateType="urn:robo-genesis:evidence:v3", more=1))),
    **{f"{name} of {what}": ("bad-schema", "bad-schema", part(record, **{name: value}))
       for record, name in TEXTS for what, value in ODD.items()},
    **{f"a command of {what}": ("bad-schema", "bad-schema", predicate(
        command=value * 10)) for what, value in ODD.items()},
    **{f"a warning of {what}": ("bad-schema", "bad-schema", predicate(
        warnings=[value * 100])) for what, value in ODD.items() if "lines" not in what},
    **{f"a switch of {what}": ("bad-schema", "bad-schema", predicate(
        environment={"GS_LOG": value * 10})) for what, value in ODD.items()},
    "a package of two lines": ("bad-schema", "bad-schema", part("host", packages={"a\nb": "1"})),
    "a link of two lines": ("digest", "bad-schema", arrays(
        lambda a: a["coords"].update(link=["a\nb", "c", "d"]))),
    "a note with a control character": ("digest", "bad-schema", arrays(
        lambda a: a["cases"]["G1"].update(note="\x1b[2J"))),
    "a long unit": ("digest", "bad-schema", metric(unit="m" * 201)),
    "a metric of 401 digits": ("digest", "bad-json", metric(value=10**400)),
    "a negative metric of 401 digits": ("digest", "bad-json", metric(value=-(10**400))),
    "a count of 401 digits": ("digest", "bad-json", metrics(
        lambda m: m["model"]["links"].update(value=10**400))),
    "a metric of 10,000 digits": ("digest", "bad-json", text(
        "metrics.json", '"value": 0', '"value": 1' + "0" * 10_000)),
    "a metric of 1e300": ("digest", "bad-json", metric(value=1e300)),
    "a limit of 1e300": ("digest", "bad-json", joint(0, upper=1e300)),
    "parameters of 40 levels": ("bad-json", None, part("parameters", deep=nested(40))),
    "arrays of 900 levels": ("digest", "bad-json", arrays(lambda a: a.update(deep=nested(900)))),
    "metrics too deep": ("digest", "bad-json", lambda f: (f / "metrics.json").write_text(
        "[" * 200_000)),
    "a seed of 401 digits": ("bad-json", None, predicate(seed=10**400)),
    "a parameter of 401 digits": ("bad-json", None, part("parameters", rise_fraction=10**400)),
    "cores of 401 digits": ("bad-json", None, part("host", cores=10**400)),
    "a limit of 401 digits": ("digest", "bad-json", joint(0, lower=-(10**400))),
    "a shape of 401 digits": ("digest", "bad-json", variable(shape=[10**400, 9])),
    "a DOF of 401 digits": ("digest", "bad-json", joint(0, dof_idx_local=10**400)),
    # Identity.
    "another lesson": ("lesson", "lesson", predicate(lesson="l99")),
    "a page that the book lacks": ("key", "lesson", predicate(page="exam")),
    "ended before it began": ("time", "time", predicate(ended="2020-01-01T00:00:00Z")),
    "a day that no month has": ("time", "time", predicate(started="2026-13-45T00:00:00Z")),
    "another key": ("key", None, predicate(evidence_key="0" * 64)),
    # The list of files.
    "a listed path above": ("path", None, add_subject("../cpu/log.txt")),
    "a listed absolute path": ("path", None, add_subject("/etc/hostname")),
    "a listed path with a backslash": ("path", None, add_subject("..\\log.txt")),
    "a file listed twice": ("path", None, repeat_subject(str)),
    "names that differ in case": ("path", None, repeat_subject(str.upper)),
    "a missing file": ("files", "cases", lambda f: (f / G1).unlink()),
    "no log": ("files", "files", lambda f: (f / "log.txt").unlink()),
    "an extra file": ("files", "files", lambda f: (f / "extra.txt").write_text("x")),
    "an extra picture": ("files", "frames", lambda f: (f / "frames" / "third.png").write_bytes(
        (f / "frames" / "final.png").read_bytes())),
    "a flipped byte": ("digest", "metrics", flip_byte),
    # Backend, Torch, renderer, log.
    "the CPU's run filed as amdgpu": ("backend", "backend", both(
        part("backend", requested="auto"), lambda f: f.rename(f.with_name("amdgpu")))),
    "a backend claimed in the folder alone": ("backend", "backend", lambda f: f.rename(
        f.with_name("cuda"))),
    "another backend at the end": ("backend", "backend", part("backend", actual_at_end="cuda")),
    "cpu requested, amdgpu claimed": ("backend", "backend", both(
        on("amdgpu"), part("backend", requested="cpu"))),
    "cuda filed as amdgpu": ("backend", "backend", both(
        on("cuda"), lambda f: f.rename(f.with_name("amdgpu")))),
    "amdgpu without HIP": ("torch", "torch", both(on("amdgpu"), part("backend", hip_version=None))),
    "amdgpu with an empty HIP": ("torch", "torch", both(on("amdgpu"), part(
        "backend", hip_version=""))),
    "cuda with HIP": ("torch", "torch", both(on("cuda"), part("backend", hip_version="7.1"))),
    "cuda without CUDA": ("torch", "torch", both(on("cuda"), part("backend", cuda_version=None))),
    "Torch forced to the CPU": ("torch", "torch", both(on("amdgpu"), part(
        "backend", torch_device="cpu"))),
    "an architecture that spells the valid ones": ("torch", "torch", part(
        "backend", arch="x64 or arm64")),
    "Torch forced to the CPU by a switch": ("torch", "torch", predicate(
        environment={"GS_TORCH_FORCE_CPU_DEVICE": "1"})),
    "an architecture forced by a switch": ("torch", "torch", both(on("amdgpu"), predicate(
        environment={"HIP_VISIBLE_DEVICES": "0", "QD_ARCH": "amdgpu"}))),
    "a variable that is no switch": ("environment", "environment", predicate(
        environment={"LOGNAME": "somebody"})),
    "a folder of caches": ("environment", "environment", predicate(
        environment={"QD_OFFLINE_CACHE_FILE_PATH": "kernels"})),
    "somebody's home": ("environment", "environment", predicate(
        environment={"LIBGL_DRIVERS_PATH": "/usr/lib:/home/somebody/mesa"})),
    "another architecture": ("torch", "torch", both(on("amdgpu"), part("backend", arch="x64"))),
    "software drawing claimed as a GPU's": ("render", "render", part("render", software=False)),
    "software drawing on an accelerator, hidden": ("render", "render", both(on("amdgpu"), part(
        "render", renderer="llvmpipe (LLVM 19)", software=False))),
    "a camera without a renderer": ("render", "render", part("render", renderer=None)),
    "a renderer without a camera": ("render", "render", part("render", mode="skip")),
    "a log of another backend": ("digest", "log", log("gs.cpu", "gs.cuda")),
    "a CPU's log under amdgpu": ("digest", "log", both(on("amdgpu"), log("gs.amdgpu", "gs.cpu"))),
    "a log of another device": ("digest", "log", log("[a CPU]", "[a GPU]")),
    "a log of another engine": ("digest", "log", log("version: ", "version: 0.")),
    "a log of another seed": ("digest", "log", log("seed: 0", "seed: 1")),
    "a warning left out": ("log", "log", predicate(warnings=[])),
    "a warning taken from the log": ("digest", "log", log("WARNING", "INFO")),
    "a log of software drawing": ("digest", "log", both(on("cuda"), lambda f: (
        f / "log.txt").write_text((f / "log.txt").read_text("utf8")
                                  + "INFO Software rendering context detected.\n", "utf8"))),
    "an empty log": ("digest", "log", both(
        predicate(warnings=[]), bytes_of("log.txt", lambda b: b""))),
    "a log without a backend": ("digest", "log", log("Running on", "Running at")),
    "a log without a start": ("digest", "log", log("initialized.", "ready.")),
    "a log without a seed": ("digest", "log", log("seed: 0", "seeds: none")),
    "a log without a precision": ("digest", "log", log("precision: ", "digits: ")),
    "a log with the device of another": ("digest", "log", bytes_of("log.txt", lambda b: b
        + b"INFO Running on [a GPU] with backend gs.amdgpu. Device memory: 1 GB.\n")),
    "a log of one long line": ("digest", "log", long_log("x")),
    "a long line of one word of the log": ("digest", "log", long_log("initialized. version: ")),
    "a warning of many lines": ("digest", "log", many_lines),
    "a log that is no text": ("digest", "log", lambda f: (f / "log.txt").write_bytes(b"\xff")),
    "a patched engine": ("engine-files", "engine-files", part("engine", files_match_wheel=False)),
    # The question.
    "an older engine": ("key", "stale", both(part("engine", version="1.2.0"), log(
        "version: ", "version: 1.2.0, was: "))),
    "another Quadrants": ("key", "stale", part("engine", quadrants_version="1.2.9")),
    "another precision": ("key", "stale", both(part("engine", precision="64"), log(
        "precision: 32", "precision: 64"))),
    "another seed": ("key", "stale", both(predicate(seed=1), log("seed: 0", "seed: 1"))),
    "other parameters": ("key", "stale", manifest(
        lambda m: m["predicate"]["parameters"]["cases"]["G1"]["kp"].reverse())),
    "another module": ("key", "stale", modules(metrics="0" * 64)),
    "a module more": ("key", "stale", modules(luck="0" * 64)),
    "another lab page": ("key", "stale", part("source", page="0" * 64)),
    "no page digest": ("key", "stale", part("source", page=None)),
    "true for one": ("key", "stale", manifest(lambda m: m["predicate"]["parameters"].update(
        rise_fraction=str(m["predicate"]["parameters"]["rise_fraction"])))),
    # Arrays.
    "a dropped case": ("files", "cases", drop_case),
    "a case without its archive": ("digest", "cases", arrays(lambda a: a["cases"].pop("G3"))),
    "arrays outside the bundle": ("digest", "path", arrays(
        lambda a: a["cases"]["G1"].update(file="../elsewhere/G1.npz"))),
    "a wrong unit": ("digest", "labels", variable(unit=["deg"] * 9)),
    "other dimensions": ("digest", "labels", variable(dims=["dof", "state"])),
    "another long name": ("digest", "labels", variable(long_name="velocity")),
    "another type described": ("digest", "labels", variable(dtype="float64")),
    "one dimension too few": ("digest", "labels", variable(shape=[121])),
    "another number of joints": ("digest", "labels", variable(shape=[121, 8])),
    "DOF names left out": ("digest", "labels", arrays(lambda a: a["coords"].pop("dof"))),
    "DOF names in another order": ("digest", "labels", arrays(
        lambda a: a["coords"]["dof"].reverse())),
    "one link twice": ("digest", "labels", arrays(lambda a: a["coords"].update(link=["hand"] * 3))),
    "no joints": ("digest", "bad-schema", arrays(lambda a: a.pop("joints"))),
    "a joint without its limits": ("digest", "bad-schema", joints(lambda j: j[0].pop("lower"))),
    "a joint before the first DOF": ("digest", "bad-schema", joint(0, dof_idx_local=-1)),
    "a limit that is no number": ("digest", "bad-json", joint(0, lower=float("nan"))),
    "a joint too few": ("digest", "labels", joints(lambda j: j.pop())),
    "a joint too many": ("digest", "labels", joints(lambda j: j.append(j[0]))),
    "joints in another order": ("digest", "labels", joints(lambda j: j.reverse())),
    "another name of a joint": ("digest", "labels", joint(6, name="joint8")),
    "a joint of no known type": ("digest", "labels", joint(0, type="SPHERICAL")),
    "a joint of another unit": ("digest", "labels", joint(0, unit="m")),
    "a finger called revolute": ("digest", "labels", joint(7, type="REVOLUTE", unit="rad")),
    "a finger called revolute throughout": ("digest", "checks", as_revolute),
    "a DOF that the model lacks": ("digest", "checks", joint(8, dof_idx_local=9)),
    "a qpos that the model lacks": ("digest", "checks", joint(8, q_idx_local=9)),
    "an undescribed array": ("digest", "labels", arrays(
        lambda a: a["cases"]["G1"]["variables"].pop("t_s"))),
    "another shape described": ("digest", "bad-array", variable(shape=[120, 9])),
    "a cut archive": ("digest", "bad-array", cut_archive),
    "pickled objects": ("digest", "bad-array", pickled),
    "a header of four TiB": ("digest", "bad-array", header(b"(1099511627776,), }")),
    "a header of negative size": ("digest", "bad-array", header(b"(-1, -1), }")),
    "a header without an end": ("digest", "bad-array", header(b"(1,")),
    "a member twice": ("digest", "bad-array", member_twice),
    "a member more": ("digest", "bad-array", member("luck.npy", b"")),
    "arrays of another type": ("digest", "bad-array", rewrite(q=np.float64)),
    "arrays in Fortran's order": ("digest", "bad-array", rewrite(q=np.asfortranarray)),
    "a zip bomb": ("digest", "too-big", first_packed(size=lambda _: UNPACKED_LIMIT + 1)),
    "a file longer than it says": ("digest", "bad-array", first_packed(size=lambda n: n - 1)),
    "a file shorter than it says": ("digest", "bad-array", first_packed(size=lambda n: n + 1)),
    "another checksum": ("digest", "bad-array", first_packed(checksum=lambda c: c ^ 1)),
    "bytes after a packed array": ("digest", "bad-array", first_packed(packed=lambda p: p + b"x")),
    "bytes in an array's header": ("digest", "bad-array", first_file(
        lambda f: f.replace(b"      ", b" 'a':1", 1))),
    "bytes after an array": ("digest", "bad-array", first_file(lambda f: f + b"x")),
    "another version of an array's format": ("digest", "bad-array", first_file(
        lambda f: f[:6] + b"\2\0" + f[8:10] + b"\0\0" + f[10:])),
    "an archive in other order": ("digest", "bad-array", packed_as(lambda m: m[::-1])),
    "an archive after other bytes": ("digest", "bad-array", bytes_of(G1, lambda b: b"x" + b)),
    "an archive before other bytes": ("digest", "bad-array", bytes_of(G1, lambda b: b + b"x")),
    "an archive before its directory": ("digest", "bad-array", bytes_of(
        G1, lambda b: b.replace(b"PK\1\2", b"luckPK\1\2", 1))),
    "an archive with a comment": ("digest", "bad-array", comment),
    "an archive with a hidden member": ("digest", "bad-array", hidden_member),
    "an archive with another date": ("digest", "bad-array", bytes_of(
        G1, lambda b: b.replace(b"\x21\0", b"\x22\0", 1))),
    "an archive that is not packed": ("digest", "bad-array", stored),
    "an archive of a byte": ("digest", "bad-array", bytes_of(G1, lambda b: b"P")),
    "arrays that are not finite": ("digest", "bad-trace", rewrite(q=changed_at((-1, 0), np.nan))),
    "a shifted time axis": ("digest", "bad-trace", rewrite(t=lambda t: t + 0.01)),
    "a target that wanders": ("digest", "start", rewrite(target=changed_at((5, 3), 0.0))),
    "stamps of another dt": ("digest", "stamps", rewrite(t=lambda t: t * 2)),
    "a short run": ("digest", "stamps", both(
        rewrite(**dict.fromkeys(NAMES, short)), described, measured_again)),
    "a joint that stands still": ("digest", "law", rewrite(
        q=changed_at((slice(None), 3), -2.0))),
    "a velocity that stands still": ("digest", "law", rewrite(
        qd=changed_at((slice(None), 3), 0.0))),
    "no control force": ("digest", "law", rewrite(control_force=np.zeros_like)),
    "no internal force": ("digest", "motion", rewrite(internal_force=np.zeros_like)),
    "off its control law": ("digest", "law", both(
        rewrite(control_force=off_law), measured_again)),
    "quaternions of zero": ("digest", "pose", rewrite(link_quat=np.zeros_like)),
    "a link that is moved": ("digest", "pose", rewrite(link_pos=changed_at((60, 2, 1), 0.3))),
    "a link that the model lacks": ("digest", "pose", arrays(
        lambda a: a["coords"].update(link=["link0", "link4", "head"]))),
    "an effort limit of another case": ("digest", "law", rewrite(effort_limit=off_law)),
    "a start with velocity": ("digest", "start", rewrite(start_qd=changed_at(3, 0.1))),
    "a start elsewhere": ("digest", "start", rewrite(q=changed_at((0, 3), -1.9))),
    # Frames.
    "a camera without frames": ("files", "frames", lambda f: shutil.rmtree(f / "frames")),
    "a frame without a stamp": ("digest", "frames", frame(run_id="")),
    "a frame of another run": ("digest", "frames", frame(run_id="f" * 32)),
    "a frame of another size": ("digest", "frames", frame(size=(8, 8))),
    "a frame that is no picture": ("digest", "frames", lambda f: (
        f / "frames" / "final.png").write_text("x")),
    "an animated frame": ("digest", "frames", animated),
    "a frame before other bytes": ("digest", "frames", bytes_of(INITIAL, lambda b: b + b"x")),
    "a frame before another frame": ("digest", "frames", bytes_of(INITIAL, lambda b: b + b)),
    "a frame with another text": ("digest", "frames", chunk(b"tEXt", b"luck\0x")),
    "a frame with a comment at its end": ("digest", "frames", chunk(
        b"tEXt", b"Comment\0x", before=b"IEND")),
    "a frame with a packed text": ("digest", "frames", chunk(b"zTXt", b"run_id\0\0x")),
    "a frame with a private chunk": ("digest", "frames", chunk(b"luCK", b"x")),
    "a frame with an empty chunk": ("digest", "frames", chunk(b"IDAT")),
    "a frame with another end": ("digest", "frames", bytes_of(
        INITIAL, lambda b: b[:-12] + png_chunk(b"IEND", b"x"))),
    "a frame with another checksum": ("digest", "frames", bytes_of(
        INITIAL, lambda b: b[:-1] + b"x")),
    "a frame with bytes after its pixels": ("digest", "frames", pixels(lambda p: p + b"x")),
    "a frame with pixels too many": ("digest", "frames", pixels(
        lambda p: zlib.compress(zlib.decompress(p) + b"x"))),
    "a frame with pixels too few": ("digest", "frames", pixels(
        lambda p: zlib.compress(zlib.decompress(p)[:-1]))),
    "a frame of bombs": ("digest", "frames", pixels(lambda p: zlib.compress(bytes(2**27)))),
    "a frame of pixels that cannot be unpacked": ("digest", "frames", pixels(lambda p: b"x")),
    "a frame with a palette": ("digest", "frames", as_mode("P")),
    "a frame that may be transparent": ("digest", "frames", as_mode("RGBA")),
    "a frame without colours": ("digest", "frames", as_mode("L")),
    "frames without a camera": ("frames", "frames", part(
        "render", mode="skip", vendor=None, renderer=None, software=None)),
    # Metrics and checks.
    "an edited metric": ("digest", "metrics", metric(value=0.0)),
    "a metric of another unit": ("digest", "metrics", metric(unit="degree")),
    "a metric of another class": ("digest", "metrics", metric(**{"class": "performance"})),
    "a metric of another source": ("digest", "metrics", metric(**{"from": ["luck"]})),
    "a metric that is missing": ("digest", "metrics", metrics(lambda m: m["G1"].pop("rise_time"))),
    "a metric too many": ("digest", "metrics", metrics(
        lambda m: m["G1"].update(grace=m["G1"]["overshoot"]))),
    "a group that is missing": ("digest", "metrics", metrics(lambda m: m.pop("G1"))),
    "a group too many": ("digest", "metrics", metrics(lambda m: m.update(G4={}))),
    "an edited count": ("digest", "checks", metrics(
        lambda m: m["model"]["links"].update(value=12))),
    "a count that is none": ("digest", "metrics", metrics(
        lambda m: m["model"]["links"].update(value=11.0))),
    "a count that is missing": ("digest", "metrics", metrics(lambda m: m["model"].pop("links"))),
    "no counts": ("digest", "metrics", metrics(lambda m: m.pop("model"))),
    "a count of another source": ("digest", "metrics", metrics(
        lambda m: m["model"]["links"].update({"from": ["luck"]}))),
    "edited arrays": ("digest", "law", rewrite(qd=off_law)),
    "one and the same picture twice": ("digest", "checks", frame("final", copy_of="initial")),
    "another value found by a check": ("checks", "checks", found(
        "control_law", "G2.distance_to_control_law", 0.001)),
    "a value found off by a millionth": ("checks", "checks", found_times(
        "saturation", "G2.saturation_duration_s", 1 + 1e-6)),
    "a found value of another type": ("checks", "checks", found("mapping", "links", 11.0)),
    "a found truth as a number": ("checks", "checks", found("posture", "final.usable", 1)),
    "a found value too many": ("checks", "checks", found("mapping", "luck", 1)),
    "a found value that is missing": ("checks", "checks", manifest(
        lambda m: by_name(m, "mapping").pop("links"))),
    "found values beyond a float": ("bad-json", "bad-json", found("mapping", "links", 10**400)),
    "a found number beyond all metrics": ("bad-json", "bad-json", found(
        "mapping", "links", 1e300)),
    "found text of two lines": ("bad-schema", "bad-schema", found("mapping", "links", "a\nb")),
    "a found list": ("bad-schema", "bad-schema", found("mapping", "links", [11])),
    "words of a check": ("bad-schema", "bad-schema", check(0, detail="luck")),
    "a check left out": ("checks", "checks", manifest(lambda m: m["predicate"]["checks"].pop())),
    "no check": ("checks", "checks", predicate(checks=[])),
    **{f"{how}, kept quiet": ("digest", "checks", FAILING[how]) for how in FAILING},
    **{f"{how}, and it says so": ("digest", "failed", failing(how)) for how in FAILING},
    **{f"{how}, called passed": ("digest", "failed", failing(how, all_passed))
       for how in FAILING},
    "a failure of other values": ("digest", "checks", failing(
        "two joints on one DOF", found("mapping", "local_dofs", "luck"))),
}  # fmt: skip
