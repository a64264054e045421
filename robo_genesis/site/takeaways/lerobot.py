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

import hashlib
import json
import zipfile
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
from sphinx.util.osutil import relative_uri

from robo_genesis.core.files import write_whole
from robo_genesis.core.project import ROOT
from robo_genesis.core.shown import find
from robo_genesis.pipeline.html.address import site_address
from robo_genesis.pipeline.pages.page_index import page_outputs
from robo_genesis.site.evidence.plain_nodes import bullets
from robo_genesis.site.evidence.runs import BACKEND
from robo_genesis.site.evidence.values import measured
from robo_genesis.site.figures.explorer import Recorded
from robo_genesis.site.pages import PageDirective
from robo_genesis.site.takeaways.directive import TAKEAWAYS, link
from robo_genesis.site.takeaways.plain_markdown import Writer, plain

FILE = "chunk-000/file-000"  # The only file of each kind

CAMERA = "observation.images.world"

QUANTILES = (0.01, 0.1, 0.5, 0.9, 0.99)

PIXELS = "yuv420p"

# Of the encoder: few frames depend on others, and equal pictures give equal bytes.
OPTIONS = {"crf": "18", "g": "2", "threads": "1"}


class DatasetDownload(PageDirective):
    """Write the archive with the episodes of a page, and link it."""

    required_arguments = 1

    def shown(self) -> list[nodes.Node]:
        """Return the link to the archive, its size and its digest."""
        lesson_page, source = (
            self.arguments[0],
            Path(self.env.doc2path(self.env.docname)),
        )
        lesson = lesson_page.split("/")[0]
        run = Recorded(lesson, page_outputs(lesson_page) / BACKEND).experiment
        address = f"{site_address()}{self.env.docname}.html" if site_address() else ""
        writer = Writer(
            source.parent, lambda value: measured(*value.split(" ", 1))[0], address
        )
        title = (
            f"> {self.config.html_title}. © {self.config.author}. {address}".rstrip()
        )
        text = f"{title}\n\n{plain(source.read_text('utf8'), writer)}"
        made = archive(
            find(f"robo_genesis.lessons.{lesson}.dataset.recorded")(run), text
        )
        files = Path(self.env.app.outdir) / TAKEAWAYS
        file = (
            files / f"{lesson}-dataset" / f"{lesson_page.replace('/', '-')}-lerobot.zip"
        )
        write_whole(file, made)
        base = relative_uri(f"{self.env.docname}.html", TAKEAWAYS)
        digest = hashlib.sha256(made).hexdigest()
        return [
            bullets((*link(base, files, file), ", SHA-256 ", nodes.literal("", digest)))
        ]


def archive(data: Mapping[str, Any], readme: str) -> bytes:
    """Return the zip with both datasets, the datasheet, settings, licence, and all digests."""
    found = {f"state/{path}": content for path, content in files(data).items()}
    if data["pictures"] is not None:
        seen = {
            n: of for n, of in data["columns"].items() if n not in data["privileged"]
        }
        few = files({**data, "columns": seen}, data["pictures"])
        found |= {f"camera/{path}": content for path, content in few.items()}
    found["parameters.json"] = json.dumps(data["parameters"], indent=1).encode()
    found["LICENSE"] = (
        ROOT / "LICENSE"
    ).read_bytes() + f"\n{data['credit']}\n".encode()
    found["README.md"] = f"{readme}\n".encode()
    sums = (
        f"{hashlib.sha256(content).hexdigest()}  {path}\n"
        for path, content in found.items()
    )
    found["SHA256SUMS"] = "".join(sums).encode()
    target = BytesIO()
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as whole:
        for path, content in found.items():
            whole.writestr(zipfile.ZipInfo(path), content, zipfile.ZIP_DEFLATED)
    return target.getvalue()


