"""Episodes as a dataset in the layout of LeRobot 3.0: ```` ```{dataset} l08/lab ````.

The page with the directive is the datasheet, and becomes the archive's README. The data
come from the lesson's `dataset.recorded`, which gets the experiment of the page's
bundle:

| key | content |
|---|---|
| `task` | what the episodes do, as an instruction |
| `robot` | its type |
| `fps` | rows in a second |
| `columns` | by name the values (episodes, rows, …), and names of their last axis or None |
| `privileged` | the columns that a robot outside a simulator does not have |
| `pictures` | (k, rows, height, width, 3) of the first k episodes, None without a camera |
| `parameters` | every configured input, JSON values |
| `credit` | authors of the shape that the pictures show |

In this layout either all episodes have pictures or none has. So the archive holds two
datasets: `state` with all episodes and columns, and `camera` with the episodes that
have pictures, without the privileged columns. Layout and names are those of
`lerobot/datasets/utils.py` in https://github.com/huggingface/lerobot, which a slow test
reads with.
"""

import json
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from typing import Any

import av
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from docutils import nodes
from sphinx.application import Sphinx

from robo_genesis.core.files import bytes_digest, write_whole
from robo_genesis.core.project import ROOT
from robo_genesis.core.shown import find
from robo_genesis.pipeline.html.archive import SUMS, sums, zipped
from robo_genesis.pipeline.pages.outputs import accepted_experiment
from robo_genesis.pipeline.pages.page_index import page_bundle
from robo_genesis.site.pages import PageDirective

from .directive import folder, links
from .files import writer_of
from .plain_markdown import plain

FILE = "chunk-000/file-000"  # The only file of each kind
CHUNK = "chunk-{chunk_index:03d}/file-{file_index:03d}"
CAMERA = "observation.images.world"
QUANTILES = {"min": 0.0, "max": 1.0}
QUANTILES |= {f"q{percent:02}": percent / 100 for percent in (1, 10, 50, 90, 99)}

PIXELS = "yuv420p"
# Of the encoder: few frames depend on others, and equal pictures give equal bytes.
OPTIONS = {"crf": "18", "g": "2", "threads": "1"}


class DatasetDownload(PageDirective):
    """Write the archive with the episodes of a page, and link it."""

    required_arguments = 1

    def shown(self) -> list[nodes.Node]:
        """Return the link to the archive, its size and its digest."""
        lesson_page = self.arguments[0]
        lesson = lesson_page.split("/")[0]
        source = Path(self.env.doc2path(self.env.docname))
        writer = writer_of(source, self.env.docname)
        title = f"> {self.config.html_title}. © {self.config.author}. {writer.address}"
        readme = f"{title.rstrip()}\n\n{plain(source.read_text('utf8'), writer)}"
        run = accepted_experiment(page_bundle(lesson_page))
        recorded = find(f"robo_genesis.lessons.{lesson}.dataset.recorded")
        content = archive(recorded(run), readme)
        name = f"{lesson_page.replace('/', '-')}-lerobot.zip"
        file = folder(self.env) / f"{lesson}-dataset" / name
        write_whole(file, content)
        link, digest = links(self.env)(file), bytes_digest(content)
        return self.parse_text_to_nodes(f"- {link}, SHA-256 `{digest}`")


def archive(data: Mapping[str, Any], readme: str) -> bytes:
    """Return the zip with both datasets, the datasheet, settings, licence, and all digests."""
    members = {f"state/{path}": content for path, content in files(data).items()}
    if data["pictures"] is not None:
        columns = {
            name: column
            for name, column in data["columns"].items()
            if name not in data["privileged"]
        }
        camera = files({**data, "columns": columns}, data["pictures"])
        members |= {f"camera/{path}": content for path, content in camera.items()}
    members["parameters.json"] = json.dumps(data["parameters"], indent=1).encode()
    licence = (ROOT / "LICENSE").read_text("utf8")
    members["LICENSE"] = f"{licence}\n{data['credit']}\n".encode()
    members["README.md"] = f"{readme}\n".encode()
    members[SUMS] = sums(members.items())
    return zipped(members.items())


