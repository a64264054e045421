"""The npz archive of one run: written in one exact form, and read in no other.

The form is the one of `numpy.savez_compressed` for small arrays: one deflated member for each
array in a fixed order, then the directory. Reading composes headers and directory anew and compares
every byte of them, so that nothing can be hidden before, between, in or after the members.
"""

import io
import math
import struct
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy

from robo_genesis.core.refusals import AGAIN, BundleRefused

UNPACKED_LIMIT = 32 * 2**20
"""Bytes of all arrays of one case. Those of a lesson have less than 0.2 MiB."""

VALID = ("<f4", "<f8", "<i4")
"""Types of plain numbers: of the engine, of commands and times, and of counts."""

HEAD, SIZES = struct.Struct("<4s5H3I2H"), struct.Struct("<2H2Q")
ENTRY, END = struct.Struct("<4s4B4H3I5H2I"), struct.Struct("<4s4H2IH")
ZIP64, DEFLATED, YEAR_1980, UNIX, PERMISSIONS = 45, 8, 33, 3, 0o600 << 16
MAGIC = npy.magic(1, 0)
BEYOND = 2**32 - 1
"""A size in a member's header that the extra field gives instead."""


@dataclass(frozen=True)
class Member:
    """One packed array: name of the array, checksum and size of its file, packed bytes."""

    name: str
    checksum: int
    size: int
    packed: bytes

    @cached_property
    def local(self) -> bytes:
        """The header before the packed bytes."""
        name = f"{self.name}.npy".encode()
        head = HEAD.pack(
            b"PK\3\4", ZIP64, 0, DEFLATED, 0, YEAR_1980,
            self.checksum, BEYOND, BEYOND, len(name), SIZES.size,
        )  # fmt: skip
        return head + name + SIZES.pack(1, 16, self.size, len(self.packed))

    def entry(self, offset: int) -> bytes:
        """Return the entry of the directory for a member at an offset."""
        name = f"{self.name}.npy".encode()
        head = ENTRY.pack(
            b"PK\1\2", ZIP64, UNIX, ZIP64, 0, 0, DEFLATED, 0, YEAR_1980,
            self.checksum, len(self.packed), self.size, len(name), 0, 0, 0, 0, PERMISSIONS, offset,
        )  # fmt: skip
        return head + name


def write_archive(path: Path, arrays: Mapping[str, np.ndarray]) -> None:
    """Write arrays by name, in their order."""
    members = []
    for name, array in arrays.items():
        file, packing = _npy(array), zlib.compressobj(wbits=-zlib.MAX_WBITS)
        packed = packing.compress(file) + packing.flush()
        members.append(Member(name, zlib.crc32(file), len(file), packed))
    path.write_bytes(_archive(members))


def read_archive(path: Path, where: str, names: Sequence[str]) -> dict[str, np.ndarray]:
    """Return the arrays of an archive.

    Args:
        path: the file, whose size was checked.
        where: its name in the bundle, for messages.
        names: the arrays that it must contain, in their order; no others are allowed.

    Raises:
        BundleRefused: `too-big` before anything is unpacked, `bad-array` otherwise.
    """
    try:
        data = path.read_bytes()
        members = list(_members(data, names))
        if _archive(members) != data:
            raise ValueError("it has further bytes, other headers or another directory")
        unpacked = sum(member.size for member in members)
        if unpacked > UNPACKED_LIMIT:
            size = f"{unpacked} bytes when unpacked, expected at most {UNPACKED_LIMIT}"
            raise BundleRefused("too-big", f"{where} has {size}. {AGAIN}")
        return {member.name: _unpacked(member) for member in members}
    except BundleRefused:
        raise
    except Exception as error:  # zlib and NumPy have no exception of their own for damage
        expected = f"expected the recorder's archive of the arrays {', '.join(names)}"
        raise BundleRefused("bad-array", f"{where}: {error}, {expected}. {AGAIN}") from error


def _archive(members: Sequence[Member]) -> bytes:
    """Return the bytes of a whole archive."""
    body, directory, count = b"", b"", len(members)
    for member in members:
        directory += member.entry(len(body))
        body += member.local + member.packed
    end = END.pack(b"PK\5\6", 0, 0, count, count, len(directory), len(body), 0)
    return body + directory + end


def _members(data: bytes, names: Iterable[str]) -> Iterator[Member]:
    """Yield the members at the places where an archive of these arrays has them."""
    place = 0
    for name in names:
        try:
            checksum = HEAD.unpack_from(data, place)[6]
            place += HEAD.size + len(f"{name}.npy".encode())
            _, _, size, length = SIZES.unpack_from(data, place)
        except struct.error as error:
            raise ValueError(f"it ends before the array {name}") from error
        place += SIZES.size
        member = Member(name, checksum, size, data[place : place + length])
        begin = place - len(member.local)
        if len(member.packed) != length or data[begin:place] != member.local:
            raise ValueError(f"the header of the array {name} differs, or is not in its place")
        yield member
        place += length


def _unpacked(member: Member) -> np.ndarray:
    """Unpack one member; its stated size, which was checked, bounds the memory."""
    stream = zlib.decompressobj(wbits=-zlib.MAX_WBITS)
    file = stream.decompress(member.packed, member.size + 1)
    whole = stream.eof and not stream.unused_data and len(file) == member.size
    if not whole or zlib.crc32(file) != member.checksum:
        raise ValueError(f"the packed bytes of {member.name} do not give the file they should")
    return _array(member.name, file)


def _array(name: str, file: bytes) -> np.ndarray:
    """Return the array of an npy file that is exactly the one that the recorder writes."""
    if file[: len(MAGIC)] != MAGIC:
        raise ValueError(f"{name} has another version of the npy format than 1.0")
    begin = len(MAGIC) + 2 + int.from_bytes(file[len(MAGIC) : len(MAGIC) + 2], "little")
    shape, fortran, dtype, exact = _header(file[:begin])
    found = f"{dtype.str}, {'Fortran' if fortran else 'C'} order, shape {shape}"
    if dtype.str not in VALID or fortran or any(n < 0 for n in shape):
        raise ValueError(f"{name} is {found}; valid types are {', '.join(VALID)} in C order")
    if len(file) - begin != math.prod(shape) * dtype.itemsize:
        raise ValueError(f"{name} has {len(file)} bytes, which do not fit {found}")
    if not exact:
        raise ValueError(f"{name} has another header than the recorder writes")
    return np.frombuffer(file, dtype, offset=begin).reshape(shape)


@lru_cache(maxsize=256)
def _header(content: bytes) -> tuple[tuple[int, ...], bool, np.dtype[Any], bool]:
    """Return shape, whether the order is Fortran's, and type of an npy file, from its header.

    The last value is whether the header is, to the byte, the one that the recorder writes.
    """
    stream, again = io.BytesIO(content), io.BytesIO()
    npy.read_magic(stream)
    shape, fortran, dtype = npy.read_array_header_1_0(stream)
    of = {"descr": npy.dtype_to_descr(dtype), "fortran_order": fortran, "shape": shape}
    npy.write_array_header_1_0(again, of)
    return tuple(shape), bool(fortran), dtype, again.getvalue() == content


def _npy(array: np.ndarray) -> bytes:
    """Return the npy file of an array."""
    stream = io.BytesIO()
    npy.write_array(stream, array, version=(1, 0), allow_pickle=False)
    return stream.getvalue()