def files(
    data: Mapping[str, Any], pictures: np.ndarray | None = None
) -> dict[str, bytes]:
    """Return the files of one dataset by path: all episodes, or the first ones with pictures."""
    episodes, rows = next(iter(data["columns"].values()))[0].shape[:2]
    if pictures is not None:
        episodes = len(pictures)
    index = np.arange(episodes * rows)
    episode, row = np.divmod(index, rows)
    columns = {
        name: values[:episodes].reshape(len(index), *values.shape[2:])
        for name, (values, _) in data["columns"].items()
    } | {
        "timestamp": (row / data["fps"]).astype(np.float32),
        "frame_index": row,
        "episode_index": episode,
        "index": index,
        "task_index": np.zeros_like(index),
    }
    labels = {name: names for name, (_, names) in data["columns"].items()}
    features = {
        name: {
            "dtype": str(v.dtype),
            "shape": v.shape[1:] or (1,),
            "names": labels.get(name),
        }
        for name, v in columns.items()
    }
    starts = rows * np.arange(episodes)
    table: dict[str, Any] = {
        "episode_index": range(episodes),
        "tasks": [[data["task"]]] * episodes,
        "length": [rows] * episodes,
        "dataset_from_index": starts,
        "dataset_to_index": starts + rows,
    }
    stored, measures = ["data", "meta/episodes"], dict(columns)
    found = {f"data/{FILE}.parquet": parquet(columns)}
    if pictures is not None:
        features[CAMERA] = about_video(pictures, data["fps"])
        found[f"videos/{CAMERA}/{FILE}.mp4"] = video(pictures, data["fps"])
        stored.append(f"videos/{CAMERA}")
        table[f"videos/{CAMERA}/from_timestamp"] = starts / data["fps"]
        table[f"videos/{CAMERA}/to_timestamp"] = (starts + rows) / data["fps"]
        measures[CAMERA] = pictures.reshape(len(index), *pictures.shape[2:])
    table |= {
        f"{of}/{part}_index": [0] * episodes
        for of in stored
        for part in ("chunk", "file")
    }
    for name, values in measures.items():
        each = [statistics(part) for part in np.split(values, episodes)]
        table |= {
            f"stats/{name}/{what}": [one[what] for one in each] for what in each[0]
        }
    info = {
        "codebase_version": "v3.0",
        "robot_type": data["robot"],
        "total_episodes": episodes,
        "total_frames": len(index),
        "total_tasks": 1,
        "chunks_size": 1000,
        "data_files_size_in_mb": 100,
        "video_files_size_in_mb": 200,
        "fps": data["fps"],
        "splits": {"train": f"0:{episodes}"},
        "data_path": "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet",
        "video_path": None
        if pictures is None
        else "videos/{video_key}/chunk-{chunk_index:03d}/file-{file_index:03d}.mp4",
        "features": features,
    }
    overall = {name: statistics(values) for name, values in measures.items()}
    return found | {
        "meta/info.json": json.dumps(info, indent=1).encode(),
        "meta/stats.json": json.dumps(overall, indent=1).encode(),
        "meta/tasks.parquet": parquet(
            {"task_index": [0], "task": [data["task"]]}, index="task"
        ),
        f"meta/episodes/{FILE}.parquet": parquet(table),
    }


def parquet(columns: Mapping[str, Any], index: str = "") -> bytes:
    """Return a table; an array of two axes has one list in each row.

    pandas reads the column `index`, if one is given, as the index of the table.
    """
    arrays = {
        name: pa.FixedSizeListArray.from_arrays(
            pa.array(values.ravel()), values.shape[1]
        )
        if np.ndim(values) == 2 and isinstance(values, np.ndarray)
        else pa.array(values)
        for name, values in columns.items()
    }
    table = pa.table(arrays)
    if index:
        kinds = {True: ("int64", "int64"), False: ("unicode", "object")}
        names = [
            {"name": name, "field_name": name, "metadata": None}
            | dict(
                zip(
                    ("pandas_type", "numpy_type"),
                    kinds[of.type == pa.int64()],
                    strict=True,
                )
            )
            for name, of in arrays.items()
        ]
        about = {"index_columns": [index], "columns": names, "column_indexes": []}
        table = table.replace_schema_metadata({"pandas": json.dumps(about)})
    target = pa.BufferOutputStream()
    pq.write_table(table, target)
    return bytes(target.getvalue())


def statistics(values: np.ndarray) -> dict[str, Any]:
    """Return least, largest, mean, standard deviation, count and quantiles of rows.

    Pictures (n, height, width, 3) have them for each colour as (3, 1, 1), from 0 to 1.
    """
    count, of_pictures = len(values), values.ndim == 4
    if of_pictures:
        values = values.reshape(-1, values.shape[-1]) / 255
    values = values.astype(np.float64).reshape(len(values), -1)
    found = {"min": values.min(0), "max": values.max(0), "mean": values.mean(0)}
    found |= {"std": values.std(0)}
    levels = np.quantile(values, QUANTILES, axis=0)
    found |= {
        f"q{100 * q:02.0f}": level for q, level in zip(QUANTILES, levels, strict=True)
    }
    shape = (-1, 1, 1) if of_pictures else (-1,)
    return {what: of.reshape(shape).tolist() for what, of in found.items()} | {
        "count": [count]
    }


def about_video(pictures: np.ndarray, fps: int) -> dict[str, Any]:
    """Return the feature of the pictures."""
    height, width, channels = pictures.shape[2:]
    facts = {
        "height": height,
        "width": width,
        "channels": channels,
        "fps": fps,
        "codec": "h264",
    }
    facts |= {"pix_fmt": PIXELS, "is_depth_map": False}
    names = ["height", "width", "channels"]
    info = {f"video.{name}": value for name, value in facts.items()} | {
        "has_audio": False
    }
    return {
        "dtype": "video",
        "shape": [height, width, channels],
        "names": names,
        "info": info,
    }


def video(pictures: np.ndarray, fps: int) -> bytes:
    """Return all pictures one after the other as an MP4 file."""
    target = BytesIO()
    with av.open(target, "w", format="mp4") as file:
        stream = file.add_stream("libx264", rate=fps, options=OPTIONS)
        stream.height, stream.width = pictures.shape[2:4]
        stream.pix_fmt = PIXELS
        for picture in pictures.reshape(-1, *pictures.shape[2:]):
            file.mux(stream.encode(av.VideoFrame.from_ndarray(picture)))
        file.mux(stream.encode())
    return target.getvalue()


def setup(app: Sphinx) -> None:
    """Register the directive."""
    app.add_directive("dataset", DatasetDownload)
