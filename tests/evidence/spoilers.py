"""Bundles spoiled in one way each, with the code that refuses them.

`SPOILED` is name → (code as it is, code after digests and key were made right again,
spoiler). A spoiler changes the bundle in a folder; it returns the folder where it moved
it."""

import json
import os
import shutil
import zipfile
import zlib
from functools import partial, reduce
from operator import getitem
from pathlib import Path

import numpy as np

from robo_genesis.core.scene import CAMERA_RES
from robo_genesis.core.trace import Trace
from robo_genesis.evidence import bundle, bundle_files, picture_file
from robo_genesis.evidence.fields import LINE_LIMIT
from robo_genesis.evidence.npz_archive import UNPACKED_LIMIT, write_archive
from robo_genesis.evidence.picture_file import read_picture, write_picture
from robo_genesis.evidence.reader import from_bundle
from robo_genesis.lessons.l04.pages import LAB

MANIFEST, ARRAYS, METRICS = "manifest.json", "arrays.json", "metrics.json"
G1, LOG, INITIAL = "arrays/G1.npz", "log.txt", "frames/initial.png"
FIELDS = {field: name for field, (name, *_) in Trace.arrays().items()}
CHECKS = [check.__name__ for check in LAB.checks]
MAPPING = ("predicate", "checks", CHECKS.index("mapping"))


# --- JSON
# -----------------------------------------------------------------------------------


def edit(folder, name, change):
    """Change the JSON of one file in place, also to values that the recorder does not write."""
    path = folder / name
    value = json.loads(path.read_text("utf8"))
    change(value)
    text = json.dumps(value, indent=1, ensure_ascii=False)
    path.write_text(f"{text}\n", "utf8", "surrogatepass")


def editing(name):
    return lambda change: lambda folder: edit(folder, name, change)


manifest, arrays, metrics = map(editing, (MANIFEST, ARRAYS, METRICS))


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


predicate = part = partial(put, MANIFEST, "predicate")
modules = partial(predicate, "source", "modules")
check = partial(predicate, "checks")
packages = partial(predicate, "host", "packages")
joint = partial(put, ARRAYS, "joints")
case = partial(put, ARRAYS, "cases")
coords = partial(put, ARRAYS, "coords")
metric = partial(put, METRICS, "G2", "overshoot")


def found(name, **values):
    """Write values that a check found."""
    return check(CHECKS.index(name), "found", **values)


# --- files
# ----------------------------------------------------------------------------------


def bytes_of(name, change):
    """Change the bytes of a file."""

    return lambda folder: (folder / name).write_bytes(
        change((folder / name).read_bytes())
    )


def text(name, old, new):
    """Replace text in a file, every occurrence."""

    def change(content):
        assert old.encode() in content
        return content.replace(old.encode(), new.encode())

    return bytes_of(name, change)


def after(name, more):
    """Append bytes to a file."""
    return bytes_of(name, lambda content: content + more)


log = partial(text, LOG)


def remove(name):
    return lambda folder: (folder / name).unlink()


def write(name, content):
    return lambda folder: (folder / name).write_text(content, "utf8")


def copied_to(name):
    """Copy the first frame to another name."""
    return lambda folder: (folder / name).write_bytes((folder / INITIAL).read_bytes())


def both(*spoilers):
    def change(folder):
        for spoil in spoilers:
            folder = moved(spoil(folder), folder)
        return folder

    return change


def moved(returned, folder):
    """Return where a bundle stands after a spoiler, of which few move it."""
    return returned if isinstance(returned, Path) else folder


def filed_as(name):
    return lambda folder: folder.rename(folder.with_name(name))


def seal(folder):
    """List every file with its digest and make the key right, as a careful forger would."""

    def change(m):
        m["subject"] = bundle_files.list_files(folder)
        m["predicate"]["evidence_key"] = bundle.evidence_key(m["predicate"])

    edit(folder, MANIFEST, change)


def listed(name):
    """List another file, with a digest."""
    return manifest(lambda m: m["subject"].append(m["subject"][0] | {"name": name}))


def link_out(folder):
    outside = shutil.move(folder / LOG, folder.parent / LOG)
    (folder / LOG).symlink_to(outside)


def link_folder(folder):
    folder.symlink_to(folder.rename(folder.with_name("elsewhere")))


def pad(name):
    """Make a file too long for its kind."""
    limit = bundle_files.SIZE_LIMITS.get(name, bundle_files.OTHER_LIMIT)
    return lambda folder: os.truncate(folder / name, limit + 1)


