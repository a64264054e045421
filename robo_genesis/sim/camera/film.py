"""Small pictures of a run as sheets: each frame of a bundle holds many of them, row by row."""

from collections.abc import Mapping

import numpy as np

from robo_genesis.core.scene import FRAME_SHAPE

# Pictures in a row or column of a sheet; a picture is smaller than a frame by this.
SHRINK = 5

# Rows, columns and colours of a picture; width and height of its camera [pixel].
PICTURE = (FRAME_SHAPE[0] // SHRINK, FRAME_SHAPE[1] // SHRINK, FRAME_SHAPE[2])
RES = (PICTURE[1], PICTURE[0])


def sheet_names(film: str, count: int) -> tuple[str, ...]:
    """Return the names of the frames that hold so many pictures."""
    return tuple(f"{film}_sheet_{k}" for k in range(-(-count // SHRINK**2)))


def sheets(film: str, pictures: np.ndarray) -> dict[str, np.ndarray]:
    """Return the frames that hold pictures (n, *PICTURE); the rest of the last one is black."""
    names = sheet_names(film, len(pictures))
    places = np.zeros((len(names) * SHRINK**2, *PICTURE), np.uint8)
    places[: len(pictures)] = pictures
    tiles = places.reshape(len(names), SHRINK, SHRINK, *PICTURE)
    return dict(
        zip(names, tiles.swapaxes(2, 3).reshape(len(names), *FRAME_SHAPE), strict=True)
    )


def pictures_of(frames: Mapping[str, np.ndarray], film: str, count: int) -> np.ndarray:
    """Return the pictures (count, *PICTURE) that the frames of a film hold."""
    whole = np.stack([frames[name] for name in sheet_names(film, count)])
    tiles = whole.reshape(
        len(whole), SHRINK, PICTURE[0], SHRINK, *PICTURE[1:]
    ).swapaxes(2, 3)
    return tiles.reshape(-1, *PICTURE)[:count]
