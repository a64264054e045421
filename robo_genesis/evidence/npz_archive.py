"""The npz archive of one run: written in one exact form, and read in no other.

The form is a zip with one unpacked npy file for each array. Reading writes the arrays
again and compares every byte, so that nothing can be hidden before, between, in or
after the members. Nothing is compressed: the bytes do not depend on the machine's
version of zlib.
"""

import io
import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.lib import format as npy

from robo_genesis.evidence.refusals import AGAIN, BundleRefused

# Bytes of all arrays of one case. Those of a lesson have less than 0.2 MiB.
UNPACKED_LIMIT = 32 * 2**20

UNIX = 3


def write_archive(path: Path, arrays: Mapping[str, np.ndarray]) -> None:
    """Write arrays by name, in their order."""
    path.write_bytes(_archive(arrays))


def read_archive(
    path: Path, where: str, dtypes: Mapping[str, str]
) -> dict[str, np.ndarray]:
    """Return the arrays of an archive.

    Args:
        path: the file, whose size was checked.
        where: its name in the bundle, for messages.
        dtypes: the type of each array that it must contain, in their order; no others
            are allowed.

    Raises:
        BundleRefused: `too-big` before anything is unpacked, `bad-array` otherwise.
    """
    try:
        data = path.read_bytes()
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            entries = archive.infolist()
        unpacked = sum(entry.file_size for entry in entries)
        if unpacked > UNPACKED_LIMIT:
            size = f"{unpacked} bytes when unpacked, expected at most {UNPACKED_LIMIT}"
            raise BundleRefused("too-big", f"{where} has {size}. {AGAIN}")
        if any(entry.compress_type != zipfile.ZIP_STORED for entry in entries):
            raise ValueError("its members are packed")
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            arrays = dict(archive)
        found = {name: str(array.dtype) for name, array in arrays.items()}
        if list(found.items()) != list(dtypes.items()):
            raise ValueError(f"it has the arrays {found}")
        if _archive(arrays) != data:
            raise ValueError("the same arrays, written again, give other bytes")
    except BundleRefused:
        raise
    except (
        Exception
    ) as error:  # zipfile and NumPy have no exception of their own for damage
        expected = f"expected the recorder's archive of the arrays {dict(dtypes)}"
        raise BundleRefused(
            "bad-array", f"{where}: {error}, {expected}. {AGAIN}"
        ) from error
    return arrays


def _archive(arrays: Mapping[str, np.ndarray]) -> bytes:
    """Return the bytes of a whole archive; each member has the oldest date of a zip."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, array in arrays.items():
            entry, file = zipfile.ZipInfo(f"{name}.npy"), io.BytesIO()
            entry.create_system = UNIX
            npy.write_array(
                file, np.ascontiguousarray(array), version=(1, 0), allow_pickle=False
            )
            archive.writestr(entry, file.getvalue())
    return stream.getvalue()