def crowd(folder):
    for number in range(bundle_files.ENTRIES_LIMIT):
        (folder / f"{number}.txt").touch()


# --- accelerators
# ---------------------------------------------------------------------------

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
SOFTWARE = "INFO Software rendering context detected. Shadows not supported.\n"


def on(actual, **changed):
    """Turn the CPU's bundle into one that an accelerator would have left, sealed, then changed."""
    torch = {"torch_device": "cuda", **TORCH[actual]}
    return both(
        part("backend", actual=actual, actual_at_end=actual, arch=actual, **torch),
        part("backend", requested="auto", driver="6.16", device_name="a GPU"),
        packages(torch=torch["torch_version"]),
        part("render", vendor="AMD", renderer="AMD Radeon (radeonsi)", software=False),
        log("[a CPU] with backend gs.cpu", f"[a GPU] with backend gs.{actual}"),
        log(SOFTWARE, ""),
        filed_as(actual),
        seal,
        part("backend", **changed),
    )


def own_run_id(folder):
    """Give a bundle another run id, in its frames, too."""
    predicate(run_id="d" * 32)(folder)
    for path in (folder / "frames").glob("*.png"):
        write_picture(path, read_picture(path, CAMERA_RES)[1], "d" * 32)


def measured_elsewhere(folder):
    """Make a bundle that of another run, with an array of each case that differs a little."""
    own_run_id(folder)
    for path in (folder / "arrays").glob("*.npz"):
        rewrite(path.stem, internal_force=last_bit)(folder)


def last_bit(array):
    return np.nextafter(array, np.float32(np.inf))


# --- arrays, frames, checks
# -----------------------------------------------------------------


def in_archive(case, change):
    """Change the arrays of one case in place, by their names."""

    def spoil(folder):
        path = folder / "arrays" / f"{case}.npz"
        with np.load(path) as stored:
            values = {name: np.array(stored[name]) for name in stored}
        change(values)
        write_archive(path, values)

    return spoil


def rewrite(case="G1", **fields):
    """Change some fields of one case by their functions."""
    named = {FIELDS[field]: change for field, change in fields.items()}
    return in_archive(
        case, lambda of: of.update({n: new(of[n]) for n, new in named.items()})
    )


def changed_at(index, value):
    def change(array):
        array = np.array(array)
        array[index] = value
        return array

    return change


def off_law(array):
    return np.array(array * np.float32(0.9))


def members(change, packing=zipfile.ZIP_STORED):
    """Write the archive of G1 anew after a change of its members, in the recorder's way."""

    def spoil(folder):
        with zipfile.ZipFile(folder / G1) as archive:
            kept = [(name, archive.read(name)) for name in archive.namelist()]
        with zipfile.ZipFile(folder / G1, "w", packing) as archive:
            for name, content in change(kept):
                archive.writestr(zipfile.ZipInfo(name), content, packing)

    return spoil


def first_array(content, packing=zipfile.ZIP_STORED):
    """Write other bytes in the place of the first array."""
    return members(lambda kept: [(kept[0][0], content), *kept[1:]], packing)


def npy(shape=b"(1,", fields=b"<f8"):
    """Return the bytes of an array that is nothing but a header."""
    said = (
        b"{'descr': '"
        + fields
        + b"', 'fortran_order': False, 'shape': "
        + shape
        + b"\n"
    )
    return b"\x93NUMPY\1\0" + len(said).to_bytes(2, "little") + said


def png(text=lambda content: content, packed=lambda content: content):
    """Write a frame in the recorder's form, with another text or other packed pixels."""

    def spoil(data):
        words = picture_file._content(data, place := picture_file.TEXT_PLACE)
        kept = picture_file._content(data, place + len(words) + 12)
        return picture_file._png(CAMERA_RES, text(words), packed(kept))

    return bytes_of(INITIAL, spoil)


def rows(change):
    return png(packed=lambda packed: zlib.compress(change(zlib.decompress(packed))))


def checked_again(folder):
    """Make the recorded checks those of the arrays and joints, failures included."""
    run = from_bundle(folder, bundle.read_manifest(folder), bundle.read_metrics(folder))
    predicate(checks=[outcome.record() for outcome in run.outcomes()])(folder)


link_too_many = put(METRICS, "model", "links", value=12)
failing = both(link_too_many, checked_again)
"""A run that fails a check of its own, as it would have been measured."""

