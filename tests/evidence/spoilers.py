"""Bundles spoiled in one way each, with the code that refuses them.

`SPOILED` is name → (code as it is, code after digests and key were made right again, spoiler).
A spoiler changes the bundle in a folder; it returns the folder where it moved it.
"""

import io
import json
import os
import shutil
import warnings
import zipfile
import zlib
from pathlib import Path

import numpy as np
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from robo_genesis.core.scene import CAMERA_RES
from robo_genesis.evidence import bundle, bundle_files, picture_file, trace_files
from robo_genesis.evidence.fields import LINE_LIMIT
from robo_genesis.evidence.npz_archive import UNPACKED_LIMIT, write_archive
from robo_genesis.evidence.picture_file import read_picture, write_picture
from robo_genesis.evidence.reader import from_bundle

G1, LOG, INITIAL = "arrays/G1.npz", "log.txt", "frames/initial.png"
NAMES = {field: name for field, (name, *_) in trace_files.FIELDS.items()}


# --- files ----------------------------------------------------------------------------------


def edit(folder, name, change):
    """Change the JSON of one file in place, also to values that the recorder does not write."""
    path = folder / name
    value = json.loads(path.read_text("utf8"))
    change(value)
    text = json.dumps(value, indent=1, ensure_ascii=False)
    path.write_text(f"{text}\n", "utf8", "surrogatepass")


def editing(name):
    return lambda change: lambda folder: edit(folder, name, change)


manifest, arrays, metrics = map(editing, ("manifest.json", "arrays.json", "metrics.json"))


def predicate(**values):
    return manifest(lambda m: m["predicate"].update(values))


def part(name, **values):
    """Change one record of the predicate."""
    return manifest(lambda m: m["predicate"][name].update(values))


def modules(**digests):
    """Change or add digests of modules."""
    return manifest(lambda m: m["predicate"]["source"]["modules"].update(digests))


def bytes_of(name, change):
    """Change the bytes of a file."""

    def spoil(folder):
        path = folder / name
        path.write_bytes(change(path.read_bytes()))

    return spoil


def text(name, old, new):
    """Replace text in a file, every occurrence."""

    def change(content):
        assert old.encode() in content
        return content.replace(old.encode(), new.encode())

    return bytes_of(name, change)


def log(old, new):
    return text(LOG, old, new)


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
    """Return where a bundle stands after a spoiler, of which few move it."""
    return returned if isinstance(returned, Path) else folder


def filed_as(name):
    return lambda folder: folder.rename(folder.with_name(name))


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


def add_subject(name):
    entry = {"name": name, "digest": {"sha256": "0" * 64}}
    return manifest(lambda m: m["subject"].append(entry))


def repeat_subject(change):
    return manifest(
        lambda m: m["subject"].append(m["subject"][0] | {"name": change(m["subject"][0]["name"])})
    )


def link_out(folder):
    outside = shutil.move(folder / LOG, folder.parent / LOG)
    (folder / LOG).symlink_to(outside)


def link_folder(folder):
    folder.symlink_to(folder.rename(folder.with_name("elsewhere")))


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


def nested(levels):
    """Return lists in lists."""
    value = []
    for _ in range(levels - 1):
        value = [value]
    return value


# --- accelerators ---------------------------------------------------------------------------

TORCH = {
    "amdgpu": {"torch_version": "2.13.0+rocm7.1", "hip_version": "7.1.25424", "cuda_version": None},
    "cuda": {"torch_version": "2.13.0+cu130", "hip_version": None, "cuda_version": "13.0"},
}
SOFTWARE = "INFO Software rendering context detected. Shadows not supported.\n"


