"""The PNG file of one camera frame: written in one form, and read in no other.

Reading writes the frame again and compares every byte. Only the packed pixels are taken
as they are, because versions of zlib pack differently; what they unpack to is compared.
"""

import struct
import zlib
from pathlib import Path

import numpy as np

from robo_genesis.sim.camera.frames import require_frame

KEY = b"run_id\0"

# The filter of every row: each pixel is stored as its difference from the one on its
# left.
LEFT = 1

TEXT_PLACE = 33  # Where the chunk of text begins, after the signature and the header


def write_picture(path: Path, frame: np.ndarray, run_id: str) -> None:
    """Write a frame, shape (height, width, 3) uint8, with the id of its run."""
    require_frame(frame)
    size = frame.shape[1], frame.shape[0]
    path.write_bytes(_png(size, KEY + run_id.encode(), zlib.compress(_rows(frame))))


def read_picture(path: Path, size: tuple[int, int]) -> tuple[str, np.ndarray]:
    """Return the id of the run and the frame, shape (height, width, 3) uint8.

    Args:
        path: the file, whose size in bytes was checked.
        size: the required width and height [pixel].

    Raises:
        ValueError: the file is damaged, is not a usable frame of this size, or has
            anything in it that the recorder does not write: other chunks, text,
            animation, bytes after the end.
    """
    data, (width, height) = path.read_bytes(), size
    text = _content(data, TEXT_PLACE)
    packed = _content(data, TEXT_PLACE + len(_chunk(b"tEXt", text)))
    if _png(size, text, packed) != data or not text.startswith(KEY):
        raise ValueError("Its chunks are not those that the recorder writes.")
    stream, length = zlib.decompressobj(), height * (1 + 3 * width)
    try:
        rows = stream.decompress(packed, length + 1)
    except zlib.error as error:
        raise ValueError(f"Its pixels cannot be unpacked: {error}.") from error
    if len(rows) != length or not stream.eof or stream.unused_data:
        raise ValueError("Its packed pixels are too few, or have further bytes.")
    differences = np.frombuffer(rows, np.uint8).reshape(height, -1)[:, 1:]
    frame = np.cumsum(differences.reshape(height, width, 3), axis=1, dtype=np.uint8)
    if _rows(frame) != rows:
        raise ValueError("Its rows have another filter than the recorder uses.")
    require_frame(frame)
    return text.removeprefix(KEY).decode("latin-1"), frame


def _rows(frame: np.ndarray) -> bytes:
    """Return the content that is packed: each row after the number of its filter."""
    differences = np.diff(frame, axis=1, prepend=np.uint8(0)).reshape(len(frame), -1)
    return np.insert(differences, 0, LEFT, axis=1).tobytes()


def _png(size: tuple[int, int], text: bytes, packed: bytes) -> bytes:
    """Return the whole file; 8 bits each of RGB, not interlaced."""
    header = struct.pack(">2I5B", *size, 8, 2, 0, 0, 0)
    chunks = ((b"IHDR", header), (b"tEXt", text), (b"IDAT", packed), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(*chunk) for chunk in chunks)


def _chunk(kind: bytes, content: bytes) -> bytes:
    checksum = zlib.crc32(kind + content)
    return (
        struct.pack(">I", len(content)) + kind + content + struct.pack(">I", checksum)
    )


def _content(data: bytes, place: int) -> bytes:
    """Return the content of the chunk that begins at a place; empty beyond the end."""
    length = int.from_bytes(data[place : place + 4])
    return data[place + 8 : place + 8 + length]