older_compiler = both(
    part("engine", quadrants_version="1.2.9"), packages(quadrants="1.2.9")
)
drop_case = both(remove("arrays/G3.npz"), pop(ARRAYS, "cases", "G3"))
older_type = manifest(lambda m: m.update(predicateType="urn:robo-genesis:evidence:v1"))

# Text that no page and no terminal may show.
ODD = {
    "two lines": "<script>\nalert(1)</script>",
    "a control character": "\x1b[2Jx",
    "a separator of lines": "a\u2028b",
    "a reversed direction": "a\u202eb",
    "too many characters": "x" * 201,
}

# (Code as it is, code when sealed again, None if it cannot be) → the spoilers by name.
GROUPS = {
    # Form of the files, before anything is believed.
    ("missing-file", "missing-file"): {"no manifest": remove(MANIFEST)},
    ("path", "path"): {
        "a link instead of a file": link_out,
        "a link instead of the folder": link_folder,
        "a pipe among the files": lambda f: os.mkfifo(f / "pipe"),
    },
    ("too-big", None): {"a manifest that is too long": pad(MANIFEST)},
    ("too-big", "too-big"): {
        "an archive that is too long": pad(G1),
        "too many files": crowd,
    },
    ("bad-json", None): {
        "a key twice": text(MANIFEST, '"seed"', '"seed": 0, "seed"'),
        "NaN in the manifest": predicate(seed=float("nan")),
        "half a character": predicate(command="\ud800"),
        "a number beyond JSON": predicate(seed=2**60),
        "a manifest too deep": write(MANIFEST, "[" * 200_000),
        "parameters of 40 levels": predicate(
            "parameters", deep=reduce(lambda inner, _: [inner], range(40), 0)
        ),
    },
    ("digest", "bad-json"): {
        "a metric of 10,000 digits": text(
            METRICS, '"value": 0', '"value": 1' + "0" * 10_000
        ),
        "a limit that is no number": joint(0, lower=float("nan")),
    },
    ("bad-schema", "bad-schema"): {
        "an unknown field": predicate(mood="good"),
        "a number as text": predicate(seed="0"),
        "a machine without a core": part("host", cores=0),
        "the name of a branch": predicate(git={"commit": "main", "dirty": False}),
        "an unknown backend": part("backend", actual="tpu"),
        "found text of two lines": found("mapping", links="a\nb"),
        **{
            f"a driver of {what}": part("backend", driver=value)
            for what, value in ODD.items()
        },
        "a switch of two lines": predicate(environment={"GS_LOG": ODD["two lines"]}),
        **{
            f"a warning of {what}": predicate(warnings=[value * 100])
            for what, value in ODD.items()
            if "lines" not in what
        },
    },
    ("digest", "bad-schema"): {
        "metrics as a list": write(METRICS, "[]\n"),
        "a link of two lines": coords(link=["a\nb", "c", "d"]),
        "a joint before the first DOF": joint(0, dof_idx_local=-1),
    },
    ("schema", "schema"): {
        "a newer schema": predicate(schema_version=3),
        "an older type of a newer schema": both(
            older_type, predicate(schema_version=3)
        ),
        "a type of no number": manifest(
            lambda m: m.update(predicateType="urn:robo-genesis:evidence:v0x")
        ),
    },
    ("older-schema", "older-schema"): {"an older schema": predicate(schema_version=1)},
    ("older-schema", None): {
        "an older schema of other fields": both(
            manifest(lambda m: m.update(predicate={"backend": "cpu"})), older_type
        )
    },
    # Identity and the list of files.
    ("key", "lesson"): {
        "another lesson": predicate(lesson="l99"),
        "a page that the book lacks": predicate(page="exam"),
    },
    ("time", "time"): {
        "ended before it began": predicate(ended="2020-01-01T00:00:00Z"),
        "a day that no month has": predicate(started="2026-13-45T00:00:00Z"),
        "a run that is to come": predicate(ended="2099-01-01T00:00:00Z"),
    },
    ("key", None): {"another key": predicate(evidence_key="0" * 64)},
    ("files", None): {
        "a listed path above": listed("../cpu/log.txt"),
        "a listed absolute path": listed("/etc/hostname"),
        "names that differ in case": listed("ARRAYS.JSON"),
    },
    ("files", "cases"): {"a missing file": remove(G1), "a dropped case": drop_case},
    ("files", "files"): {
        "no log": remove(LOG),
        "an extra file": write("extra.txt", "x"),
    },
    ("files", "bad-schema"): {
        "outputs of no cell": write(bundle.PRINTED, "[\n {}\n]\n")
    },
    ("files", "frames"): {"an extra picture": copied_to("frames/third.png")},
    # Backend, Torch, renderer, log.
    ("backend", "backend"): {
        "the CPU's run filed as amdgpu": both(
            part("backend", requested="auto"), filed_as("amdgpu")
        ),
        "another backend at the end": part("backend", actual_at_end="cuda"),
        "cpu requested, amdgpu claimed": on("amdgpu", requested="cpu"),
        "an accelerator without a driver": on("cuda", driver=None),
        "a CPU with a driver": part("backend", driver="6.16"),
        "another processor than the device": part("host", cpu="another CPU"),
        "the processor as accelerator": on("amdgpu", device_name="a CPU"),
        "a processor as accelerator": on(
            "cuda", device_name="13th Gen Intel(R) Core(TM) i7"
        ),
        "a card of the other maker": on("cuda", device_name="AMD Instinct MI300X"),
    },
    ("packages", "packages"): {
        "another engine installed": packages(**{"genesis-world": "1.3.2"}),
        "no compiler installed": pop(
            MANIFEST, "predicate", "host", "packages", "quadrants"
        ),
        "another Torch installed": packages(torch="2.12.0"),
        "another build of Torch installed": both(
            on("cuda"), packages(torch="2.13.0+cpu")
        ),
    },
    ("torch", "torch"): {
        "amdgpu without HIP": on("amdgpu", hip_version=None),
        "amdgpu with Torch for the CPU": on("amdgpu", torch_version="2.13.0+cpu"),
        "a HIP newer than its ROCm": on("amdgpu", torch_version="2.13.0+rocm6.0"),
        "a Torch of another CUDA": on("cuda", torch_version="2.13.0+cu126"),
        "Torch forced to the CPU": on("amdgpu", torch_device="cpu"),
        "an architecture that spells the valid ones": part(
            "backend", arch="x64 or arm64"
        ),
        "Torch forced to the CPU by a switch": predicate(
            environment={"GS_TORCH_FORCE_CPU_DEVICE": "1"}
        ),
    },
    ("environment", "environment"): {
        "a variable that is no switch": predicate(environment={"LOGNAME": "somebody"}),
        "somebody's home": predicate(
            environment={"LIBGL_DRIVERS_PATH": "/usr/lib:/home/somebody/mesa"}
        ),
    },
    ("render", "render"): {
        "software drawing claimed as a GPU's": part("render", software=False),
        "a camera without a renderer": part("render", renderer=None),
        "a renderer without a camera": part("render", mode="skip"),
    },
    ("log", "log"): {"a warning left out": predicate(warnings=[])},
    ("digest", "log"): {
        "a log of another backend": log("gs.cpu", "gs.cuda"),
        "a log of another device": log("[a CPU]", "[a GPU]"),
        "a log of another seed": log("seed: 0", "seed: 1"),
        "a log of software drawing": both(on("cuda"), log("INFO", f"{SOFTWARE}INFO")),
        "a log without its software drawing": log(SOFTWARE, ""),
        "a log without a seed": log("seed: 0", "seeds: none"),
        "a log with the device of another": after(
            LOG,
            b"INFO Running on [a GPU] with backend gs.amdgpu. Device memory: 1 GB.\n",
        ),
        "a long line of one word of the log": after(
            LOG, b"INFO " + b"initialized. version: " * LINE_LIMIT
        ),
        "a warning of many lines": after(LOG, b"WARNING \n" + b"\n" * 2_000_000),
        "a log that is no text": after(LOG, b"\xff"),
    },
    ("engine-files", "engine-files"): {
        "a patched engine": part("engine", files_match_wheel=False)
    },
    # The question.
    ("key", "stale"): {
        "an older engine": both(
            part("engine", version="1.2.0"),
            packages(**{"genesis-world": "1.2.0"}),
            log("version: ", "version: 1.2.0, was: "),
        ),
        "other parameters": part("parameters", "cases", "G1", kp=lambda kp: kp[::-1]),
        "another module": modules(metrics="0" * 64),
        "no page digest": part("source", page=None),
    },
    # Arrays.
    ("digest", "path"): {
        "arrays outside the bundle": case("G1", file="../elsewhere/G1.npz")
    },
    ("digest", "labels"): {
        "a wrong unit": case("G2", "variables", "q_rad_or_m", unit=["deg"] * 9),
        "an undescribed array": pop(ARRAYS, "cases", "G1", "variables", "t_s"),
        "one link twice": coords(link=["hand"] * 3),
        "one link too few": pop(ARRAYS, "coords", "link", -1),
        "a joint too few": pop(ARRAYS, "joints", -1),
        "a joint of no known type": joint(0, type="SPHERICAL"),
        "two joints on one DOF": joint(1, dof_idx_local=0),
        "two joints in each other's place": both(
            joint(0, q_idx_local=1), joint(1, q_idx_local=0)
        ),
        "a limit left out": joint(3, upper=None),
        "a wider limit": joint(8, lower=-0.001),
    },
    ("digest", "bad-array"): {
        "a cut archive": bytes_of(G1, lambda b: b[:-500]),
        "pickled objects": first_array(npy(b"(121,), }", b"|O")),
        "a header of four TiB": first_array(npy(b"(549755813888,), }")),
        "a header without an end": first_array(npy()),
        "a member more": members(lambda kept: [*kept, ("luck.npy", kept[0][1])]),
        "an archive in other order": members(lambda kept: kept[::-1]),
        "a packed archive": members(lambda kept: kept, zipfile.ZIP_LZMA),
        "arrays of another type": rewrite(q=np.float64),
        "an archive before other bytes": after(G1, b"x"),
    },
    ("digest", "too-big"): {
        "a zip bomb": first_array(bytes(UNPACKED_LIMIT + 1), zipfile.ZIP_DEFLATED)
    },
    ("digest", "bad-trace"): {
        "arrays that are not finite": rewrite(q=changed_at((-1, 0), np.nan)),
        "a shifted time axis": rewrite(t=lambda t: t + 0.01),
    },
    ("digest", "start"): {
        "a target that wanders": rewrite(target=changed_at((5, 3), 0.0)),
        "a start with velocity": rewrite(start_qd=changed_at(3, 0.1)),
        "a start elsewhere": rewrite(q=changed_at((0, 3), -1.9)),
    },
    ("digest", "stamps"): {"stamps of another dt": rewrite(t=lambda t: t * 2)},
    ("digest", "law"): {
        "an effort limit of another case": rewrite(effort_limit=off_law),
        "edited arrays": rewrite(qd=off_law),
    },
    ("digest", "motion"): {"no internal force": rewrite(internal_force=np.zeros_like)},
    ("digest", "pose"): {
        "quaternions of zero": rewrite(link_quat=np.zeros_like),
        "a link that is moved": rewrite(link_pos=changed_at((60, 2, 1), 0.3)),
        "a link that the model lacks": coords(link=["link0", "link4", "head"]),
    },
    # Frames.
    ("digest", "frames"): {
        "a frame that is no picture": write("frames/final.png", "x"),
        "a frame with another text": png(text=lambda t: b"luck\0x"),
        "a frame of another run": png(text=lambda t: b"run_id\0" + b"f" * 32),
        "a frame with bytes after its pixels": png(packed=lambda p: p + b"x"),
        "a frame of pixels that cannot be unpacked": png(packed=lambda p: b"x"),
        "a frame with rows of another filter": rows(lambda r: b"\0" + r[1:]),
        "a frame of bombs": rows(lambda r: bytes(2**27)),
    },
    ("frames", "frames"): {
        "frames without a camera": part(
            "render", mode="skip", vendor=None, renderer=None, software=None
        )
    },
    # Metrics and checks.
    ("digest", "metrics"): {
        "an edited metric": metric(value=0.0),
        "a group too many": metrics(lambda m: m.update(G4={})),
        "a count that is none": put(METRICS, "model", "links", value=11.0),
        "a count that is missing": pop(METRICS, "model", "links"),
    },
    ("digest", "checks"): {
        "an edited count": link_too_many,
        "one and the same picture twice": copied_to("frames/final.png"),
        "a failure of other values": both(failing, found("mapping", dofs="luck")),
    },
    ("checks", "checks"): {
        "a value found off by a millionth": found(
            "saturation",
            **{"G2.saturation_duration_s": lambda value: value * (1 + 1e-6)},
        ),
        "a found value of another type": found("mapping", links=11.0),
        "a found value too many": found("mapping", luck=1),
        "a found value that is missing": pop(MANIFEST, *MAPPING, "found", "links"),
        "a check left out": pop(MANIFEST, "predicate", "checks", -1),
    },
    ("digest", "failed"): {
        "a link too many, and it says so": failing,
        "a link too many, called passed": both(
            failing,
            manifest(
                lambda m: [of.update(passed=True) for of in m["predicate"]["checks"]]
            ),
        ),
    },
}

SPOILED = {
    name: (*codes, spoil) for codes, of in GROUPS.items() for name, spoil in of.items()
}