def on(actual, **changed):
    """Turn the CPU's bundle into one that an accelerator would have left, sealed, then changed."""
    torch = {"torch_device": "cuda", **TORCH[actual]}
    return both(
        part("backend", actual=actual, actual_at_end=actual, arch=actual, **torch),
        part("backend", requested="auto", driver="6.16", device_name="a GPU"),
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


# --- arrays ---------------------------------------------------------------------------------


def rewrite(case="G1", **fields):
    """Write one case's archive anew, some fields changed by their functions."""

    def change(folder):
        path = folder / "arrays" / f"{case}.npz"
        with np.load(path) as archive:
            kept = {**archive}
        kept |= {NAMES[field]: changed(kept[NAMES[field]]) for field, changed in fields.items()}
        write_archive(path, kept)

    return change


def checked_again(folder):
    """Make the recorded checks those of the arrays and joints, failures included."""
    run = from_bundle(folder, bundle.read_manifest(folder), bundle.read_metrics(folder))
    predicate(checks=[outcome.record() for outcome in run.outcomes()])(folder)


def joint(index, **values):
    """Change one record of the joint map."""
    return arrays(lambda a: a["joints"][index].update(values))


def joints(change):
    return arrays(lambda a: change(a["joints"]))


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
        with (
            warnings.catch_warnings(action="ignore"),  # of names that are repeated
            zipfile.ZipFile(folder / G1, "w", packing) as archive,
        ):
            for name, content in change(kept):
                archive.writestr(zipfile.ZipInfo(name), content, packing)

    return spoil


def first_member(change):
    return members(lambda kept: [(kept[0][0], change(kept[0][1])), *kept[1:]])


def in_fortrans_order(kept):
    stream = io.BytesIO()
    np.save(stream, np.asfortranarray(np.load(io.BytesIO(kept[1][1]))))
    return [kept[0], (kept[1][0], stream.getvalue()), *kept[2:]]


def header(shape):
    """Make the first array nothing but a header."""
    said = b"{'descr': '<f8', 'fortran_order': False, 'shape': " + shape + b"\n"
    return first_member(lambda _: b"\x93NUMPY\1\0" + len(said).to_bytes(2, "little") + said)


def pickled(folder):
    stream = io.BytesIO()
    np.save(stream, np.full(121, None), allow_pickle=True)
    first_member(lambda _: stream.getvalue())(folder)


def comment(folder):
    with zipfile.ZipFile(folder / G1, "a") as archive:
        archive.comment = b"luck"


def drop_case(folder):
    (folder / "arrays" / "G3.npz").unlink()
    edit(folder, "arrays.json", lambda a: a["cases"].pop("G3"))


def variable(**values):
    return arrays(lambda a: a["cases"]["G2"]["variables"]["q_rad_or_m"].update(values))


# --- metrics, checks, frames ----------------------------------------------------------------


def metric(**values):
    return metrics(lambda m: m["G2"]["overshoot"].update(values))


def count(change):
    return metrics(lambda m: change(m["model"]))


def check(index, **values):
    return manifest(lambda m: m["predicate"]["checks"][index].update(values))


def of_check(name, change):
    """Change the values that a check found."""

    def spoil(m):
        [values] = [of["found"] for of in m["predicate"]["checks"] if of["name"] == name]
        change(values)

    return manifest(spoil)


def found(name, label, value):
    """Write one value that a check found."""
    return of_check(name, lambda values: values.update({label: value}))


all_passed = manifest(lambda m: [check.update(passed=True) for check in m["predicate"]["checks"]])
FAILING = {
    "two joints on one DOF": joint(1, dof_idx_local=0),
    "a target outside its limits": joint(3, upper=-1.9),
    "a joint without a limit": joint(0, lower=None),
}
"""Runs that fail a check of their own, as they would have been measured."""


def failing(how, *more):
    """Fail a check, and say so."""
    return both(FAILING[how], checked_again, *more)


def png(text=lambda content: content, packed=lambda content: content):
    """Write a frame in the recorder's form, with another text or other packed pixels."""

    def spoil(data):
        words = picture_file._content(data, place := picture_file.TEXT_PLACE)
        kept = picture_file._content(data, place + len(words) + 12)
        return picture_file._png(CAMERA_RES, text(words), packed(kept))

    return bytes_of(INITIAL, spoil)


def rows(change):
    return png(packed=lambda packed: zlib.compress(change(zlib.decompress(packed))))


def saved(mode="RGB", size=CAMERA_RES, **options):
    """Write a frame with another program, with the text of its run."""

    def spoil(folder):
        with Image.open(folder / INITIAL) as picture:
            copy, words = picture.convert(mode).resize(size), PngInfo()
            words.add_text("run_id", picture.info["run_id"])
        copy.save(folder / INITIAL, pnginfo=words, **options)

    return spoil


def copied_to(name):
    """Copy the first frame to another name."""
    return lambda folder: (folder / name).write_bytes((folder / INITIAL).read_bytes())


LINES = ("device_name", "driver", "torch_version", "hip_version", "cuda_version", "arch")
ODD = {
    "two lines": "<script>\nalert(1)</script>",
    "a control character": "\x1b[2Jx",
    "a separator of lines": "a\u2028b",
    "a reversed direction": "a\u202eb",
    "201 characters": "x" * 201,
}
"""Text that no page and no terminal may show."""

OLD_TYPE = {"predicateType": "urn:robo-genesis:evidence:v1"}
GROUPS = {
    # Form of the files, before anything is believed.
    ("missing-file", "missing-file"): {"no manifest": remove("manifest.json")},
    ("path", "path"): {
        "a link instead of a file": link_out,
        "a link instead of the folder": link_folder,
        "a pipe among the files": lambda f: os.mkfifo(f / "pipe"),
    },
    ("too-big", None): {"a manifest that is too long": pad("manifest.json")},
    ("too-big", "too-big"): {
        "an archive that is too long": pad(G1),
        "too many files": crowd,
    },
    ("bad-json", None): {
        "a key twice": text("manifest.json", '"seed"', '"seed": 0, "seed"'),
        "a byte order mark": bytes_of("manifest.json", lambda b: b"\xef\xbb\xbf" + b),
        "another spelling of a number": text("manifest.json", "0.01,", "1e-2,"),
        "NaN in the manifest": predicate(seed=float("nan")),
        "half a character": predicate(command="\ud800"),
        "a number beyond JSON": predicate(seed=2**60),
        "a manifest too deep": write("manifest.json", "[" * 200_000),
        "parameters of 40 levels": part("parameters", deep=nested(40)),
    },
    ("digest", "bad-json"): {
        "a metric of 401 digits": metric(value=10**400),
        "a metric of 10,000 digits": text(
            "metrics.json", '"value": 0', '"value": 1' + "0" * 10_000),
        "a metric of 1e300": metric(value=1e300),
        "a limit that is no number": joint(0, lower=float("nan")),
    },
    ("bad-schema", "bad-schema"): {
        "an unknown field": predicate(mood="good"),
        "a missing field": manifest(lambda m: m["predicate"].pop("warnings")),
        "a number as text": predicate(seed="0"),
        "an unknown backend": part("backend", actual="tpu"),
        "a schema that is true": predicate(schema_version=True),
        "found text of two lines": found("mapping", "links", "a\nb"),
        "a found list": found("mapping", "links", [11]),
        "words of a check": check(0, detail="luck"),
        **{f"{name} of {what}": part("backend", **{name: value})
           for name in LINES for what, value in ODD.items()},
        **{f"a command of {what}": predicate(command=value * 10) for what, value in ODD.items()},
        **{f"a warning of {what}": predicate(warnings=[value * 100])
           for what, value in ODD.items() if "lines" not in what},
        **{f"a switch of {what}": predicate(environment={"GS_LOG": value * 10})
           for what, value in ODD.items()},
    },
    ("digest", "bad-schema"): {
        "metrics as a list": write("metrics.json", "[]\n"),
        "a link of two lines": arrays(lambda a: a["coords"].update(link=["a\nb", "c", "d"])),
        "a long unit": metric(unit="m" * 201),
        "a joint without its limits": joints(lambda j: j[0].pop("lower")),
        "a joint before the first DOF": joint(0, dof_idx_local=-1),
    },
    ("schema", "schema"): {
        "a newer schema": predicate(schema_version=3),
        "a schema below all": predicate(schema_version=-1),
        "an older type of a newer schema": both(
            manifest(lambda m: m.update(OLD_TYPE)), predicate(schema_version=3)),
        "a type of no number": manifest(
            lambda m: m.update(predicateType="urn:robo-genesis:evidence:v0x")),
    },
    ("older-schema", "older-schema"): {"an older schema": predicate(schema_version=1)},
    ("older-schema", None): {"an older schema of other fields": manifest(
        lambda m: m.update(OLD_TYPE | {"predicate": {"backend": "cpu"}}))},
    # Identity and the list of files.
    ("lesson", "lesson"): {"another lesson": predicate(lesson="l99")},
    ("key", "lesson"): {"a page that the book lacks": predicate(page="exam")},
    ("time", "time"): {
        "ended before it began": predicate(ended="2020-01-01T00:00:00Z"),
        "a day that no month has": predicate(started="2026-13-45T00:00:00Z"),
    },
    ("key", None): {"another key": predicate(evidence_key="0" * 64)},
    ("path", None): {
        "a listed path above": add_subject("../cpu/log.txt"),
        "a listed absolute path": add_subject("/etc/hostname"),
        "a file listed twice": repeat_subject(str),
        "names that differ in case": repeat_subject(str.upper),
    },
    ("files", "cases"): {"a missing file": remove(G1), "a dropped case": drop_case},
    ("files", "files"): {"no log": remove(LOG), "an extra file": write("extra.txt", "x")},
    ("files", "frames"): {
        "an extra picture": copied_to("frames/third.png"),
        "a camera without frames": lambda f: shutil.rmtree(f / "frames"),
    },
    # Backend, Torch, renderer, log.
    ("backend", "backend"): {
        "the CPU's run filed as amdgpu": both(
            part("backend", requested="auto"), filed_as("amdgpu")),
        "another backend at the end": part("backend", actual_at_end="cuda"),
        "cpu requested, amdgpu claimed": on("amdgpu", requested="cpu"),
    },
    ("torch", "torch"): {
        "amdgpu without HIP": on("amdgpu", hip_version=None),
        "Torch forced to the CPU": on("amdgpu", torch_device="cpu"),
        "an architecture that spells the valid ones": part("backend", arch="x64 or arm64"),
        "Torch forced to the CPU by a switch": predicate(
            environment={"GS_TORCH_FORCE_CPU_DEVICE": "1"}),
    },
    ("environment", "environment"): {
        "a variable that is no switch": predicate(environment={"LOGNAME": "somebody"}),
        "somebody's home": predicate(
            environment={"LIBGL_DRIVERS_PATH": "/usr/lib:/home/somebody/mesa"}),
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
        "a log of another engine": log("version: ", "version: 0."),
        "a log of another seed": log("seed: 0", "seed: 1"),
        "a log of software drawing": both(on("cuda"), log("INFO", f"{SOFTWARE}INFO")),
        "a log without a seed": log("seed: 0", "seeds: none"),
        "a log with the device of another": bytes_of(LOG, lambda b: b
            + b"INFO Running on [a GPU] with backend gs.amdgpu. Device memory: 1 GB.\n"),
        "a long line of one word of the log": bytes_of(LOG, lambda b: b
            + b"INFO " + b"initialized. version: " * LINE_LIMIT),
        "a warning of many lines": bytes_of(LOG, lambda b: b + b"WARNING \n" + b"\n" * 2_000_000),
        "a log that is no text": bytes_of(LOG, lambda b: b"\xff"),
    },
    ("engine-files", "engine-files"): {"a patched engine": part("engine", files_match_wheel=False)},
    # The question.
    ("key", "stale"): {
        "an older engine": both(
            part("engine", version="1.2.0"), log("version: ", "version: 1.2.0, was: ")),
        "other parameters": manifest(
            lambda m: m["predicate"]["parameters"]["cases"]["G1"]["kp"].reverse()),
        "another module": modules(metrics="0" * 64),
        "no page digest": part("source", page=None),
        "a parameter as text": part("parameters", rise_fraction="0.9"),
    },
    # Arrays.
    ("digest", "cases"): {"a case without its archive": arrays(lambda a: a["cases"].pop("G3"))},
    ("digest", "path"): {"arrays outside the bundle": arrays(
        lambda a: a["cases"]["G1"].update(file="../elsewhere/G1.npz"))},
    ("digest", "labels"): {
        "a wrong unit": variable(unit=["deg"] * 9),
        "other dimensions": variable(dims=["dof", "state"]),
        "another type described": variable(dtype="float64"),
        "another number of joints": variable(shape=[121, 8]),
        "an undescribed array": arrays(lambda a: a["cases"]["G1"]["variables"].pop("t_s")),
        "DOF names left out": arrays(lambda a: a["coords"].pop("dof")),
        "one link twice": arrays(lambda a: a["coords"].update(link=["hand"] * 3)),
        "one link too few": arrays(lambda a: a["coords"]["link"].pop()),
        "a joint too few": joints(lambda j: j.pop()),
        "joints in another order": joints(lambda j: j.reverse()),
        "a joint of no known type": joint(0, type="SPHERICAL"),
        "a finger called revolute": joint(7, type="REVOLUTE", unit="rad"),
    },
    ("digest", "bad-array"): {
        "a cut archive": bytes_of(G1, lambda b: b[:-500]),
        "pickled objects": pickled,
        "a header of four TiB": header(b"(549755813888,), }"),
        "a header of negative size": header(b"(-1, -1), }"),
        "a header without an end": header(b"(1,"),
        "a member twice": members(lambda kept: [*kept, kept[0]]),
        "a member more": members(lambda kept: [*kept, ("luck.npy", b"")]),
        "an archive in other order": members(lambda kept: kept[::-1]),
        "a packed archive": members(lambda kept: kept, zipfile.ZIP_LZMA),
        "bytes in an array's header": first_member(lambda f: f.replace(b"      ", b" 'a':1", 1)),
        "bytes after an array": first_member(lambda f: f + b"x"),
        "another version of an array's format": first_member(
            lambda f: f[:6] + b"\2\0" + f[8:10] + b"\0\0" + f[10:]),
        "another checksum": bytes_of(G1, lambda b: b.replace(b"\x93NUMPY", b"\x93NUMPZ", 1)),
        "arrays of another type": rewrite(q=np.float64),
        "arrays in Fortran's order": members(in_fortrans_order),
        "an archive after other bytes": bytes_of(G1, lambda b: b"x" + b),
        "an archive before other bytes": bytes_of(G1, lambda b: b + b"x"),
        "an archive with a comment": comment,
        "an archive with another date": bytes_of(G1, lambda b: b.replace(b"\x21\0", b"\x22\0", 1)),
    },
    ("digest", "too-big"): {"a zip bomb": members(
        lambda kept: [(kept[0][0], bytes(UNPACKED_LIMIT + 1))], zipfile.ZIP_DEFLATED)},
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
        "a joint that stands still": rewrite(q=changed_at((slice(None), 3), -2.0)),
        "off its control law": rewrite(control_force=off_law),
        "an effort limit of another case": rewrite(effort_limit=off_law),
        "edited arrays": rewrite(qd=off_law),
    },
    ("digest", "motion"): {"no internal force": rewrite(internal_force=np.zeros_like)},
    ("digest", "pose"): {
        "quaternions of zero": rewrite(link_quat=np.zeros_like),
        "a link that is moved": rewrite(link_pos=changed_at((60, 2, 1), 0.3)),
        "a link that the model lacks": arrays(
            lambda a: a["coords"].update(link=["link0", "link4", "head"])),
    },
    # Frames.
    ("digest", "frames"): {
        "a frame that is no picture": write("frames/final.png", "x"),
        "a frame without a stamp": png(text=lambda t: b""),
        "a frame with another text": png(text=lambda t: b"luck\0x"),
        "a frame of another run": png(text=lambda t: b"run_id\0" + b"f" * 32),
        "a frame of another size": saved(size=(8, 8)),
        "an animated frame": saved(save_all=True, append_images=[Image.new("RGB", CAMERA_RES)]),
        "a frame with a palette": saved("P"),
        "a frame before other bytes": bytes_of(INITIAL, lambda b: b + b"x"),
        "a frame with another checksum": bytes_of(INITIAL, lambda b: b[:-1] + b"x"),
        "a frame with a private chunk": bytes_of(INITIAL, lambda b: b.replace(
            (end := picture_file._chunk(b"IEND", b"")), picture_file._chunk(b"luCK", b"x") + end)),
        "a frame with bytes after its pixels": png(packed=lambda p: p + b"x"),
        "a frame of pixels that cannot be unpacked": png(packed=lambda p: b"x"),
        "a frame with pixels too few": rows(lambda r: r[:-1]),
        "a frame with rows of another filter": rows(lambda r: b"\0" + r[1:]),
        "a frame of bombs": rows(lambda r: bytes(2**27)),
    },
    ("frames", "frames"): {"frames without a camera": part(
        "render", mode="skip", vendor=None, renderer=None, software=None)},
    # Metrics and checks.
    ("digest", "metrics"): {
        "a flipped byte": bytes_of("metrics.json", lambda b: b.replace(b"0.", b"1.", 1)),
        "an edited metric": metric(value=0.0),
        "a metric of another unit": metric(unit="degree"),
        "a metric that is missing": metrics(lambda m: m["G1"].pop("rise_time")),
        "a group too many": metrics(lambda m: m.update(G4={})),
        "a count that is none": count(lambda m: m["links"].update(value=11.0)),
        "a count that is missing": count(lambda m: m.pop("links")),
        "no counts": metrics(lambda m: m.pop("model")),
    },
    ("digest", "checks"): {
        "an edited count": count(lambda m: m["links"].update(value=12)),
        "one and the same picture twice": copied_to("frames/final.png"),
        "a qpos that the model lacks": joint(8, q_idx_local=9),
        "a failure of other values": failing(
            "two joints on one DOF", found("mapping", "local_dofs", "luck")),
        **{f"{how}, kept quiet": spoil for how, spoil in FAILING.items()},
    },
    ("checks", "checks"): {
        "another value found by a check": found(
            "control_law", "G2.distance_to_control_law", 0.001),
        "a value found off by a millionth": of_check("saturation", lambda of: of.update(
            {(at := "G2.saturation_duration_s"): of[at] * (1 + 1e-6)})),
        "a found value of another type": found("mapping", "links", 11.0),
        "a found truth as a number": found("posture", "final.usable", 1),
        "a found value too many": found("mapping", "luck", 1),
        "a found value that is missing": of_check("mapping", lambda of: of.pop("links")),
        "a check left out": manifest(lambda m: m["predicate"]["checks"].pop()),
        "no check": predicate(checks=[]),
    },
    ("digest", "failed"): {
        **{f"{how}, and it says so": failing(how) for how in FAILING},
        **{f"{how}, called passed": failing(how, all_passed) for how in FAILING},
    },
}  # fmt: skip
"""(Code as it is, code when sealed again, None if it cannot be) → the spoilers by name."""

SPOILED = {name: (*codes, spoil) for codes, of in GROUPS.items() for name, spoil in of.items()}