def files(
    data: Mapping[str, Any], pictures: np.ndarray | None = None
) -> dict[str, bytes]:
    """Return the files of one dataset by path: all episodes, or the first ones with pictures."""
    fps, given = data["fps"], data["columns"]
    episodes, rows = next(iter(given.values()))[0].shape[:2]
    if pictures is not None:
        episodes = len(pictures)
    index = np.arange(episodes * rows)
    episode, row = np.divmod(index, rows)
    columns = {name: joined(values[:episodes]) for name, (values, _) in given.items()}
    columns |= {
        "timestamp": (row / fps).astype(np.float32),
        "frame_index": row,
        "episode_index": episode,
        "index": index,
        "task_index": np.zeros_like(index),
    }
    features: dict[str, Any] = {
        name: {
            "dtype": str(values.dtype),
            "shape": values.shape[1:] or (1,),
            "names": given[name][1] if name in given else None,
        }
        for name, values in columns.items()
    }
    members = {f"data/{FILE}.parquet": parquet(columns)}
    starts = rows * np.arange(episodes)
    table: dict[str, Any] = {
        "episode_index": range(episodes),
        "tasks": [[data["task"]]] * episodes,
        "length": [rows] * episodes,
        "dataset_from_index": starts,
        "dataset_to_index": starts + rows,
    }
    places = ["data", "meta/episodes"]
    video_path = None
    if pictures is not None:
        place = f"videos/{CAMERA}"
        features[CAMERA] = about_video(pictures, fps)
        members[f"{place}/{FILE}.mp4"] = video(pictures, fps)
        table[f"{place}/from_timestamp"] = starts / fps
        table[f"{place}/to_timestamp"] = (starts + rows) / fps
        places.append(place)
        columns[CAMERA] = joined(pictures)
        video_path = f"videos/{{video_key}}/{CHUNK}.mp4"
    for place in places:
        table[f"{place}/chunk_index"] = table[f"{place}/file_index"] = [0] * episodes
    for name, values in columns.items():
        each = [statistics(part) for part in np.split(values, episodes)]
        for measure in each[0]:
            table[f"stats/{name}/{measure}"] = [one[measure] for one in each]
    info = {
        "codebase_version": "v3.0",
        "robot_type": data["robot"],
        "total_episodes": episodes,
        "total_frames": len(index),
        "total_tasks": 1,
        "chunks_size": 1000,
        "data_files_size_in_mb": 100,
        "video_files_size_in_mb": 200,
        "fps": fps,
        "splits": {"train": f"0:{episodes}"},
        "data_path": f"data/{CHUNK}.parquet",
        "video_path": video_path,
        "features": features,
    }
    stats = {name: statistics(values) for name, values in columns.items()}
    tasks = {"task_index": [0], "task": [data["task"]]}
    return members | {
        "meta/info.json": json.dumps(info, indent=1).encode(),
        "meta/stats.json": json.dumps(stats, indent=1).encode(),
        "meta/tasks.parquet": parquet(tasks, PANDAS),
        f"meta/episodes/{FILE}.parquet": parquet(table),
    }


def joined(episodes: np.ndarray) -> np.ndarray:
    """Return the rows of all episodes one after the other."""
    return episodes.reshape(-1, *episodes.shape[2:])


# Pandas, with which LeRobot reads the tasks, takes their texts as the index.
PANDAS = {
    "index_columns": ["task"],
    "columns": [
        {
            "name": "task",
            "field_name": "task",
            "pandas_type": "unicode",
            "numpy_type": "object",
        }
    ],
    "column_indexes": [],
}


def parquet(
    columns: Mapping[str, Any], pandas: Mapping[str, Any] | None = None
) -> bytes:
    """Return a table; an array of two axes has one list in each row.

    Args:
        columns: by name.
        pandas: what pandas stores about the table.
    """
    arrays = {
        name: pa.FixedSizeListArray.from_arrays(values.ravel(), values.shape[1])
        if isinstance(values, np.ndarray) and values.ndim == 2
        else pa.array(values)
        for name, values in columns.items()
    }
    table = pa.table(arrays)
    if pandas:
        table = table.replace_schema_metadata({"pandas": json.dumps(pandas)})
    target = pa.BufferOutputStream()
    pq.write_table(table, target)
    return bytes(target.getvalue())


def statistics(values: np.ndarray) -> dict[str, Any]:
    """Return least, largest, mean, standard deviation, count and quantiles of rows.

    Pictures (n, height, width, 3) have them for each colour as (3, 1, 1), from 0 to 1.
    """
    count, shape = len(values), [-1]
    if values.ndim == 4:
        values, shape = values.reshape(-1, values.shape[-1]) / 255, [-1, 1, 1]
    values = values.astype(np.float64).reshape(len(values), -1)
    levels = np.quantile(values, [*QUANTILES.values()], axis=0)
    measures = dict(zip(QUANTILES, levels, strict=True))
    measures |= {"mean": values.mean(0), "std": values.std(0)}
    lists = {name: value.reshape(shape).tolist() for name, value in measures.items()}
    return lists | {"count": [count]}


def about_video(pictures: np.ndarray, fps: int) -> dict[str, Any]:
    """Return the feature of the pictures."""
    height, width, channels = pictures.shape[2:]
    return {
        "dtype": "video",
        "shape": [height, width, channels],
        "names": ["height", "width", "channels"],
        "info": {
            "video.height": height,
            "video.width": width,
            "video.channels": channels,
            "video.fps": fps,
            "video.codec": "h264",
            "video.pix_fmt": PIXELS,
            "video.is_depth_map": False,
            "has_audio": False,
        },
    }


def video(pictures: np.ndarray, fps: int) -> bytes:
    """Return all pictures one after the other as an MP4 file."""
    target = BytesIO()
    with av.open(target, "w", format="mp4") as file:
        stream = file.add_stream("libx264", rate=fps, options=OPTIONS)
        stream.height, stream.width = pictures.shape[2:4]
        stream.pix_fmt = PIXELS
        for picture in joined(pictures):
            file.mux(stream.encode(av.VideoFrame.from_ndarray(picture)))
        file.mux(stream.encode())
    return target.getvalue()


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("dataset", DatasetDownload)
