"""The seal of Kiln's own HDF5 files (framework/files/Seal.hpp), so that a test can change what lies behind it."""

import struct
from pathlib import Path

import h5py
import xxhash

MARK = b"KILNSEAL"
LARGE = 1 << 20


def hashed(data):
    value = xxhash.xxh3_128_intdigest(data)
    return value & (2**64 - 1), value >> 64


def content(data):
    """The bytes without their seal, if they carry one."""
    if len(data) >= 40 and data[-40:-32] == MARK:
        return data[: struct.unpack("<Q", data[-32:-24])[0]]
    return data


def large_parts(path):
    """Offset and length of large contiguous datasets."""
    parts = set()

    def visit(_, item):
        if not isinstance(item, h5py.Dataset):
            return
        offset, length = item.id.get_offset(), item.id.get_storage_size()
        if offset is not None and length >= LARGE:
            parts.add((offset, length))

    with h5py.File(path, "r") as file:
        file.visititems(visit)
    return sorted(parts)


def seal_of(data, large):
    table = b""
    count = at = 0
    for offset, length, is_large in [(*part, 1) for part in large] + [(len(data), 0, 1)]:
        if offset > at:
            table += struct.pack("<5Q", at, offset - at, 0, *hashed(data[at:offset]))
            count += 1
        if length:
            table += struct.pack("<5Q", offset, length, is_large, *hashed(data[offset : offset + length]))
            count += 1
        at = offset + length
    table += MARK + struct.pack("<2Q", len(data), count)
    return table + struct.pack("<2Q", *hashed(table))


def seal(path):
    """Seals a file as Kiln does, whatever is in it; one that is no HDF5 file as a single piece."""
    path = Path(path)
    data = content(path.read_bytes())
    path.write_bytes(data)
    try:
        large = large_parts(path)
    except (OSError, RuntimeError, KeyError):
        large = []
    path.write_bytes(data + seal_of(data, large))
