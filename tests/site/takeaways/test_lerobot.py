"""Datasets that are read back: by PyArrow and PyAV, and in a slow test by LeRobot itself."""

import io
import json
import subprocess
import sys
import zipfile
from hashlib import sha256

import av
import numpy as np
import pyarrow.parquet as pq
import pytest

from robo_genesis.site.takeaways import lerobot

EPISODES, ROWS, FEW = 4, 30, 2
RNG = np.random.default_rng(0)
COARSE = RNG.integers(0, 255, (FEW, ROWS, 6, 8, 3))
DATA = {
    "task": "Pick it up.",
    "robot": "franka_panda",
    "fps": 20,
    "columns": {
        "observation.state": (
            RNG.random((EPISODES, ROWS, 2)).astype(np.float32),
            ["arm", "hand"],
        ),
        "action": (RNG.random((EPISODES, ROWS, 2)).astype(np.float32), ["arm", "hand"]),
        "phase": (RNG.integers(0, 9, (EPISODES, ROWS)), None),
        "next.done": (np.arange(ROWS) == np.full((EPISODES, 1), ROWS - 1), None),
    },
    "privileged": ("phase",),
    "parameters": {"dt": 0.05},
    "credit": "Shape by others.",
    "pictures": np.kron(COARSE, np.ones((1, 1, 18, 18, 1))).astype(np.uint8),
}
STATE, ACTION = (DATA["columns"][name][0] for name in ("observation.state", "action"))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The unpacked archive."""
    place = tmp_path_factory.mktemp("dataset")
    with zipfile.ZipFile(io.BytesIO(lerobot.archive(DATA, "# About"))) as whole:
        whole.extractall(place)
    return place


def read(path):
    return pq.read_table(path).to_pydict()


def test_each_row_has_its_numbers_and_its_place(folder):
    found = read(folder / f"state/data/{lerobot.FILE}.parquet")
    assert np.array_equal(np.float32(found["observation.state"]), STATE.reshape(-1, 2))
    assert found["phase"] == DATA["columns"]["phase"][0].ravel().tolist()
    k = 2 * ROWS + 3
    assert (found["index"][k], found["episode_index"][k], found["frame_index"][k]) == (
        k,
        2,
        3,
    )
    assert found["timestamp"][k] == np.float32(0.15)
    assert [k for k, done in enumerate(found["next.done"]) if done] == [29, 59, 89, 119]


def test_the_description_is_that_of_the_rows(folder):
    info = json.loads((folder / "state/meta/info.json").read_text())
    assert (info["total_episodes"], info["total_frames"], info["fps"]) == (4, 120, 20)
    state = {"dtype": "float32", "shape": [2], "names": ["arm", "hand"]}
    assert info["features"]["observation.state"] == state
    assert info["features"]["phase"] == {"dtype": "int64", "shape": [1], "names": None}
    episodes = read(folder / f"state/meta/episodes/{lerobot.FILE}.parquet")
    assert episodes["dataset_from_index"] == [0, 30, 60, 90]
    assert episodes["stats/action/max"][1] == pytest.approx(ACTION[1].max(axis=0))
    stats = json.loads((folder / "state/meta/stats.json").read_text())[
        "observation.state"
    ]
    assert stats["std"] == pytest.approx(STATE.reshape(-1, 2).std(axis=0), rel=1e-5)
    assert stats["q50"] == pytest.approx(np.median(STATE.reshape(-1, 2), axis=0))


def test_episodes_with_pictures_are_a_dataset_of_their_own(folder):
    assert (
        read(folder / f"camera/meta/episodes/{lerobot.FILE}.parquet")["length"]
        == [ROWS] * FEW
    )
    stats = json.loads((folder / "camera/meta/stats.json").read_text())[lerobot.CAMERA]
    assert np.ravel(stats["mean"]) == pytest.approx(
        COARSE.mean(axis=(0, 1, 2, 3)) / 255
    )
    with av.open(folder / f"camera/videos/{lerobot.CAMERA}/{lerobot.FILE}.mp4") as file:
        shown = [picture.to_ndarray(format="rgb24") for picture in file.decode(video=0)]
    assert np.shape(shown) == (FEW * ROWS, 108, 144, 3)
    assert (
        np.abs(np.float64(shown) - DATA["pictures"].reshape(np.shape(shown))).mean() < 5
    )
    assert (
        "phase"
        not in json.loads((folder / "camera/meta/info.json").read_text())["features"]
    )
    without = lerobot.archive(DATA | {"pictures": None}, "")
    assert b"camera/" not in without  # names are not compressed


def test_the_archive_is_the_same_each_time_and_lists_its_digests(folder):
    assert lerobot.archive(DATA, "a") == lerobot.archive(DATA, "a")
    sums = [
        line.split("  ") for line in (folder / "SHA256SUMS").read_text().splitlines()
    ]
    assert all(
        sha256((folder / name).read_bytes()).hexdigest() == digest
        for digest, name in sums
    )


READER = """
import sys
from lerobot.datasets.lerobot_dataset import LeRobotDataset
for name in ("state", "camera"):
    data = LeRobotDataset("l08", root=f"{sys.argv[1]}/{name}", video_backend="pyav")
    row = data[33]
    print(len(data), data.num_episodes, row["observation.state"].tolist(), row["task"])
print(tuple(row["observation.images.world"].shape), row["observation.images.world"].mean().item())
later = LeRobotDataset("l08", root=f"{sys.argv[1]}/state", delta_timestamps={"action": [0, 0.1]})
print(later[33]["action"][1].tolist())
print(later[28]["action"][1].tolist(), later[28]["action_is_pad"].tolist())
"""


@pytest.mark.slow
def test_lerobot_reads_it(folder, tmp_path):
    subprocess.run([sys.executable, "-m", "venv", tmp_path / "own"], check=True)
    python = tmp_path / "own/bin/python"
    subprocess.run([python, "-m", "pip", "install", "-q", "lerobot==0.4.4"], check=True)
    isolated = {
        "HF_HOME": str(tmp_path / "hub"),
        "HF_HUB_OFFLINE": "1",
        "PATH": "/usr/bin:/bin",
    }
    command = [python, "-c", READER, folder]
    done = subprocess.run(command, env=isolated, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-3000:]
    state, camera, picture, later, edge = done.stdout.splitlines()
    row = STATE[1, 3].tolist()
    assert state == f"120 4 {row} Pick it up."
    assert camera == f"60 2 {row} Pick it up."
    shape, _, mean = picture.rpartition(" ")
    assert shape == "(3, 108, 144)"
    assert float(mean) == pytest.approx(DATA["pictures"][1, 3].mean() / 255, abs=0.02)
    assert later == str(ACTION[1, 5].tolist())
    assert edge == f"{ACTION[0, 29].tolist()} [False, True]"
