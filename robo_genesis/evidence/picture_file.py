"""The PNG file of one camera frame: written in one form, and read in no other."""

import struct
import zlib
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

import numpy as np
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from robo_genesis.sim.camera.frames import require_frame

SIGNATURE = b"\x89PNG\r\n\x1a\n"
KEY = "run_id"
CHUNKS = ["IHDR", "tEXt", "IDAT", "IEND"]


def write_picture(path: Path, frame: np.ndarray, run_id: str) -> None:
    """Write a frame, shape (height, width, 3) uint8, with the id of its run."""
    text = PngInfo()
    text.add_text(KEY, run_id)
    Image.fromarray(frame).save(path, format="PNG", pnginfo=text)


def read_picture(path: Path, size: tuple[int, int]) -> tuple[str, np.ndarray]:
    """Return the id of the run and the frame, shape (height, width, 3) uint8.

    Args:
        path: the file, whose size in bytes was checked.
        size: the required width and height [pixel].

    Raises:
        ValueError: the file is damaged, is not a usable frame of this size, or has anything in it
            that the recorder does not write: other chunks, text, animation, bytes after the end.
    """
    chunks = list(_chunks(path.read_bytes()))
    kinds = [kind for kind, _ in groupby(kind for kind, _ in chunks)]
    if kinds != CHUNKS or [kind for kind, _ in chunks if kind != "IDAT"] != [
        "IHDR",
        "tEXt",
        "IEND",
    ]:
        raise ValueError(f"Its chunks are {', '.join(kinds)[:80]}; valid: {', '.join(CHUNKS)}.")
    header, text = chunks[0][1], chunks[1][1]
    if header != struct.pack(">2I5B", *size, 8, 2, 0, 0, 0):
        raise ValueError(f"It is not a picture of {size} pixels with 8 bits each of RGB.")
    key, _, run_id = text.decode("latin-1").partition("\0")
    if key != KEY:
        raise ValueError(f"Its text is {key[:80]!r}; valid: {KEY!r}.")
    if chunks[-1][1] or any(kind == "IDAT" and not data for kind, data in chunks):
        raise ValueError("A chunk has bytes that it must not have, or has none.")
    width, height = size
    stream, length = zlib.decompressobj(), height * (1 + 3 * width)
    try:
        pixels = stream.decompress(b"".join(d for kind, d in chunks if kind == "IDAT"), length + 1)
    except zlib.error as error:
        raise ValueError(f"Its pixels cannot be unpacked: {error}.") from error
    if len(pixels) != length or not stream.eof or stream.unused_data:
        raise ValueError("Its packed pixels are too few, or have further bytes.")
    try:
        with Image.open(path, formats=["PNG"]) as picture:
            frame = np.array(picture)
    except (OSError, SyntaxError) as error:
        raise ValueError(f"It cannot be decoded: {error}.") from error
    require_frame(frame)
    return run_id, frame


def _chunks(data: bytes) -> Iterator[tuple[str, bytes]]:
    """Yield the kind and content of each chunk after comparing the checksums.

    Raises:
        ValueError: the file is damaged, or has bytes outside of chunks.
    """
    if not data.startswith(SIGNATURE):
        raise ValueError("It is not a PNG file.")
    place = len(SIGNATURE)
    while place < len(data):
        length = int.from_bytes(data[place : place + 4])
        end = place + 12 + length
        if end > len(data):
            raise ValueError(f"It has {len(data) - place} bytes that are not a whole chunk.")
        content, checksum = data[place + 4 : end - 4], int.from_bytes(data[end - 4 : end])
        if zlib.crc32(content) != checksum:
            raise ValueError(f"The chunk at byte {place} has another checksum.")
        yield content[:4].decode("latin-1"), content[4:]
        place = end
