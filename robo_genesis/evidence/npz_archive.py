"""Read an npz archive after checking its directory and headers, before any unpacking."""

import math
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile, ZipInfo

import numpy as np
from numpy.lib import format as npy

from robo_genesis.core.refusals import AGAIN, BundleRefused, expect

UNPACKED_LIMIT = 32 * 2**20
"""Bytes of all arrays of one case. Those of a lesson have less than 0.2 MiB."""

VALID = ("<f4", "<f8", "<i4")
"""Types of plain numbers: of the engine, of commands and times, and of counts."""

HEADERS = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}


def read_archive(path: Path, where: str, names: set[str]) -> dict[str, np.ndarray]:
    """Return the arrays of an archive.

    Args:
        path: the file.
        where: its name in the bundle, for messages.
        names: the arrays that it must contain; no others are allowed.

    Raises:
        BundleRefused: `too-big` before anything is unpacked, `bad-array` otherwise.
    """
    try:
        with ZipFile(path) as archive:
            members = archive.infolist()
            _check_directory(members, where, names)
            return {info.filename[: -len(".npy")]: _read(archive, info, where) for info in members}
    except BundleRefused:
        raise
    except Exception as error:  # zipfile and NumPy have no exception of their own for damage
        message = f"{where}: {error}, expected a complete archive of plain numbers. {AGAIN}"
        raise BundleRefused("bad-array", message) from error


def _check_directory(members: list[ZipInfo], where: str, names: set[str]) -> None:
    found = sorted(info.filename for info in members)
    expect("bad-array", where, "list of arrays", found, sorted(f"{name}.npy" for name in names))
    unpacked = sum(info.file_size for info in members)
    if unpacked > UNPACKED_LIMIT:
        size = f"{unpacked} bytes when unpacked, expected at most {UNPACKED_LIMIT}"
        raise BundleRefused("too-big", f"{where} has {size}. {AGAIN}")
    packing = {info.compress_type for info in members} - {ZIP_DEFLATED, ZIP_STORED}
    expect("bad-array", where, "set of compression methods other than deflate", packing, set())


def _read(archive: ZipFile, info: ZipInfo, where: str) -> np.ndarray:
    """Unpack one member; the size in the directory, which was checked, bounds the memory."""
    what = f"{where}: {info.filename}"
    with archive.open(info) as stream:
        shape, fortran, dtype = HEADERS[npy.read_magic(stream)](stream)
        found = f"{dtype.str}, {'Fortran' if fortran else 'C'} order, shape {shape}"
        if dtype.str not in VALID or fortran or any(n < 0 for n in shape):
            raise ValueError(f"{what} is {found}; valid types are {', '.join(VALID)} in C order")
        size = math.prod(shape) * dtype.itemsize
        if info.file_size - stream.tell() != size:
            raise ValueError(f"{what} has {info.file_size} bytes, which do not fit {found}")
        data = stream.read(size)
        stream.read(1)  # reaching the end compares the checksum
    return np.frombuffer(data, dtype).reshape(shape)
